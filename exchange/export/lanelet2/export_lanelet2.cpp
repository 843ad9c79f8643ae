#include <algorithm>
#include <cmath>
#include <map>

#include "base/whole_file.hpp"
#include "exchange/export/export_formats.hpp"
#include "exchange/export/lanelet2/autoware_parking.hpp"
#include "exchange/export/lanelet2/osm_file.hpp"
#include "exchange/export/planner/crosswalk.hpp"
#include "exchange/export/planner/lanelets.hpp"
#include "exchange/export/planner/plan_polygon.hpp"
#include "mapping/layers/map_layers_gdal.hpp"

// Lanelet2's OSM file, plain or with Autoware's extensions. Lanelets that follow each other share
// the nodes of their bounds: that is how its routing knows. Bounds are half the swept width beside
// the centre: where vehicles went, not what is painted.
//
// Rules: Lanelet2 1.2 (LaneletAndAreaTagging.md, lanelet2_validation: CheckTags, PointsTooClose,
// CurvatureTooBig); autoware_lanelet2_extension (lanelet2_format_extension.md,
// extra_regulatory_elements.md, query.cpp); Autoware's vector map requirements vm-01-01, vm-05-01.

namespace roadbook {
namespace {

constexpr const char* kWalkingSpeed = "5";  // [km/h], Lanelet2's own for pedestrians

std::int64_t osm_id(std::uint64_t id) { return static_cast<std::int64_t>(id); }

// km/h with two decimals, never above.
std::string speed_text(double speed) {
  const double hundredths = std::floor(speed * 360.0 + 1e-6);
  return fixed_text(std::max(hundredths, 1.0) / 100.0, 2);
}

struct Section {
  std::int64_t left = 0, right = 0;
};

// Everything that a lanelet becomes in the file but its relation, which may still get members.
struct Road {
  const Lanelet* lanelet;
  std::int64_t left = 0, right = 0;      // ways
  bool tight = false;                    // a bound bends more than Lanelet2's validator allows
  std::vector<std::int64_t> rules = {};  // regulatory elements
};

class LaneletFile {
 public:
  LaneletFile(const PlannerMap& map, const ToDegrees& to_degrees, bool autoware)
      : map_(map), network_(lanelets_of(map)), autoware_(autoware), osm_(to_degrees, autoware) {
    for (const Lanelet& lanelet : network_.lanelets) {
      osm_.reserve(osm_id(lanelet.id));
      osm_.reserve(osm_id(id_of_way_back(lanelet)));
    }
    add_sections();
    for (const Lanelet& lanelet : network_.lanelets) roads_.push_back(road_of(lanelet));
  }

  void add_crossings(ExportNotes& notes);
  void add_parking(ExportNotes& notes) {
    autoware_ ? add_autoware_parking(notes) : add_parking_areas(notes);
  }
  void add_roads();
  [[nodiscard]] std::string text() { return osm_.text(); }
  void count_tight_bends(ExportNotes& notes) const;

 private:
  void add_sections();
  Road road_of(const Lanelet& lanelet);
  void add_road(const Road& road, bool back);
  std::int64_t add_crosswalk(const Crosswalk& walk, std::int64_t id);
  std::int64_t add_crosswalk_rule(const Crosswalk& walk, std::int64_t lanelet);
  void add_parking_areas(ExportNotes& notes);
  void add_autoware_parking(ExportNotes& notes);
  std::vector<std::int64_t> corner_nodes(const std::vector<Eigen::Vector3d>& ring);
  std::int64_t stable_id(const std::string& label, LabelKind kind);

