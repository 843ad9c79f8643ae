#include "exchange/export/planner/plan_polygon.hpp"

namespace roadbook {

namespace {

std::unique_ptr<OGRPolygon> outline_of(const std::vector<Eigen::Vector3d>& ring) {
  OGRLinearRing outline;
  for (const Eigen::Vector3d& p : ring) outline.addPoint(p.x(), p.y());
  outline.closeRings();
  auto polygon = std::make_unique<OGRPolygon>();
  polygon->addRing(&outline);
  return polygon;
}

}  // namespace

PlanGeometry polygon_of(const std::vector<Eigen::Vector3d>& ring) {
  auto polygon = outline_of(ring);
  if (polygon->IsValid() == TRUE) return polygon;
  return PlanGeometry(polygon->Buffer(0.0));
}

PlanGeometry polygon_of(const LaneBounds& bounds) {
  std::vector<Eigen::Vector3d> ring = bounds.left;
  ring.insert(ring.end(), bounds.right.rbegin(), bounds.right.rend());
  return polygon_of(ring);
}

bool encloses_ground(const std::vector<Eigen::Vector3d>& ring) {
  constexpr double kLeast_m2 = 0.1;
  if (ring.size() < 3) return false;
  const auto polygon = outline_of(ring);
  return polygon->IsValid() == TRUE && polygon->get_Area() >= kLeast_m2;
}

double ground_of(const PlanGeometry& shape) {
  if (!shape) return 0.0;
  if (wkbFlatten(shape->getGeometryType()) == wkbPolygon) return shape->toPolygon()->get_Area();
  return OGR_GT_IsSubClassOf(shape->getGeometryType(), wkbGeometryCollection) != 0
             ? shape->toGeometryCollection()->get_Area()
             : 0.0;
}

PlanGeometry line_of(const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
  auto line = std::make_unique<OGRLineString>();
  line->addPoint(from.x(), from.y());
  line->addPoint(to.x(), to.y());
  return line;
}

}  // namespace roadbook
