#include "exchange/import/item_file.hpp"
#include "tests/fuzz/fuzz_support.hpp"

using namespace roadbook;

// The first byte chooses degrees or metres.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const fuzz::fs::path file = fuzz::work_folder() / "items.geojson";
  return fuzz::try_parse([&] {
    fuzz::put(file, fuzz::text_of(data + 1, size - 1));
    std::optional<GeoOrigin> origin;
    if (data[0] % 2 == 0) origin = GeoOrigin{48.78, 9.18, 10.0};
    constexpr std::int64_t kNow_ns = 1'700'000'000'000'000'000;
    for (const LayerItem& item : read_item_file(file, origin, kNow_ns).items) {
      (void)item.distance_m({1.0, 2.0});
      (void)item.weight(kNow_ns);
    }
  });
}
