#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "drive/drive.hpp"
#include "mapping/map.hpp"
#include "mapping/similarity.hpp"

namespace roadbook {

// Comparison of a map with the truth of its drives.
//
// The poses of one drive are known up to a rigid motion, so they are aligned before they are
// compared. Drives of one simulated place share a world: one SE(3) must align all of them, which
// also shows sessions that lie beside each other in the map.

/// The truth of a drive.
struct DriveTruth {
  std::vector<TimedPose> poses;      ///< of the vehicle (`true_poses`); empty: no truth
  std::optional<std::string> world;  ///< frame of `poses` (`true_world`); empty: one of its own
};
/// Reads the truth of a drive. Throws BadInput for poses that cannot be read.
[[nodiscard]] DriveTruth truth_of_drive(const Drive& drive);

/// Where the map places a session, relative to where the alignment of all sessions places its
/// truth.
struct SessionOffset {
  Eigen::Vector3d shift_m = Eigen::Vector3d::Zero();  ///< of the mean position, map axes
  /// About z, of the session's own best alignment. Empty where its positions lie on one line.
  std::optional<double> heading_rad;
};

/// Comparison of one session with the truth of its drive.
struct SessionTruthError {
  int session = 0;
  TrajectoryError error;                    ///< after the session's own best alignment
  std::vector<int> keyframes;               ///< that have a truth, ascending
  std::vector<Eigen::Vector3d> truth_m;     ///< positions of these keyframes in the truth's world
  std::vector<Eigen::Vector3d> position_m;  ///< the same in the map
  std::optional<SessionOffset> offset;      ///< empty without other sessions to compare with
};

struct TruthErrors {
  /// Those with truth at three keyframes or more, and in one piece of the map.
  std::vector<SessionTruthError> sessions;
  /// All sessions after one alignment: of a map of one session, or where the truths of all sessions
  /// share a world and the map is of one piece. Empty otherwise, never zero.
  std::optional<TrajectoryError> together;
  std::string apart;  ///< why `together` is empty although sessions have truth

  [[nodiscard]] const SessionTruthError* of_session(int session) const;
};

/// Compares the keyframes of each session of the map with its truth; `truths` go by session.
/// Alignments are SE(3); they have a free scale where nothing gave the map its scale.
[[nodiscard]] TruthErrors truth_errors(const Map& map, const std::vector<DriveTruth>& truths);

}  // namespace roadbook
