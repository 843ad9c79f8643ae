#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "base/cell_grid.hpp"
#include "exchange/export/geo_origin.hpp"
#include "exchange/export/xml_elements.hpp"

namespace roadbook {

// An OSM file for Lanelet2: nodes, ways and relations with tags. No two nodes are closer than
// `kNodeGap_m`, because Lanelet2's validator reports closer nodes as duplicates.

using OsmTags = std::vector<std::pair<std::string, std::string>>;

struct OsmMember {
  const char* type = "way";  ///< or "relation"
  std::int64_t ref = 0;
  std::string role;
};

class OsmFile {
 public:
  static constexpr double kNodeGap_m = 0.055;

  /// `autoware`: the file begins with Autoware's `MetaInfo`, and every node also has `local_x` and
  /// `local_y`, metres east and north of the origin.
  OsmFile(const ToDegrees& to_degrees, bool autoware);

  /// Reserves the given id of an element; false if the id is already used.
  bool reserve(std::int64_t id) { return used_.insert(id).second; }
  /// Returns an id that the file does not use yet.
  std::int64_t new_id();

  /// A new node at a point of the map [m].
  std::int64_t node(const Eigen::Vector3d& p);
  /// The node closer than `kNodeGap_m` to a point, if there is one; the nearest of several.
  [[nodiscard]] std::optional<std::int64_t> node_near(const Eigen::Vector3d& p) const;
  /// The node closer than `kNodeGap_m`, or else a new node.
  std::int64_t shared_node(const Eigen::Vector3d& p);
  /// Adds nodes along a dense line between two given nodes, as few as represent the line
  /// (chord_fits). A point too close to another node is replaced by a neighbouring point. Returns
  /// all nodes, with the given ones.
  std::vector<std::int64_t> nodes_along(const std::vector<Eigen::Vector3d>& line,
                                        std::int64_t first,
                                        std::int64_t last);
  [[nodiscard]] const Eigen::Vector3d& position(std::int64_t node) const {
    return positions_.at(node);
  }

  std::int64_t way(const std::vector<std::int64_t>& nodes, const OsmTags& tags);
  void relation(std::int64_t id, const std::vector<OsmMember>& members, const OsmTags& tags);

  /// Returns the file; to be called once, at the end.
  [[nodiscard]] std::string text() { return xml_text(document_); }

 private:
  const ToDegrees& to_degrees_;
  bool autoware_;
  std::int64_t last_ = 0;
  std::set<std::int64_t> used_;
  std::map<std::int64_t, Eigen::Vector3d> positions_;
  CellGrid<std::int64_t> grid_{kNodeGap_m};  // ids of nodes
  pugi::xml_document document_;
  pugi::xml_node end_of_nodes_, end_of_ways_, end_of_relations_;
};

}  // namespace roadbook
