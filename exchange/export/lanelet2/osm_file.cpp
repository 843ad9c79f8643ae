#include "exchange/export/lanelet2/osm_file.hpp"

#include <cmath>

#include "exchange/export/planner/lane_bounds.hpp"
#include "exchange/layers/stored_paths.hpp"

namespace roadbook {
namespace {

constexpr double kShortestChord_m = 0.25;

std::string tag_text(const std::string& key, const std::string& value) {
  return "<tag k=\"" + key + "\" v=\"" + value + "\"/>";
}

std::string tags_text(const OsmTags& tags) {
  std::string text;
  for (const auto& [key, value] : tags) text += tag_text(key, value);
  return text;
}

std::string head_of(const char* kind, std::int64_t id) {
  return std::string("  <") + kind + " id=\"" + std::to_string(id) +
         "\" version=\"1\" visible=\"true\"";
}

}  // namespace

OsmFile::Cell OsmFile::cell_of(const Eigen::Vector3d& p) {
  return {static_cast<std::int64_t>(std::floor(p.x() / kNodeGap_m)),
          static_cast<std::int64_t>(std::floor(p.y() / kNodeGap_m))};
}

std::int64_t OsmFile::new_id() {
  while (!used_.insert(++last_).second) {
  }
  return last_;
}

std::int64_t OsmFile::node(const Eigen::Vector3d& p) {
  const std::int64_t id = new_id();
  const Eigen::Vector2d degrees = to_degrees_(p.head<2>());
  nodes_ += head_of("node", id) + " lat=\"" + fixed_text(degrees.y(), 11) + "\" lon=\"" +
            fixed_text(degrees.x(), 11) + "\">" + tag_text("ele", fixed_text(p.z(), 4));
  if (local_) {
    const Eigen::Vector2d local = to_degrees_.east_north(p.head<2>());
    nodes_ += tag_text("local_x", fixed_text(local.x(), 4)) +
              tag_text("local_y", fixed_text(local.y(), 4));
  }
  nodes_ += "</node>\n";
  positions_[id] = p;
  cells_[cell_of(p)].push_back(id);
  return id;
}

std::optional<std::int64_t> OsmFile::node_near(const Eigen::Vector3d& p) const {
  std::optional<std::int64_t> nearest;
  double least = kNodeGap_m;
  const auto [x, y] = cell_of(p);
  for (std::int64_t i = x - 1; i <= x + 1; ++i)
    for (std::int64_t j = y - 1; j <= y + 1; ++j) {
      const auto cell = cells_.find({i, j});
      if (cell == cells_.end()) continue;
      for (const std::int64_t id : cell->second)
        if (const double d = (position(id) - p).norm(); d < least) {
          least = d;
          nearest = id;
        }
    }
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
  ways_ += head_of("way", id) + ">";
  for (const std::int64_t n : nodes) ways_ += "<nd ref=\"" + std::to_string(n) + "\"/>";
  ways_ += tags_text(tags) + "</way>\n";
  return id;
}

void OsmFile::relation(std::int64_t id,
                       const std::vector<OsmMember>& members,
                       const OsmTags& tags) {
  relations_ += head_of("relation", id) + ">";
  for (const OsmMember& member : members)
    relations_ += std::string("<member type=\"") + member.type + "\" ref=\"" +
                  std::to_string(member.ref) + "\" role=\"" + member.role + "\"/>";
  relations_ += tags_text(tags) + "</relation>\n";
}

std::string OsmFile::text(const std::string& head) const {
  return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<osm version=\"0.6\" "
         "generator=\"roadbook\">\n" +
         head + nodes_ + ways_ + relations_ + "</osm>\n";
}

}  // namespace roadbook
