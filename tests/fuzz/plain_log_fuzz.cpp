#include "diagnosis/logs/plain_log.hpp"
#include "tests/fuzz/fuzz_support.hpp"

using namespace roadbook;

// A description of a log and its table, a text or a MATLAB file.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto parts = fuzz::parts_of(fuzz::text_of(data, size), 2);
  const fuzz::fs::path folder = fuzz::work_folder() / "log";
  fuzz::put(folder / "log.yaml", parts[0]);
  fuzz::put(folder / "log.csv", parts[1]);
  fuzz::put(folder / "log.mat", parts[1]);
  return fuzz::try_parse([&] { (void)read_plain_log(folder / "log.yaml"); });
}
