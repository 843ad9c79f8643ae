#pragma once

#include <filesystem>
#include <vector>

#include "drive/drive.hpp"
#include "semantics/people/person_oracle.hpp"
#include "speedmap/presence/visit_evidence.hpp"

namespace roadbook {

/// The truth lists people up to this multiple of the search range. A detector need not find those
/// beyond the range. At the end of the range, a window for a short person fits a tall person at
/// nearly 1.5 times the distance. If such a person counted as absent, the learner would get wrong
/// negative examples, and correct detections would count as false.
inline constexpr double kListedRange = 2.0;

/// All people in a simulated drive, as its cameras see them. The evaluation uses this as a perfect
/// labeller. A person is in sight if walls, pillars, parked cars and other people leave at least
/// `kReasonableShare` of the body visible.
class PeopleTruth {
 public:
  /// Throws BadInput where the drive has no `truth/`.
  explicit PeopleTruth(const Drive& drive);

  struct Instant {
    std::vector<TruePerson> people;     ///< camera by camera
    std::vector<int> who;               ///< index into `feet`, one for each person above
    std::vector<Eigen::Vector2d> feet;  ///< vehicle frame [m]
  };
  /// Returns the people whose feet and crown `cameras` see within `kListedRange` times the greatest
  /// range. People farther than `max_range_m`, nearer than `min_range_m` or out of sight are not
  /// clear. Empty if the drive has no true pose at that time.
  [[nodiscard]] Instant at(std::int64_t t_ns,
                           const std::vector<PersonCamera>& cameras,
                           double min_range_m,
                           double max_range_m) const;
  [[nodiscard]] bool has_people() const { return !rows_.empty(); }

 private:
  struct Row {
    std::int64_t t_ns = 0;
    int id = 0;
    Eigen::Vector2d place = Eigen::Vector2d::Zero();  ///< world frame
    double height_m = 1.74;
  };
  struct Standing {
    Eigen::Vector3d foot;  ///< vehicle frame [m]
    double height_m = 0.0;
  };
  [[nodiscard]] std::vector<Standing> standing_at(std::int64_t t_ns,
                                                  const Eigen::Isometry3d& T_world_vehicle) const;
  [[nodiscard]] Eigen::Vector2d place_at(std::vector<Row>::const_iterator row,
                                         std::int64_t t_ns) const;
  [[nodiscard]] double ground_at(const Eigen::Vector2d& place, double otherwise) const;

  std::vector<TimedPose> poses_;
  std::vector<Row> rows_;  ///< by time, then id
  std::vector<SightBlocker> blockers_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  double step_m_ = 0.5;
  std::vector<std::vector<double>> heights_;
};

}  // namespace roadbook
