#include "exchange/import/item_file.hpp"

#include <cmath>
#include <memory>
#include <set>
#include <string>

#include "exchange/export/geo_origin.hpp"
#include "exchange/import/geojson_geometry.hpp"
#include "exchange/import/json_fields.hpp"
#include "mapping/layers/map_layers_gdal.hpp"
#include "mapping/layers/parse_utc.hpp"

namespace roadbook {
namespace {

using ItemJson = nlohmann::json;
using ItemPart = std::vector<Eigen::Vector2d>;

constexpr double kFarthestOfOrigin_m = 20e3;
constexpr double kLongestHalfLife_s = 1e9;  // 30 years
constexpr double kLongestReach_m = 10e3;
constexpr double kLeastArea_m2 = 1e-6;

double twice_area(const ItemPart& ring) {
  double area = 0.0;
  for (std::size_t i = 0, j = ring.size() - 1; i < ring.size(); j = i++) {
    // Relative to a corner: coordinates are large.
    const Eigen::Vector2d a = ring[j] - ring[0];
    const Eigen::Vector2d b = ring[i] - ring[0];
    area += a.x() * b.y() - a.y() * b.x();
  }
  return std::abs(area);
}

class ItemReader {
 public:
  ItemReader(const std::string& file, const std::optional<GeoOrigin>& origin, std::int64_t now_ns)
      : fields_(file), now_ns_(now_ns) {
    if (origin) to_degrees_ = std::make_unique<const ToDegrees>(*origin);
  }

  ItemFile read(const ItemJson& json) {
    const ItemJson type = json.is_object() ? json.value("type", ItemJson()) : ItemJson();
    if (json.is_object() && to_degrees_ != nullptr)
      if (const auto other = foreign_reference(json.value("crs", ItemJson())))
        fields_.fault("crs", *other, "none, or WGS84 (urn:ogc:def:crs:OGC:1.3:CRS84)");
    if (type == "FeatureCollection") {
      const ItemJson features = fields_.list(json, "features");
      for (std::size_t i = 0; i < features.size(); ++i)
        read_feature(features[i], "features[" + std::to_string(i) + "]");
      if (features.empty() && fields_.problems().empty())
        fields_.fault("features", "none", "at least one item");
    } else if (type == "Feature") {
      read_feature(json, "feature");
    } else {
      fields_.fault("type", type.is_null() ? "nothing" : shown(type), "FeatureCollection");
    }
    if (!fields_.problems().empty()) throw BadInput(fields_.problems());
    if (!unused_.empty()) note("properties", unused_, "the properties of items alone");
    return std::move(result_);
  }

 private:
  void note(const std::string& field, const std::string& got, const std::string& want) {
    result_.notes.push_back({Severity::kWarning, fields_.file(), 0, field, got, want});
  }

  void read_feature(const ItemJson& feature, const std::string& where) {
    const std::size_t before = fields_.problems().size();
    if (!feature.is_object() || feature.value("type", ItemJson()) != "Feature")
      return fields_.fault(where, "no feature", "an object of type Feature");
    LayerItem item;
    item.recorded_ns = now_ns_;
    read_properties(feature.value("properties", ItemJson()), where + ".properties", item);
    read_geometry(feature.value("geometry", ItemJson()), where + ".geometry", item);
    if (fields_.problems().size() > before) return;
    result_.items.push_back(std::move(item));
  }

