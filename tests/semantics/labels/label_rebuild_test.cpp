#include <gtest/gtest.h>

#include <cmath>

#include "semantics/labels/label_drives.hpp"
#include "semantics/labels/label_layers.hpp"
#include "semantics/labels/labels.hpp"
#include "tests/support/fisheye_rig.hpp"

// A map is built again from the same drives with another model or other options. The new map has
// other keyframes. The labels are anchored to times that no longer belong to a keyframe.

namespace roadbook {
namespace {

constexpr std::int64_t kBegin = 1'400'000'000'000'000'000;
constexpr double kDriveS = 14.0;

// A drive that accelerates, brakes and turns; returns the pose at any time.
Eigen::Isometry3d vehicle_at(double t) {
  return pose_from_planar(2.0 * t + 0.3 * std::sin(t), 0.1 * t * t, 0.2 * std::sin(0.5 * t));
}

// A map of the whole drive with keyframes every `step_s`.
Map map_every(double step_s) {
  Map map;
  Session session;
  session.name = "monday";
  session.rig = test::fisheye_rig();
  session.t_begin_ns = kBegin;
  session.t_end_ns = kBegin + std::llround(1e9 * kDriveS);
  map.sessions.push_back(session);
  for (int k = 0; k * step_s <= kDriveS; ++k) {
    map.map_frames.push_back({vehicle_at(k * step_s)});
    Keyframe keyframe;
    keyframe.t_ns = kBegin + std::llround(1e9 * k * step_s);
    keyframe.map_frame = keyframe.drive_frame = k;
    keyframe.covariance.setZero();
    keyframe.covariance.diagonal().setConstant(1e-6);
    map.keyframes.push_back(keyframe);
  }
  return map;
}

// A space 5 m to the left of each keyframe, in the vehicle frame of that keyframe.
std::vector<Label> labels_of(const Map& map) {
  std::vector<Label> labels;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Eigen::Isometry3d T = map.T_map_vehicle(static_cast<int>(k));
    const Eigen::Vector3d middle = T * Eigen::Vector3d(1.0, 5.0, 0.0);
    Label label = label_of_box(map, {0, map.keyframes[k].t_ns, 1},
                               {middle.head<2>(), std::atan2(T(1, 0), T(0, 0)), 5.0, 2.5});
    label.kind = "parking_space";
    label.id = static_cast<std::int64_t>(k) + 1;
    labels.push_back(label);
  }
  return labels;
}

TEST(LabelRebuild, KeepsEveryLabelInItsPlaceWhereKeyframesAreChosenAnew) {
  constexpr double kStepS = 0.35;
  const Map before = map_every(0.3);
  const Map after = map_every(kStepS);
  const std::vector<Label> labels = labels_of(before);
  // The distance between a chord and its arc is at most the acceleration times the squared step
  // over 8. The acceleration is 0.36 m/s^2 for the vehicle, plus 0.05 rad/s^2 at the label's 5.1 m.
  const double most_m = (0.36 + 0.05 * 5.1) * kStepS * kStepS / 8.0;
  int no_keyframe = 0;
  const double last_s = 1e-9 * static_cast<double>(after.keyframes.back().t_ns - kBegin);
  for (const Label& label : labels) {
    no_keyframe += keyframe_of(after, label.anchor) ? 0 : 1;
    const auto now = box_in_map(after, label);
    ASSERT_TRUE(now) << label.id;
    const double moved_m = (now->centre - box_in_map(before, label)->centre).norm();
    const double t = 1e-9 * static_cast<double>(label.anchor.t_ns - kBegin);
    // After the last keyframe, the position of the vehicle within a step is not known.
    const double step_m =
        (vehicle_at(last_s).translation() - vehicle_at(last_s - kStepS).translation()).norm();
    EXPECT_LT(moved_m, t > last_s ? 0.6 * step_m : most_m) << label.id;
    const auto covariance = covariance_in_map(after, label);
    ASSERT_TRUE(covariance);
    const Eigen::Vector2d moved = now->centre - box_in_map(before, label)->centre;
    EXPECT_LT(std::sqrt(moved.dot(covariance->ldlt().solve(moved))), 2.0) << label.id;
    // Between keyframes, the vehicle pose is at least as uncertain as at the keyframes.
    EXPECT_GT(covariance->determinant(), 0.99 * covariance_in_map(before, label)->determinant());
  }
  EXPECT_GT(no_keyframe, 30);
  const auto layers = label_layers(after, labels);
  ASSERT_EQ(layers.size(), 1U);
  EXPECT_EQ(layers[0].features.size(), labels.size());
  EXPECT_FALSE(warning_of_lost_places("map.gpkg", after, labels));
}

TEST(LabelRebuild, TellsHowManyLabelsHaveNoPlaceAndOfWhichDrives) {
  const Map before = map_every(0.3);
  std::vector<Label> labels = labels_of(before);
  Map after = map_every(0.35);
  // The track has a gap before keyframe 10, and two labels belong to a drive that the map lacks.
  after.keyframes[10].after_gap = true;
  std::size_t in_gap = 0;
  for (const Label& label : labels)
    if (label.anchor.t_ns > after.keyframes[9].t_ns && label.anchor.t_ns < after.keyframes[10].t_ns)
      ++in_gap;
  ASSERT_GT(in_gap, 0U);
  labels[3].anchor.session = labels[4].anchor.session = 1;
  const auto warning = warning_of_lost_places("map.gpkg", after, labels);
  ASSERT_TRUE(warning);
  EXPECT_EQ(warning->severity, Severity::kWarning);
  EXPECT_EQ(warning->got,
            std::to_string(in_gap) + " of drive monday, 2 of drive number 2, which it lacks");
  EXPECT_EQ(label_layers(after, labels).at(0).features.size(), labels.size() - in_gap - 2);
}

}  // namespace
}  // namespace roadbook
