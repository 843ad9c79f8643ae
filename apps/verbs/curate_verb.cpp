#include <memory>

#include "apps/summaries/curate_summary.hpp"
#include "apps/verb.hpp"

namespace roadbook {

Verb curate_verb() {
  struct Command {
    std::filesystem::path map;
    CurateOptions options;
    int most = 0;
    bool dry_run = false;
  };
  auto command = std::make_shared<Command>();
  return {"curate", "keeps the landmarks that localisation needs, so that a map stays small",
          [=](Options& options) {
            options.add("--map,-m", &command->map, "map file").required = true;
            options
                .add("--per-place", &command->options.per_place,
                     "landmarks to keep for each metre of way, heading and camera")
                .range = {1, 100000};
            options
                .add("--most", &command->most,
                     "landmarks to keep in all; places then keep fewer; 0: no limit")
                .range = {0, 1000000000};
            options.add("--dry-run", &command->dry_run, "only tell what would be kept");
          },
          [=](Console& console, const CommonOptions&) {
            if (command->most > 0) command->options.most = static_cast<std::size_t>(command->most);
            print_curation(console, curate_map(command->map, command->options, command->dry_run),
                           command->dry_run);
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