  void read_properties(const ItemJson& properties, const std::string& where, LayerItem& item) {
    if (!properties.is_object())
      return fields_.fault(where, shown(properties), "an object with kind and observed_utc");
    for (const auto& [name, value] : properties.items())
      if (!kProperties.contains(name) && unused_names_.insert(name).second)
        unused_ += (unused_.empty() ? "" : ", ") + name.substr(0, 40);
    const ItemJson kind = fields_.required(properties, where, "kind", is_kind, kind_names());
    const ItemJson observed = fields_.required(properties, where, "observed_utc", is_time,
                                               "a time such as 2024-05-17T08:30:00Z");
    const auto number = [&](const char* name, JsonFields::Is is, const char* want) {
      const ItemJson value = fields_.optional(properties, where, name, is, want);
      return value.is_null() ? std::optional<double>() : value.get<double>();
    };
    const auto half_life = number("half_life_s", is_half_life, "seconds above 0, to 1e9");
    item.speed = number("speed_mps", is_speed, "metres a second from 0 to 100");
    item.grip_factor = number("grip_factor", is_share, "0 to 1");
    const auto reach = number("reach_m", is_reach, "metres from 0 to 10000");
    const ItemJson text = fields_.optional(properties, where, "note", is_text, "text");
    if (!text.is_null()) item.note = text;
    if (!observed.is_null()) {
      item.observed_ns = *parse_utc(observed.get<std::string>());
      if (item.observed_ns > now_ns_)
        fields_.fault(where + ".observed_utc", shown(observed),
                      "a time up to " + utc_text(now_ns_));
    }
    if (kind.is_null()) return;
    const ItemKind& known = *find_item_kind(kind.get<std::string>());
    item.kind = known.name;
    item.half_life_s = half_life.value_or(known.half_life_s);
    item.reach_m = reach.value_or(-1.0);
    const bool wet = known.effect == ItemEffect::kGrip;
    if (wet && item.speed)
      fields_.fault(where + ".speed_mps", shown(properties["speed_mps"]),
                    "none for " + item.kind + " (grip_factor)");
    if (!wet && item.grip_factor)
      fields_.fault(where + ".grip_factor", shown(properties["grip_factor"]),
                    "none for " + item.kind + " (speed_mps)");
    if (known.effect == ItemEffect::kSpeed && !item.speed)
      fields_.fault(where + ".speed_mps", "nothing", "the speed that " + item.kind + " allows");
  }

  void read_geometry(const ItemJson& geometry, const std::string& where, LayerItem& item) {
    if (!geometry.is_object())
      return fields_.fault(where, geometry.is_null() ? "nothing" : shown(geometry), kGeometries);
    const ItemJson type = geometry.value("type", ItemJson());
    const std::string name = type.is_string() ? type.get<std::string>() : std::string();
    const bool several = name.starts_with("Multi");
    const std::string one = several ? name.substr(5) : name;
    const std::string field = where + ".coordinates";
    ItemJson parts = geometry.value("coordinates", ItemJson());
    if (one == "Point") {
      item.shape = ItemShape::kPoint;
      parts = several ? parts : ItemJson::array({parts});
      read_list(parts, field, "points", [&](const ItemJson& point, const std::string& at) {
        if (const auto p = position(point, at)) item.parts.push_back({*p});
      });
    } else if (one == "LineString") {
      item.shape = ItemShape::kLine;
      parts = several ? parts : ItemJson::array({parts});
      read_list(parts, field, "lines",
                [&](const ItemJson& line, const std::string& at) { read_line(line, at, item); });
    } else if (one == "Polygon") {
      item.shape = ItemShape::kPolygon;
      parts = several ? parts : ItemJson::array({parts});
      read_list(parts, field, "polygons", [&](const ItemJson& rings, const std::string& at) {
        read_list(rings, at, "rings", [&](const ItemJson& ring, const std::string& of_ring) {
          read_ring(ring, of_ring, item);
        });
      });
    } else {
      return fields_.fault(where + ".type", type.is_null() ? "nothing" : shown(type), kGeometries);
    }
    if (item.reach_m >= 0.0) return;
    const ItemKind* const kind = find_item_kind(item.kind);
    item.reach_m = item.shape == ItemShape::kPolygon || kind == nullptr ? 0.0 : kind->reach_m;
  }

  template <typename Read>
  void read_list(const ItemJson& list,
                 const std::string& where,
                 const std::string& of,
                 const Read& read) {
    if (!list.is_array() || list.empty())
      return fields_.fault(where, list.is_array() ? "an empty list" : shown(list),
                           "a list of " + of);
    for (std::size_t i = 0; i < list.size(); ++i)
      read(list[i], where + "[" + std::to_string(i) + "]");
  }

  std::optional<ItemPart> positions(const ItemJson& list, const std::string& where) {
    ItemPart part;
    const std::size_t before = fields_.problems().size();
    read_list(list, where, "positions", [&](const ItemJson& point, const std::string& at) {
      if (fields_.problems().size() > before) return;  // one fault a list is enough
      if (const auto p = position(point, at)) part.push_back(*p);
    });
    if (fields_.problems().size() > before) return std::nullopt;
    return part;
  }

