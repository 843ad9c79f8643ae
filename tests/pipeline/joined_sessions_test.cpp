#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tests/pipeline/visits.hpp"

// Landmarks that several sessions see must be as good as those of one session: a wrong match
// between visits must not survive in the map.

namespace roadbook {
namespace {

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values.at(static_cast<std::size_t>(q * static_cast<double>(values.size() - 1)));
}

// Residuals [px, full-size image] of the map's observations.
struct Residuals {
  std::vector<double> of_joined;  ///< lengths; landmarks of several sessions
  std::vector<double> of_one;     ///< lengths; landmarks of one session
  int joined = 0;                 ///< landmarks of several sessions
  int off = 0;                    ///< of them, off by more than 2 px (rms) in one session
};

Residuals residuals_of(const Map& map) {
  std::map<std::pair<int, int>, std::vector<double>> by_session;  // landmark, session
  for (const Observation& seen : map.observations) {
    const int session = map.keyframes[static_cast<std::size_t>(seen.keyframe)].session;
    const MountedCamera& camera = map.sessions[static_cast<std::size_t>(session)]
                                      .rig.cameras[static_cast<std::size_t>(seen.camera)];
    const Eigen::Vector3d p =
        (map.T_map_vehicle(seen.keyframe) * camera.T_vehicle_camera).inverse() *
        map.p_map(map.landmarks[static_cast<std::size_t>(seen.landmark)]);
    const auto pixel = camera.camera.project(p);
    by_session[{seen.landmark, session}].push_back(
        pixel ? (*pixel - seen.pixel.cast<double>()).norm() : 1e3);
  }
  std::map<int, std::vector<const std::vector<double>*>> by_landmark;
  for (const auto& [key, lengths] : by_session) by_landmark[key.first].push_back(&lengths);
  Residuals result;
  for (const auto& [landmark, sessions] : by_landmark) {
    bool is_off = false;
    for (const auto* lengths : sessions) {
      auto& all = sessions.size() > 1 ? result.of_joined : result.of_one;
      all.insert(all.end(), lengths->begin(), lengths->end());
      double sum = 0.0;
      for (const double length : *lengths) sum += length * length;
      is_off |= std::sqrt(sum / static_cast<double>(lengths->size())) > 2.0;
    }
    if (sessions.size() < 2) continue;
    ++result.joined;
    result.off += is_off ? 1 : 0;
  }
  return result;
}

using test::Visits;

TEST_F(Visits, AgreeOnTheirLandmarksAndWithTheTruth) {
  const std::filesystem::path file = folder() / "together.gpkg";
  const MapSummary summary = build_map(drives(), file, {});
  const Residuals residuals = residuals_of(load_map(file));
  EXPECT_GT(residuals.joined, 300);
  EXPECT_LT(residuals.off, 0.01 * residuals.joined);
  const double joined_px = quantile(residuals.of_joined, 0.95);
  const double one_px = quantile(residuals.of_one, 0.95);
  EXPECT_LE(joined_px, 1.2 * one_px) << joined_px << " px, " << one_px << " px";

  ASSERT_TRUE(summary.ate_median_m) << summary.truth_apart;
  EXPECT_LT(*summary.ate_median_m, 0.03);
  EXPECT_LT(*summary.ate_p95_m, 0.06);
  ASSERT_EQ(summary.truth_sessions.size(), 3U);
  for (const SessionTruth& session : summary.truth_sessions)
    EXPECT_LT(session.offset.value().shift_m.norm(), 0.03) << session.session;
}

}  // namespace
}  // namespace roadbook
