#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "apps/console.hpp"
#include "workflows/layers/map_items.hpp"

namespace roadbook {

/// Prints items and layers with age, weight and state.
void print_items(const Console& console, const ItemsResult& result, std::int64_t now_ns);

/// An item with age, weight and state at `now_ns`, as JSON.
[[nodiscard]] nlohmann::ordered_json item_json(const LayerItem& item, std::int64_t now_ns);

/// Items that are used, and a list of those that are not, as JSON.
[[nodiscard]] nlohmann::ordered_json items_json(const std::vector<LayerItem>& items,
                                                std::int64_t now_ns);

/// A note for each item that is stale: it is not used.
void say_stale_items(const Console& console,
                     const std::vector<LayerItem>& items,
                     std::int64_t now_ns);

}  // namespace roadbook
