#pragma once

#include "mapping/map.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/overhead/overhead.hpp"

namespace roadbook {

/// Puts an overhead image made of `map` into its file: rasters `overhead`, `overhead_count` and
/// `overhead_variance`; tables `overhead_sources` (how old, how certain, how complete, by session),
/// `overhead_frames` and `overhead_blocks` (which frames contributed where). docs/guide/overhead.md
/// lists the columns. Layers and tables of these names are replaced. The update is not committed.
void store_overhead(const Map& map, const OverheadSummary& made, MapUpdate* update);

}  // namespace roadbook
