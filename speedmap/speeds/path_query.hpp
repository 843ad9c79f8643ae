#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "speedmap/fields/label_field.hpp"
#include "speedmap/fields/occupancy_field.hpp"
#include "speedmap/property_map/lane_strips.hpp"
#include "speedmap/property_map/property_map.hpp"
#include "speedmap/speeds/lane_speeds.hpp"

namespace roadbook {

// A query at (s, e) of a lane: speed, grip and class of the ground, occupancy and labels, with
// gradients and variances.
// Presence and friction are stored at knots in the same path coordinates and interpolated by the
// same kernel, so both are smooth functions for a controller.

/// A value at (s, e), its gradient there and its variance.
struct SmoothValue {
  double value = 0.0;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();  ///< d / ds, d / de
  double variance = 0.0;
};

/// Probability that a surface is at the point, from the occupancy grid.
struct OccupancyAnswer {
  SmoothValue probability;
  double age_s = 0.0;  ///< since the newest reading of the cell; NaN: unknown
};

/// A label near the point.
struct LabelNearby {
  const LabelledOutline* label = nullptr;  ///< id, class and sigma; lives as long as the field
  /// Signed distance to the outline [m], negative within it; variance NaN where the label has none.
  SmoothValue distance;
};

/// Content of the plane. Null: the map has none. Both must outlive the query.
struct GroundFields {
  const OccupancyField* occupancy = nullptr;
  const LabelField* labels = nullptr;
};

struct PathAnswer {
  std::uint64_t lane = 0;
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< [m, map frame]
  /// The lowest of the lane's profile at s, the speed recommended by presence at (s, e), and the
  /// speed that can be stopped from within sight on the friction at (s, e).
  SmoothValue speed;
  SpeedLimitedBy limited_by = SpeedLimitedBy::kLaw;
  std::optional<SmoothValue> presence;
  std::optional<PropertyMomentsDerivatives> friction;  ///< of the next measurement
  std::vector<double> ground_shares;         ///< expected proportions of the property map's classes
  PlaceClass place = PlaceClass::kOther;     ///< label of the ground there
  std::optional<OccupancyAnswer> occupancy;  ///< empty: no grid, or no reading in the cell
  std::optional<std::vector<LabelNearby>> labels;  ///< within reach, nearest first; empty: no field
};

/// A lane with its speeds, presence and friction, prepared for queries. Immutable; safe to share
/// between threads.
class LaneQuery {
 public:
  /// `presence` is sampled at knots over the lane's tube. `place` returns the class of the ground.
  /// `friction` (may be null) is a property map over `strips`. `friction` and `strips` must outlive
  /// the query. Throws InvalidOption for a lane that has no strip.
  LaneQuery(const LaneStrips& strips,
            const LaneProfile& profile,
            const PresenceAt& presence,
            const std::function<PlaceClass(const Eigen::Vector2d&)>& place,
            const PropertyMap* friction,
            const LaneSpeedOptions& options,
            double knot_spacing_m = 1.0,
            const GroundFields& fields = {});

  /// Empty outside the tube, beyond an open end, and for values that are not finite.
  [[nodiscard]] std::optional<PathAnswer> at(double s_m, double e_m) const;

 private:
  [[nodiscard]] std::optional<SmoothValue> presence_at(const PathPlace& v) const;
  [[nodiscard]] const LaneSpeed& place_near(double s_m) const;
  [[nodiscard]] SmoothValue profile_at(double s_m) const;
  void add_fields(double s_m, double e_m, PathAnswer& answer) const;
  [[nodiscard]] SmoothValue stopping_at(const PropertyMomentsDerivatives& friction,
                                        double factor) const;

  const LaneStrips::Strip* strip_;
  LaneProfile profile_;
  std::optional<Knots> knots_;  ///< those with presence; none where the dynamic map is elsewhere
  std::vector<PresenceValue> values_;
  std::function<PlaceClass(const Eigen::Vector2d&)> place_;
  const PropertyMap* friction_;
  LaneSpeedOptions options_;
  GroundFields fields_;
};

}  // namespace roadbook
