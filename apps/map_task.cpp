#include "apps/map_task.hpp"

#include <string>
#include <vector>

#include "apps/summaries/merge_summary.hpp"
#include "apps/summaries/remove_summary.hpp"
#include "base/error.hpp"

namespace roadbook {
namespace {

void require_one_task(const MapRequest& command, const MapTask& task) {
  std::vector<std::string> tasks;
  if (!command.drives.empty()) tasks.emplace_back("drives");
  if (!task.removal.session.empty()) tasks.emplace_back("--remove");
  if (!task.split.part.empty()) tasks.emplace_back("--split");
  if (!task.merge.other.empty()) tasks.emplace_back("--merge");
  if (tasks.size() != 1)
    throw InvalidOption("DRIVE", tasks.empty() ? "none" : tasks[0] + " with " + tasks[1],
                        "drives to map, or one of --remove, --split and --merge");
  if (task.split.part.empty() != task.split.output.empty())
    throw InvalidOption("--output", task.split.output.empty() ? "none" : task.split.output.string(),
                        "a new map file, with --split alone");
}

}  // namespace

void add_task_options(Options& options, MapTask& task) {
  options.add("--remove", &task.removal.session, "take the session of this name out of the map");
  options.add("--drop-labels", &task.removal.drop_labels,
              "with --remove: delete labels that no earlier session shows");
  options.add("--split", &task.split.part,
              "write the session NAME, or `NAME@T0,T1` [ns], as a separate map");
  options.add("--output,-o", &task.split.output, "with --split: map file to write");
  options.add("--merge", &task.merge.other, "add the sessions of this map of the same place");
}

bool run_map_task(Console& console, const MapRequest& command, MapTask& task) {
  require_one_task(command, task);
  if (!task.removal.session.empty()) {
    task.removal.map = command.map;
    print_removal(console, remove_session(task.removal), task.removal.session);
  } else if (!task.split.part.empty()) {
    task.split.map = command.map;
    task.split.num_threads = command.options.num_threads;
    print_split(console, split_session(task.split), task.split.output);
  } else if (!task.merge.other.empty()) {
    task.merge.map = command.map;
    task.merge.adjust = command.adjust.value_or(SessionAdjust::kNear);
    task.merge.num_threads = command.options.num_threads;
    print_merge(console, merge_maps(task.merge, console), task.merge.map);
  } else {
    return false;
  }
  return true;
}

}  // namespace roadbook
