#include "workflows/layers/map_items.hpp"

#include <algorithm>

#include "exchange/export/geo_origin.hpp"
#include "exchange/import/item_file.hpp"
#include "exchange/import/json_fields.hpp"
#include "exchange/layers/item_table.hpp"
#include "exchange/layers/layer_ages.hpp"
#include "mapping/store/map_file.hpp"

namespace roadbook {
namespace {

bool is_same(const LayerItem& a, const LayerItem& b) {
  return a.kind == b.kind && a.shape == b.shape && a.parts == b.parts && a.reach_m == b.reach_m &&
         a.observed_ns == b.observed_ns && a.half_life_s == b.half_life_s && a.speed == b.speed &&
         a.grip_factor == b.grip_factor && a.note == b.note;
}

// The items of the file that the map does not have yet, with their ids.
std::vector<LayerItem> new_items(const ItemsRequest& request, ItemsResult& result) {
  std::vector<LayerItem> fresh;
  if (request.put.empty()) return fresh;
  // A file that cannot be read is named first, before an origin that is missing.
  (void)read_json_file(request.put, "items of layers");
  std::optional<GeoOrigin> origin;
  if (!request.map_coordinates) {
    ExportOptions place;
    place.origin = request.origin;
    origin = find_origin(request.map, place);
    if (!origin)
      throw BadInput({Severity::kError, request.map.string(), 0, "origin", "none",
                      "latitude and longitude of the map's origin, or --map-coordinates for a file "
                      "in metres of the map frame"});
  }
  ItemFile file = read_item_file(request.put, origin, request.now_ns);
  result.notes = std::move(file.notes);
  for (LayerItem& item : file.items) {
    const auto is_known = [&](const LayerItem& known) { return is_same(known, item); };
    if (std::any_of(result.items.begin(), result.items.end(), is_known)) {
      ++result.already;
      continue;
    }
    item.id = static_cast<std::int64_t>(result.items.size());
    fresh.push_back(item);
    result.items.push_back(std::move(item));
  }
  result.put = fresh.size();
  return fresh;
}

void change_items(const ItemsRequest& request, ItemsResult& result) {
  MapUpdate update(request.map);  // locks the map between reading and writing
  const MapLayers layers(request.map);
  result.items = read_items(layers);
  const std::vector<LayerItem> fresh = new_items(request, result);
  if (request.expire)
    for (LayerItem& item : result.items)
      if (item.state(request.now_ns) == ItemState::kStale && !item.expired_ns) {
        item.expired_ns = request.now_ns;
        result.expired.push_back(item.id);
      }
  append_items(update, layers, fresh, result.expired, request.now_ns);
  if (!fresh.empty() || !result.expired.empty())
    update.note("layers", std::to_string(fresh.size()) + " put, " +
                              std::to_string(result.expired.size()) + " expired");
  update.commit();
}

}  // namespace

ItemsResult map_items(const ItemsRequest& request) {
  ItemsResult result;
  if (!request.put.empty() || request.expire)
    change_items(request, result);
  else
    result.items = read_items(MapLayers(request.map));
  const AgedLayers ages = read_layer_ages(MapLayers(request.map));
  for (const AgedItem& aged : ages.all()) {
    const auto is_item = [&](const LayerItem& item) { return item.name() == aged.name; };
    if (std::none_of(result.items.begin(), result.items.end(), is_item)) result.ages.put(aged);
  }
  result.digest = load_meta(request.map).digest;
  return result;
}

}  // namespace roadbook
