#include "tests/fuzz/fuzz_support.hpp"
#include "workflows/edits/edit_file.hpp"

using namespace roadbook;

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::try_parse([&] {
    for (const MapEdit& edit : parse_edits(std::string(fuzz::text_of(data, size)), "edits.yaml"))
      (void)parse_edits(edit_yaml(edit), "again");  // what was read can be stored
  });
}
