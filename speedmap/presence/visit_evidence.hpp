#pragma once

#include <Eigen/Core>
#include <vector>

#include "speedmap/presence/presence_grid.hpp"

namespace roadbook {

// Evidence of one visit for each place: a person was met there, or the place was in sight and
// empty. The source uses detections alone. Then a place that was seen empty a hundred times is as
// dangerous as a place that was never seen.

/// A person seen from one pose.
struct SeenPerson {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< of the feet [m, map frame]
  double sigma_m = 0.3;
  double probability = 1.0;  ///< that it is a person
};

/// One look around.
struct VisitFrame {
  Eigen::Vector2d position = Eigen::Vector2d::Zero();  ///< of the vehicle [m, map frame]
  double duration_s = 0.0;                             ///< until the next one
  std::vector<SeenPerson> people;
  double heading = 0.0;  ///< of the vehicle [rad]; for `reach_m`
  /// How far the ground was in sight, in equal sectors counter-clockwise from the heading [m].
  /// Empty: out to the range of the options, where no blocker stands.
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
  double range_m = 12.0;  ///< people are found out to here
  double person_m = 1.0;  ///< a place this near to somebody's feet is taken; sigma comes to it
  /// A look of this long tells 63 % of what a visit can tell: what is seen in successive frames is
  /// the same people.
  double look_s = 1.0;

  /// Throws InvalidOption.
  void check() const;
};

struct VisitEvidence {
  std::vector<double> seen_s;      ///< by node: how long it was in sight
  std::vector<double> person_s;    ///< how long a person was seen there, times probability
  std::size_t people = 0;          ///< sightings used
  std::size_t people_off_map = 0;  ///< where the map has no place
};

/// True where no blocker lies between the two points.
[[nodiscard]] bool in_sight(const Eigen::Vector2d& from,
                            const Eigen::Vector2d& to,
                            const std::vector<SightBlocker>& blockers);

/// Sums up a visit. Throws InvalidOption, and BadInput for a person whose position is not finite,
/// whose sigma is negative or whose probability is outside 0 to 1.
[[nodiscard]] VisitEvidence gather_evidence(const PresenceGrid& grid,
                                            const std::vector<VisitFrame>& frames,
                                            const std::vector<SightBlocker>& blockers,
                                            const SightOptions& options);

/// The visit as observations z, worth `weight` of a fresh one (its age: map_ages.hpp). z = 1 where
/// a person was, with the share w = 1 - exp(-person_s / look_s) of a visit's full weight. z = 0
/// with the share (1 - w)(1 - exp(-seen_s / look_s)). A visit never weighs more than one visit.
///
/// With the grid's `literal` option: z = 1 with weight 1 for every sighting at its cell, nothing
/// else; only this option reads `frames`.
[[nodiscard]] std::vector<PresenceObservation> observations_of(
    const PresenceGrid& grid,
    const VisitEvidence& evidence,
    const std::vector<VisitFrame>& frames,
    const SightOptions& options,
    double weight = 1.0);

}  // namespace roadbook
