#pragma once

#include <ogr_geometry.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "exchange/export/planner/lane_bounds.hpp"

namespace roadbook {

// Polygons and lines in the plane for GEOS. Use within a GdalScope.

using PlanGeometry = std::unique_ptr<OGRGeometry>;

/// The polygon inside a ring of points; for a ring that crosses itself, the union of its parts.
[[nodiscard]] PlanGeometry polygon_of(const std::vector<Eigen::Vector3d>& ring);
/// The ground between the bounds of a lanelet.
[[nodiscard]] PlanGeometry polygon_of(const LaneBounds& bounds);
/// Whether a ring encloses ground (0.1 m^2 and more) without crossing itself.
[[nodiscard]] bool encloses_ground(const std::vector<Eigen::Vector3d>& ring);
/// Ground that a shape covers [m^2]; 0 where the shape has no area.
[[nodiscard]] double ground_of(const PlanGeometry& shape);
[[nodiscard]] PlanGeometry line_of(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

}  // namespace roadbook