  const PlannerMap& map_;
  LaneletNetwork network_;
  bool autoware_;
  OsmFile osm_;
  std::vector<Section> sections_;
  std::vector<Road> roads_;
};

// Two sections of one lane never share nodes: a lanelet between them would have no length.
void LaneletFile::add_sections() {
  sections_.resize(static_cast<std::size_t>(network_.sections));
  std::map<std::int64_t, int> piece_of_node;
  const auto node_at = [&](const Eigen::Vector3d& p, int piece) {
    const auto near = osm_.node_near(p);
    const std::int64_t id = near && piece_of_node.at(*near) != piece ? *near : osm_.node(p);
    piece_of_node[id] = piece;
    return id;
  };
  for (const Lanelet& lanelet : network_.lanelets) {
    if (lanelet.piece < 0) continue;
    const auto add = [&](const LaneletEnd& end, const Eigen::Vector3d& l,
                         const Eigen::Vector3d& r) {
      Section& section = sections_[static_cast<std::size_t>(end.section)];
      if (section.left == 0) section = {node_at(l, lanelet.piece), node_at(r, lanelet.piece)};
    };
    add(lanelet.first, lanelet.bounds.left.front(), lanelet.bounds.right.front());
    add(lanelet.last, lanelet.bounds.left.back(), lanelet.bounds.right.back());
  }
}

Road LaneletFile::road_of(const Lanelet& lanelet) {
  const auto nodes_of = [&](const LaneletEnd& end) {
    const Section& s = sections_[static_cast<std::size_t>(end.section)];
    return end.turned ? Section{s.right, s.left} : s;
  };
  const Section first = nodes_of(lanelet.first);
  const Section last = nodes_of(lanelet.last);
  Road road{&lanelet};
  const auto bound = [&](const std::vector<Eigen::Vector3d>& line, std::int64_t a, std::int64_t b) {
    constexpr double kMostOfValidator = 0.5;
    const auto nodes = osm_.nodes_along(line, a, b);
    std::vector<Eigen::Vector3d> points;
    for (const std::int64_t node : nodes) points.push_back(osm_.position(node));
    road.tight = road.tight || largest_curvature(points) > kMostOfValidator;
    return osm_.way(nodes, {{"type", "virtual"}});
  };
  road.left = bound(lanelet.bounds.left, first.left, last.left);
  road.right = bound(lanelet.bounds.right, first.right, last.right);
  return road;
}

const char* to_text(TurnDirection direction) {
  switch (direction) {
    case TurnDirection::kLeft:
      return "left";
    case TurnDirection::kRight:
      return "right";
    case TurnDirection::kStraight:
      break;
  }
  return "straight";
}

void LaneletFile::add_road(const Road& road, bool back) {
  const Lanelet& lanelet = *road.lanelet;
  OsmTags tags{{"type", "lanelet"},
               {"subtype", "road"},
               {"location", "urban"},
               {"one_way", lanelet.both_ways && !autoware_ ? "no" : "yes"},
               {"speed_limit", speed_text(lanelet.speed)}};
  if (autoware_) tags.emplace_back("participant:vehicle", "yes");
  if (autoware_ && lanelet.connector >= 0)
    tags.emplace_back("turn_direction",
                      to_text(turn_direction(back ? reversed(lanelet) : lanelet)));
  std::vector<OsmMember> members{{"way", back ? road.right : road.left, "left"},
                                 {"way", back ? road.left : road.right, "right"}};
  for (const std::int64_t rule : road.rules)
    members.push_back({"relation", rule, "regulatory_element"});
  osm_.relation(osm_id(back ? id_of_way_back(lanelet) : lanelet.id), members, tags);
}

// Autoware knows one-way lanelets alone: the way back is one more lanelet between the same bounds.
void LaneletFile::add_roads() {
  for (const Road& road : roads_) {
    add_road(road, false);
    if (autoware_ && road.lanelet->both_ways) add_road(road, true);
  }
}

std::vector<std::int64_t> LaneletFile::corner_nodes(const std::vector<Eigen::Vector3d>& ring) {
  std::vector<std::int64_t> nodes;
  for (const Eigen::Vector3d& p : ring) {
    const std::int64_t node = osm_.shared_node(p);
    if (nodes.empty() || (node != nodes.back() && node != nodes.front())) nodes.push_back(node);
  }
  return nodes;
}

std::int64_t LaneletFile::stable_id(const std::string& label, LabelKind kind) {
  std::uint64_t id = id_of_label(label, kind);
  while (!osm_.reserve(osm_id(id))) ++id;
  return osm_id(id);
}

std::int64_t LaneletFile::add_crosswalk(const Crosswalk& walk, std::int64_t id) {
  const auto bound = [&](const std::array<Eigen::Vector3d, 2>& ends) {
    return osm_.way({osm_.shared_node(ends[0]), osm_.shared_node(ends[1])},
                    {{"type", "pedestrian_marking"}});
  };
  const std::int64_t left = bound(walk.left);
  const std::int64_t right = bound(walk.right);
  OsmTags tags{{"type", "lanelet"},
               {"subtype", "crosswalk"},
               {"location", "urban"},
               {"one_way", "no"},
               {"speed_limit", kWalkingSpeed}};
  if (autoware_) tags.emplace_back("participant:pedestrian", "yes");
  osm_.relation(id, {{"way", left, "left"}, {"way", right, "right"}}, tags);
  return id;
}

std::int64_t LaneletFile::add_crosswalk_rule(const Crosswalk& walk, std::int64_t lanelet) {
  const std::int64_t polygon =
      osm_.way(corner_nodes(walk.outline), {{"type", "crosswalk_polygon"}, {"area", "yes"}});
  const std::int64_t rule = osm_.new_id();
  osm_.relation(rule, {{"relation", lanelet, "refers"}, {"way", polygon, "crosswalk_polygon"}},
                {{"type", "regulatory_element"}, {"subtype", "crosswalk"}});
  return rule;
}

void LaneletFile::add_crossings(ExportNotes& notes) {
  for (const Crosswalk& walk : crosswalks_of(map_, network_, autoware_, notes)) {
    const std::int64_t id = add_crosswalk(walk, stable_id(walk.label, LabelKind::kCrossing));
    if (!autoware_) continue;
    const std::int64_t rule = add_crosswalk_rule(walk, id);
    for (const std::size_t road : walk.crossed) roads_[road].rules.push_back(rule);
  }
}

// The side at the lane and the three others as one line each: a ring of lines that share nodes.
void LaneletFile::add_parking_areas(ExportNotes& notes) {
  std::size_t empty = 0;
  std::size_t links = 0;
  for (const PlannerSpace& space : map_.spaces()) {
    const auto nodes =
        encloses_ground(space.corners) ? corner_nodes(space.corners) : std::vector<std::int64_t>();
    if (nodes.size() < 3) {
      ++empty;
      continue;
    }
    links += space.link ? 1 : 0;
    std::vector<std::int64_t> others(nodes.begin() + 1, nodes.end());
    others.push_back(nodes.front());
    const OsmTags line{{"type", "virtual"}};
    const std::int64_t open = osm_.way({nodes[0], nodes[1]}, line);
    const std::int64_t rest = osm_.way(others, line);
    osm_.relation(stable_id(space.id, LabelKind::kSpace),
                  {{"way", open, "outer"}, {"way", rest, "outer"}},
                  {{"type", "multipolygon"}, {"subtype", "parking"}, {"location", "urban"}});
  }
  add_note(notes, "parking spaces", empty, "their outline encloses no ground or crosses itself");
  add_note(notes, "links of parking spaces to lanes", links,
           "Lanelet2 has no place for them; --profile autoware has");
}

void LaneletFile::add_autoware_parking(ExportNotes& notes) {
  const AutowareParking parking = autoware_parking(map_, network_);
  for (const AutowareSpace& space : parking.spaces)
    osm_.way({osm_.shared_node(space.front), osm_.shared_node(space.back)},
             {{"type", "parking_space"}, {"width", fixed_text(space.width_m, 3)}});
  for (const auto& lot : parking.lots)
    osm_.way(corner_nodes(lot), {{"type", "parking_lot"}, {"area", "yes"}});
  add_note(notes, "parking spaces", parking.no_rectangle,
           "Autoware's are rectangles; --profile lanelet2 writes any shape");
  add_note(notes, "parking spaces", parking.no_lane,
           "no lane within 5 m that they face, as Autoware wants; --profile lanelet2 writes them");
}

void LaneletFile::count_tight_bends(ExportNotes& notes) const {
  const auto tight =
      std::count_if(roads_.begin(), roads_.end(), [](const Road& road) { return road.tight; });
  add_note(notes, "bounds that bend no more than 0.5 1/m", static_cast<std::size_t>(tight),
           "these lanelets are too short for it; Lanelet2's validator warns of them");
}

}  // namespace

const std::vector<std::string>& lanelet2_profiles() {
  static const std::vector<std::string> profiles{"lanelet2", "autoware"};
  return profiles;
}

Paths export_lanelet2(const std::filesystem::path& map,
                      const std::filesystem::path& out,
                      const ExportOptions& options,
                      ExportNotes& notes) {
  const PlannerMap planner(map);
  const GeoOrigin origin = require_origin(map, options, "Lanelet2 is in degrees");
  const GdalScope scope;
  const ToDegrees to_degrees(origin);
  LaneletFile file(planner, to_degrees, options.profile == "autoware");
  file.add_crossings(notes);
  file.add_parking(notes);
  file.add_roads();
  file.count_tight_bends(notes);
  add_note(notes, "labels of other classes", planner.other_labels(),
           "Lanelet2 has no place for them; --format gpkg has");
  write_whole_file(out, file.text());
  return {out};
}

}  // namespace roadbook
