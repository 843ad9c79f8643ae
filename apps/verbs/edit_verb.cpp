#include <memory>

#include "apps/summaries/edit_summary.hpp"
#include "apps/verb.hpp"

namespace roadbook {

Verb edit_verb() {
  auto command = std::make_shared<EditRequest>();
  auto list = std::make_shared<bool>(false);
  return {
      "edit", "corrects a map by hand: loops, same points, anchors",
      [=](Options& options) {
        options.add("EDITS", &command->edits, "YAML file with edits to make");
        options.add("--map,-m", &command->map, "map file").required = true;
        options.add("--list", list.get(), "list the edits of the map");
        options.add("--undo", &command->undo, "number of an edit to take back (--list)").range = {
            0, 1000000};
      },
      [=](Console& console, const CommonOptions& common) {
        const int asked =
            (command->edits.empty() ? 0 : 1) + (command->undo > 0 ? 1 : 0) + (*list ? 1 : 0);
        if (asked != 1)
          throw InvalidOption("EDITS", asked == 0 ? "none" : "several of EDITS, --list, --undo",
                              "a file of edits, --list, or --undo N");
        command->num_threads = common.threads;
        print_edits(console, edit_map(*command, console), *list);
        return ExitStatus::kDone;
      }};
}

}  // namespace roadbook
