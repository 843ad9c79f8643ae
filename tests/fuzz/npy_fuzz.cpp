#include "drive/import/npy.hpp"
#include "tests/fuzz/fuzz_support.hpp"

using namespace roadbook;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fuzz::fs::path file = fuzz::work_folder() / "array.npy";
  fuzz::put(file, fuzz::text_of(data, size));
  return fuzz::try_parse([&] {
    const NpyArray array = read_npy(file);
    if (array.rows() * array.columns() > array.values.size()) std::abort();
  });
}
