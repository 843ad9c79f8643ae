#pragma once

#include "apps/console.hpp"
#include "apps/options.hpp"
#include "workflows/map_drives.hpp"
#include "workflows/merge_maps.hpp"
#include "workflows/removed_session.hpp"
#include "workflows/split_session.hpp"

namespace roadbook {

/// Tasks of the verb `map` that need no drive. At most one is requested.
struct MapTask {
  RemoveRequest removal;
  SplitRequest split;
  MergeRequest merge;
};

void add_task_options(Options& options, MapTask& task);

/// Runs the requested task on the map of `command`, with its `adjust` and threads, and prints the
/// result. Returns false if drives are given instead. Throws InvalidOption for none or several.
bool run_map_task(Console& console, const MapRequest& command, MapTask& task);

}  // namespace roadbook
