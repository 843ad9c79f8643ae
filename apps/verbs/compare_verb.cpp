#include <memory>

#include "apps/output_option.hpp"
#include "apps/report/compare_page.hpp"
#include "apps/summaries/compare_summary.hpp"
#include "apps/verb.hpp"
#include "base/whole_file.hpp"

namespace roadbook {

Verb compare_verb() {
  struct Command {
    std::filesystem::path a;
    std::filesystem::path b;
    std::filesystem::path page;
    bool value = false;
  };
  auto command = std::make_shared<Command>();
  return {"compare", "tells what differs between two maps of a place",
          [=](Options& options) {
            options.add("A", &command->a, "map file").required = true;
            options.add("B", &command->b, "map file to compare with it").required = true;
            options.add("--output,-o", &command->page, "HTML page to write");
            options.add("--value", &command->value,
                        "also compute what the sessions of each map are worth to each other");
          },
          [=](Console& console, const CommonOptions&) {
            for (const auto& map : {command->a, command->b})
              if (!command->page.empty()) refuse_to_replace(map, command->page);
            const FileComparison comparison = compare_files(command->a, command->b, command->value);
            if (!command->page.empty())
              write_whole_file(command->page, compare_page(comparison, command->a, command->b));
            print_comparison(console, comparison, command->value, command->page);
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
