#include "workflows/report/truth_comparison.hpp"

#include "base/error.hpp"
#include "drive/drive.hpp"
#include "workflows/session_drives.hpp"

namespace roadbook {
namespace {

// `T_world_map`: the common alignment if there is one, so that one picture shows how sessions lie
// to each other.
TruthComparison comparison_of(const Map& map,
                              const SessionTruthError& session,
                              const Similarity& T_world_map) {
  TruthComparison result{session.session, session.error, {}, {}, session.offset};
  for (std::size_t i = 0; i < session.keyframes.size(); ++i) {
    const Eigen::Vector3d& truth = session.truth_m[i];
    // Converts the truth from its world to the map frame, so that one picture shows both.
    const Eigen::Vector3d in_map =
        T_world_map.R.transpose() * (truth - T_world_map.t) / T_world_map.scale;
    result.truth.emplace_back(in_map.x(), in_map.y());
    result.error_along_m.emplace_back(
        map.keyframes[static_cast<std::size_t>(session.keyframes[i])].travelled_m,
        (T_world_map * session.position_m[i] - truth).norm());
  }
  return result;
}

}  // namespace

TruthComparisons compare_with_truth(const std::filesystem::path& map_file, const Map& map) {
  TruthComparisons result;
  std::vector<DriveTruth> truths(map.sessions.size());
  std::vector<std::string> reasons(map.sessions.size(), "the drive is not available");
  for (std::size_t i = 0; i < map.sessions.size(); ++i) {
    try {
      truths[i] = truth_of_drive(Drive::open(session_folder(map_file, map.sessions[i])));
      reasons[i] = truths[i].poses.empty() ? "the drive has no truth"
                                           : "fewer than three keyframes of one piece have a truth";
    } catch (const Error&) {
    }
  }
  const TruthErrors errors = truth_errors(map, truths);
  result.together = errors.together;
  result.apart = errors.apart;
  for (std::size_t i = 0; i < map.sessions.size(); ++i) {
    if (const auto* session = errors.of_session(static_cast<int>(i)))
      result.sessions.push_back(comparison_of(map, *session,
                                              errors.together
                                                  ? errors.together->T_reference_estimate
                                                  : session->error.T_reference_estimate));
    else
      result.without_truth.push_back(map.sessions[i].name + ": " + reasons[i]);
  }
  return result;
}

}  // namespace roadbook
