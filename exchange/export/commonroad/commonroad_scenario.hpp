#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "exchange/export/commonroad/commonroad_network.hpp"
#include "exchange/export/export_notes.hpp"
#include "exchange/export/geo_origin.hpp"

namespace roadbook {

/// "<NAME>CONTENT</NAME>".
[[nodiscard]] std::string xml_element(const std::string& name, const std::string& content);

/// The elements of a CommonRoad scenario that are made from a map: lanelets, signs, intersections
/// and a planning problem. To be used within a GdalScope.
class CommonRoadScenario {
 public:
  /// `to_degrees`: turns the map to east and north; null: the map frame. `sign`: of a speed limit.
  CommonRoadScenario(const PlannerMap& map, const ToDegrees* to_degrees, std::string sign)
      : map_(map),
        to_degrees_(to_degrees),
        sign_(std::move(sign)),
        network_(lanelets_of(map)),
        lanelets_(directed_lanelets(network_)) {
    for (const DirectedLanelet& one : lanelets_) used_.insert(one.lanelet.id);
  }

  [[nodiscard]] bool empty() const { return lanelets_.empty(); }
  void add_roads();
  void add_crossings(ExportNotes& notes);
  void add_parking(ExportNotes& notes);
  void add_intersections();
  void add_problem();
  void count_heights(ExportNotes& notes) const;
  [[nodiscard]] std::string text() const {
    return lanelet_text_ + sign_text_ + intersection_text_ + problem_text_;
  }
  [[nodiscard]] bool has_turns() const { return !map_.layout().connectors.empty(); }

 private:
  [[nodiscard]] Eigen::Vector2d place(const Eigen::Vector3d& p) const {
    return to_degrees_ != nullptr ? to_degrees_->east_north(p.head<2>()) : p.head<2>();
  }
  [[nodiscard]] std::string point(const Eigen::Vector3d& p) const {
    const Eigen::Vector2d q = place(p);
    return xml_element(
        "point", xml_element("x", fixed_text(q.x(), 4)) + xml_element("y", fixed_text(q.y(), 4)));
  }
  [[nodiscard]] std::string bound(const char* name, const std::vector<Eigen::Vector3d>& line) const;
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
  void add_place(std::uint64_t id,
                 const std::vector<Eigen::Vector3d>& left,
                 const std::vector<Eigen::Vector3d>& right,
                 const std::string& kind);

  const PlannerMap& map_;
  const ToDegrees* to_degrees_;
  std::string sign_;
  LaneletNetwork network_;
  std::vector<DirectedLanelet> lanelets_;
  std::uint64_t last_ = 0;
  std::set<std::uint64_t> used_;
  std::string lanelet_text_, sign_text_, intersection_text_, problem_text_;
};

}  // namespace roadbook
