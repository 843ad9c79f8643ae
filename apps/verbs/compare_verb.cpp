#include <memory>

#include "apps/summaries/compare_summary.hpp"
#include "apps/verb.hpp"

namespace roadbook {

Verb compare_verb() {
  struct Command {
    std::filesystem::path a;
    std::filesystem::path b;
  };
  auto command = std::make_shared<Command>();
  return {"compare", "tells what differs between two maps of a place",
          [=](Options& options) {
            options.add("A", &command->a, "map file").required = true;
            options.add("B", &command->b, "map file to compare with it").required = true;
          },
          [=](Console& console, const CommonOptions&) {
            print_comparison(console, compare_files(command->a, command->b));
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