  void read_line(const ItemJson& line, const std::string& where, LayerItem& item) {
    auto part = positions(line, where);
    if (!part) return;
    if (part->size() < 2) return fields_.fault(where, "one position", "two or more");
    item.parts.push_back(std::move(*part));
  }

  void read_ring(const ItemJson& ring, const std::string& where, LayerItem& item) {
    auto part = positions(ring, where);
    if (!part) return;
    if (part->size() > 1 && part->front() == part->back())
      part->pop_back();
    else
      note(where, "a ring that is not closed", "the first position again at its end");
    if (part->size() < 3)
      return fields_.fault(where, std::to_string(part->size()) + " corners", "three or more");
    if (!(0.5 * twice_area(*part) > kLeastArea_m2))
      return fields_.fault(where, "corners on a line", "a ring with an area");
    item.parts.push_back(std::move(*part));
  }

  std::optional<Eigen::Vector2d> position(const ItemJson& point, const std::string& where) {
    if (!point.is_array() || point.size() < 2 || !point[0].is_number() || !point[1].is_number()) {
      fields_.fault(where, shown(point),
                    to_degrees_ ? "longitude, latitude" : "x, y in metres, map frame");
      return std::nullopt;
    }
    const Eigen::Vector2d given(point[0].get<double>(), point[1].get<double>());
    const auto p = in_map(given);
    if (p && p->norm() < kFarthestOfOrigin_m) return p;
    const std::string text = std::to_string(given.x()) + ", " + std::to_string(given.y());
    if (to_degrees_ == nullptr) {
      fields_.fault(where, text, "x, y in metres, map frame, up to 20 km from its origin");
      return std::nullopt;
    }
    const auto swapped = in_map({given.y(), given.x()});
    fields_.fault(
        where, text + (p ? ", far from the map's origin" : ", which are no degrees"),
        std::string("longitude, latitude of this place in degrees") +
            (swapped && swapped->norm() < kFarthestOfOrigin_m ? " (here they are swapped)" : ""));
    return std::nullopt;
  }
  [[nodiscard]] std::optional<Eigen::Vector2d> in_map(const Eigen::Vector2d& given) const {
    return to_degrees_ ? to_degrees_->inverse(given) : given;
  }

  static bool is_kind(const ItemJson& v) {
    return v.is_string() && find_item_kind(v.get<std::string>()) != nullptr;
  }
  static bool is_time(const ItemJson& v) {
    return v.is_string() && parse_utc(v.get<std::string>()).has_value();
  }
  static bool is_within(const ItemJson& v, double most) {
    return v.is_number() && v.get<double>() >= 0.0 && v.get<double>() <= most;
  }
  static bool is_half_life(const ItemJson& v) {
    return is_within(v, kLongestHalfLife_s) && v.get<double>() > 0.0;
  }
  static bool is_speed(const ItemJson& v) { return is_within(v, 100.0); }
  static bool is_reach(const ItemJson& v) { return is_within(v, kLongestReach_m); }
  static const char* kind_names() {
    static const std::string names = [] {
      std::string text = "one of";
      for (const ItemKind& kind : item_kinds())
        text += std::string(text == "one of" ? " " : ", ") + kind.name;
      return text;
    }();
    return names.c_str();
  }

  static constexpr const char* kGeometries = "a point, line or polygon";
  inline static const std::set<std::string> kProperties{
      "kind", "observed_utc", "half_life_s", "speed_mps", "grip_factor", "reach_m", "note"};

  JsonFields fields_;
  std::unique_ptr<const ToDegrees> to_degrees_;
  std::int64_t now_ns_;
  std::set<std::string> unused_names_;
  std::string unused_;
  ItemFile result_;
};

}  // namespace

ItemFile read_item_file(const std::filesystem::path& file,
                        const std::optional<GeoOrigin>& origin,
                        std::int64_t now_ns) {
  const GdalScope scope;
  return ItemReader(file.string(), origin, now_ns).read(read_json_file(file, "items of layers"));
}

}  // namespace roadbook
