#pragma once

#include <Eigen/Core>
#include <vector>

#include "speedmap/presence/presence_grid.hpp"

namespace roadbook {

// Evidence of one visit for each location: a person was met there, or the location was in sight and
// empty. The paper uses detections only. With detections only, a location that was seen empty a
// hundred times is as dangerous as one that was never seen.

/// A person seen from one pose.
struct SeenPerson {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< of the feet [m, map frame]
  double sigma_m = 0.3;
  double probability = 1.0;  ///< that it is a person
};

/// One instant at which the cameras searched for people.
struct VisitFrame {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< of the vehicle [m, map frame]
  double duration_s = 0.0;                             ///< until the next one
  std::vector<SeenPerson> people;
  double heading = 0.0;  ///< of the vehicle [rad]; for `reach_m`
  /// Visible range of the ground, in equal sectors counter-clockwise from the heading [m]. Empty:
  /// the range of the options, limited by the blockers.
  std::vector<double> reach_m{};
};

/// An upright obstacle, from a to b [m, map frame]; it hides the ground behind it.
struct SightBlocker {
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
};

/// Adds the sides of a closed outline.
void add_sides(const Outline& outline, std::vector<SightBlocker>& blockers);

struct SightOptions {
  double range_m = 12.0;  ///< people are detected up to this range
  double person_m = 1.0;  ///< radius around a foot point that counts as occupied, plus its sigma
  /// Time in sight that gives 63 % of the weight of a visit. Successive frames are not independent,
  /// because they show the same people.
  double look_s = 1.0;

  /// Throws InvalidOption.
  void check() const;
};

struct VisitEvidence {
  std::vector<double> seen_s;      ///< by node: time in sight
  std::vector<double> person_s;    ///< by node: time with a person there, times probability
  std::size_t people = 0;          ///< detections used
  std::size_t people_off_map = 0;  ///< detections where the map has no cell
};

/// True where no blocker lies between the two points.
[[nodiscard]] bool in_sight(const Eigen::Vector2d& from,
                            const Eigen::Vector2d& to,
                            const std::vector<SightBlocker>& blockers);

/// Sums up the evidence of a visit. Throws InvalidOption, and BadInput for a person with a position
/// that is not finite, a negative sigma or a probability outside 0 to 1.
[[nodiscard]] VisitEvidence gather_evidence(const PresenceGrid& grid,
                                            const std::vector<VisitFrame>& frames,
                                            const std::vector<SightBlocker>& blockers,
                                            const SightOptions& options);

/// Converts a visit to observations z with the factor `weight` for its age (map_ages.hpp). z = 1 at
/// a node with a person has the share w = 1 - exp(-person_s / look_s) of the full weight of a
/// visit. z = 0 has the share (1 - w)(1 - exp(-seen_s / look_s)). The two shares never exceed one
/// visit.
///
/// With the grid's `literal` option: z = 1 with weight 1 for every detection at its cell, and no
/// other observation; only this option reads `frames`.
[[nodiscard]] std::vector<PresenceObservation> observations_of(
    const PresenceGrid& grid,
    const VisitEvidence& evidence,
    const std::vector<VisitFrame>& frames,
    const SightOptions& options,
    double weight = 1.0);

}  // namespace roadbook
