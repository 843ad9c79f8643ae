#include "sim/scenario/scenario.hpp"
#include "tests/fuzz/fuzz_support.hpp"

using namespace roadbook;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::try_parse(
      [&] { (void)parse_scenario(std::string(fuzz::text_of(data, size)), "scenario.yaml"); });
}
