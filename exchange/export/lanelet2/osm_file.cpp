#include "exchange/export/lanelet2/osm_file.hpp"

#include <cmath>

#include "exchange/export/planner/lane_bounds.hpp"
#include "exchange/layers/stored_paths.hpp"

namespace roadbook {
namespace {

constexpr double kShortestChord_m = 0.25;

void append_tag(pugi::xml_node element, const std::string& key, const std::string& value) {
  append_element(element, "tag", {{"k", key}, {"v", value}});
}

void append_tags(pugi::xml_node element, const OsmTags& tags) {
  for (const auto& [key, value] : tags) append_tag(element, key, value);
}

pugi::xml_node insert_primitive(pugi::xml_node place, const char* kind, std::int64_t id) {
  return insert_line(place, kind,
                     {{"id", std::to_string(id)}, {"version", "1"}, {"visible", "true"}});
}

}  // namespace

OsmFile::OsmFile(const ToDegrees& to_degrees, bool autoware)
    : to_degrees_(to_degrees), autoware_(autoware) {
  const pugi::xml_node osm =
      append_element(document_, "osm", {{"version", "0.6"}, {"generator", "roadbook"}});
  if (autoware) append_line(osm, "MetaInfo", {{"format_version", "1.0"}, {"map_version", "1.0"}});
  end_of_nodes_ = append_place(osm);
  end_of_ways_ = append_place(osm);
  end_of_relations_ = append_place(osm);
}

std::int64_t OsmFile::new_id() {
  while (!used_.insert(++last_).second) {
  }
  return last_;
}

std::int64_t OsmFile::node(const Eigen::Vector3d& p) {
  const std::int64_t id = new_id();
  const Eigen::Vector2d degrees = to_degrees_(p.head<2>());
  pugi::xml_node node = insert_primitive(end_of_nodes_, "node", id);
  node.append_attribute("lat").set_value(fixed_text(degrees.y(), 11).c_str());
  node.append_attribute("lon").set_value(fixed_text(degrees.x(), 11).c_str());
  append_tag(node, "ele", fixed_text(p.z(), 4));
  if (autoware_) {
    const Eigen::Vector2d local = to_degrees_.east_north(p.head<2>());
    append_tag(node, "local_x", fixed_text(local.x(), 4));
    append_tag(node, "local_y", fixed_text(local.y(), 4));
  }
  positions_[id] = p;
  grid_.insert(p.head<2>(), id);
  return id;
}

std::optional<std::int64_t> OsmFile::node_near(const Eigen::Vector3d& p) const {
  std::optional<std::int64_t> nearest;
  double least = kNodeGap_m;
  grid_.visit_near(p.head<2>(), [&](std::int64_t id) {
    if (const double d = (position(id) - p).norm(); d < least) {
      least = d;
      nearest = id;
    }
  });
  return nearest;
}

std::int64_t OsmFile::shared_node(const Eigen::Vector3d& p) {
  const auto near = node_near(p);
  return near ? *near : node(p);
}

std::vector<std::int64_t> OsmFile::nodes_along(const std::vector<Eigen::Vector3d>& line,
                                               std::int64_t first,
                                               std::int64_t last) {
  std::vector<std::int64_t> nodes{first};
  const auto length = [&](std::size_t i, std::size_t j) { return (line[j] - line[i]).norm(); };
  const std::size_t end = line.size() - 1;
  for (std::size_t from = 0; from < end;) {
    std::size_t shortest = from + 1;
    while (shortest < end && length(from, shortest) < kShortestChord_m) ++shortest;
    std::size_t to = shortest;
    while (to < end && chord_fits(line, from, to + 1)) ++to;
    while (to < end && length(to, end) < 0.5 * kShortestChord_m) ++to;
    // Backwards from there, then forwards.
    std::size_t place = to;
    while (place > shortest && place < end && node_near(line[place])) --place;
    if (place < end && node_near(line[place]))
      for (place = to; place < end && node_near(line[place]);) ++place;
    if (place >= end) break;
    nodes.push_back(node(line[place]));
    from = place;
  }
  nodes.push_back(last);
  return nodes;
}

std::int64_t OsmFile::way(const std::vector<std::int64_t>& nodes, const OsmTags& tags) {
  const std::int64_t id = new_id();
  const pugi::xml_node way = insert_primitive(end_of_ways_, "way", id);
  for (const std::int64_t n : nodes) append_element(way, "nd", {{"ref", std::to_string(n)}});
  append_tags(way, tags);
  return id;
}

void OsmFile::relation(std::int64_t id,
                       const std::vector<OsmMember>& members,
                       const OsmTags& tags) {
  const pugi::xml_node relation = insert_primitive(end_of_relations_, "relation", id);
  for (const OsmMember& member : members)
    append_element(
        relation, "member",
        {{"type", member.type}, {"ref", std::to_string(member.ref)}, {"role", member.role}});
  append_tags(relation, tags);
}

}  // namespace roadbook
