#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "base/error.hpp"
#include "exchange/export/export_options.hpp"
#include "speedmap/items/layer_item.hpp"

namespace roadbook {

/// Items read from a file, without ids.
struct ItemFile {
  std::vector<LayerItem> items;
  std::vector<Problem> notes;  ///< of what was taken differently from the file
};

/// Reads items of layers from a GeoJSON file: a FeatureCollection (or one Feature) of points, lines
/// and polygons, also of several parts and with holes.
///
/// `origin`: where the map lies on the earth; coordinates are longitude, latitude in degrees
/// (WGS84, RFC 7946). Empty: coordinates are x, y in the map frame [m]. `now_ns`: no item may be
/// observed later; it is also the time at which the items are recorded.
///
/// Properties: `kind` (`item_kinds`), `observed_utc` (RFC 3339, with a zone), and, where they are
/// wanted, `half_life_s`, `speed_mps`, `grip_factor`, `reach_m`, `note`; null counts as missing.
///
/// Throws one BadInput with all faults of the file: also for coordinates that are no degrees, lie
/// farther than 20 km from the map's origin, or are swapped; for rings of fewer than three corners;
/// for another coordinate system; for a file without features. A ring that is not closed is closed,
/// with a note.
[[nodiscard]] ItemFile read_item_file(const std::filesystem::path& file,
                                      const std::optional<GeoOrigin>& origin,
                                      std::int64_t now_ns);

}  // namespace roadbook
