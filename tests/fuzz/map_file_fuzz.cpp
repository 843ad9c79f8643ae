#include "mapping/store/map_check.hpp"
#include "mapping/store/map_file.hpp"
#include "tests/fuzz/fuzz_support.hpp"

using namespace roadbook;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::fs::path file = fuzz::work_folder() / "map.gpkg";
  fuzz::put(file, fuzz::text_of(data, size));
  fuzz::try_parse([&] { (void)check_map(file); });
  return fuzz::try_parse([&] { (void)load_map(file); });
}
