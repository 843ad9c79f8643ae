#pragma once

#include <filesystem>
#include <vector>

#include "base/messages.hpp"
#include "mapping/edits/map_edit.hpp"
#include "mapping/pipeline/map_options.hpp"

namespace roadbook {

struct EditRequest {
  std::filesystem::path map;
  std::filesystem::path edits;  ///< file of edits to add; empty: none
  int undo = 0;                 ///< number of the edit to undo, from 1; 0: no undo
  int num_threads = 0;
};

struct EditResult {
  std::vector<MapEdit> edits;   ///< of the map now
  double moved_median_m = 0.0;  ///< of the poses, by this command
  double moved_max_m = 0.0;
  bool undone_later =
      false;  ///< the edit is removed, but its effect stays until the map is built again
  std::vector<std::string> dropped;  ///< layers that no longer fit
  std::string digest;                ///< of the map
};

/// Whether a layer or table of a map does not depend on where the poses are, or follows them.
[[nodiscard]] bool stays_when_poses_move(const std::string& table);

/// Adds edits to a map, or takes one back, or lists them. The map is computed from the map without
/// edits and all its edits, so that taking the last one back restores the map of before, to the
/// digest. A map that was extended after its edits knows no map without them: a taken-back edit
/// then keeps its effect until a build (`undone_later`).
///
/// Layers made from the poses go if poses move; labels move with the poses. Throws Refused (an edit
/// that contradicts the map), InvalidOption, BadInput, StorageError, Interrupted. The map then
/// is unchanged.
EditResult edit_map(const EditRequest& request, Messages& messages);

/// Makes the edits of a map again after a build, which has kept their table. Returns false if the
/// map has no edits. Throws the exceptions of `edit_map`; the map then lacks the effect of its
/// edits.
bool repeat_edits(const std::filesystem::path& map, int num_threads, Messages& messages);

}  // namespace roadbook
