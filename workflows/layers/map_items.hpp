#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "exchange/export/export_options.hpp"
#include "speedmap/items/layer_item.hpp"
#include "speedmap/presence/map_ages.hpp"

namespace roadbook {

/// The arguments of `map_items`.
struct ItemsRequest {
  std::filesystem::path map;
  std::filesystem::path put;          ///< GeoJSON; empty: none
  bool map_coordinates = false;       ///< the file has x, y in the map frame [m], not degrees
  std::optional<GeoOrigin> origin{};  ///< of the map; empty: as the map knows it
  bool expire = false;                ///< marks stale items as no longer used
  std::int64_t now_ns = 0;            ///< since 1970
};

struct ItemsResult {
  std::vector<LayerItem> items;       ///< all of the map, by id
  std::size_t put = 0;                ///< of the file, now in the map
  std::size_t already = 0;            ///< of the file, were in the map
  std::vector<std::int64_t> expired;  ///< marked in this call
  AgedLayers ages;                    ///< of the map's own layers and rasters (`layer_ages`)
  std::vector<Problem> notes;
  std::string digest;  ///< of the map file afterwards
};

/// Puts items of layers into a map, marks stale ones, and returns all of them. Nothing is deleted
/// or changed. A file put a second time changes nothing. Throws BadInput (also where the file is in
/// degrees and the map has no place on the earth), StorageError.
[[nodiscard]] ItemsResult map_items(const ItemsRequest& request);

}  // namespace roadbook
