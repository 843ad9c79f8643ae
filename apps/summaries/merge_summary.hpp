#pragma once

#include <filesystem>

#include "apps/console.hpp"
#include "workflows/merge_maps.hpp"
#include "workflows/split_session.hpp"

namespace roadbook {

/// Prints the result of `map --split`, whose new map is `output`.
void print_split(const Console& console,
                 const SplitResult& result,
                 const std::filesystem::path& output);

/// Prints the result of `map --merge`, which changed the map file `map`.
void print_merge(const Console& console,
                 const MergeResult& result,
                 const std::filesystem::path& map);

}  // namespace roadbook
