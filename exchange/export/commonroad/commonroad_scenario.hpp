#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "exchange/export/commonroad/commonroad_network.hpp"
#include "exchange/export/export_notes.hpp"
#include "exchange/export/geo_origin.hpp"
#include "exchange/export/xml_elements.hpp"

namespace roadbook {

/// Writes the elements of a CommonRoad scenario that are made from a map: lanelets, signs,
/// intersections and a planning problem. To be used within a GdalScope.
class CommonRoadScenario {
 public:
  /// `root`: top-level element, to which the elements are appended. `to_degrees`: turns the map to
  /// east and north; null: the map frame. `sign`: of a speed limit.
  CommonRoadScenario(pugi::xml_node root,
                     const PlannerMap& map,
                     const ToDegrees* to_degrees,
                     std::string sign);

  [[nodiscard]] bool empty() const { return lanelets_.empty(); }
  void add_roads();
  void add_crossings(ExportNotes& notes);
  void add_parking(ExportNotes& notes);
  void add_intersections();
  void add_problem();
  void count_heights(ExportNotes& notes) const;

 private:
  [[nodiscard]] Eigen::Vector2d place(const Eigen::Vector3d& p) const {
    return to_degrees_ != nullptr ? to_degrees_->east_north(p.head<2>()) : p.head<2>();
  }
  void append_point(pugi::xml_node parent, const Eigen::Vector3d& p) const;
  void append_bound(pugi::xml_node lanelet,
                    const char* name,
                    const std::vector<Eigen::Vector3d>& line) const;
  std::uint64_t next_id() {
    while (!used_.insert(++last_).second) {
    }
    return last_;
  }
  std::uint64_t stable_id(const std::string& label, LabelKind kind) {
    std::uint64_t id = id_of_label(label, kind);
    while (!used_.insert(id).second) ++id;
    return id;
  }
  std::uint64_t add_limit(const Lanelet& lanelet);
  void add_incoming(pugi::xml_node intersection, std::size_t lane);
  void add_place(std::uint64_t id,
                 const std::vector<Eigen::Vector3d>& left,
                 const std::vector<Eigen::Vector3d>& right,
                 const std::string& kind);

  const PlannerMap& map_;
  const ToDegrees* to_degrees_;
  std::string sign_;
  LaneletNetwork network_;
  std::vector<DirectedLanelet> lanelets_;
  pugi::xml_node end_of_lanelets_, end_of_signs_, end_of_intersections_, end_of_problems_;
  std::uint64_t last_ = 0;
  std::set<std::uint64_t> used_;
};

}  // namespace roadbook
