#include "tests/fuzz/fuzz_support.hpp"
#include "workflows/property_table.hpp"
#include "workflows/settings/effect_model.hpp"
#include "workflows/settings/friction_config.hpp"

using namespace roadbook;

// The first byte chooses: a table of ground properties, or a model of effects.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text = fuzz::text_of(data + 1, size - 1);
  return fuzz::try_parse([&] {
    if (data[0] % 2 == 0) {
      fuzz::put(fuzz::work_folder() / "model.yaml", text);
      (void)read_effect_model(fuzz::work_folder() / "model.yaml");
      return;
    }
    const auto properties = FrictionConfig{}.properties();
    for (const auto& property : properties)
      fuzz::put(property_file(fuzz::work_folder() / "drive", property), text);
    (void)read_properties(fuzz::work_folder() / "drive", properties);
  });
}
