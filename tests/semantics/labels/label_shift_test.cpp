#include "semantics/labels/label_shift.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <numbers>

#include "base/random.hpp"
#include "mapping/optimisation/graph_relaxation.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "semantics/labels/label_agreement.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/mapping/store/small_map.hpp"
#include "tests/semantics/label_map.hpp"

// Labels on a drive round a block. The map's wheel calibration is wrong, so the map is bent until a
// loop closure repairs it. The test uses the pose graph's solver and the map file.

namespace roadbook {
namespace {

constexpr int kPerLap = 120;
constexpr int kPoses = kPerLap + 25;  // a lap and the beginning of a second lap
constexpr double kDrawingM = 0.04;

struct Block {
  std::vector<Eigen::Isometry3d> truth;
  PoseGraph graph;                        ///< odometry with the wrong calibration, and the loops
  std::vector<Eigen::Isometry3d> bent;    ///< without the loops
  std::vector<Eigen::Isometry3d> mended;  ///< with them
};

Matrix6d information(double sigma_m, double sigma_rad) {
  Vector6d diagonal;
  diagonal << Eigen::Vector3d::Constant(1.0 / (sigma_m * sigma_m)),
      Eigen::Vector3d::Constant(1.0 / (sigma_rad * sigma_rad));
  return diagonal.asDiagonal();
}

// `yaw_bias`: heading error of each step of odometry [rad].
Block drive_round_the_block(double yaw_bias, std::uint64_t seed) {
  Random random(seed, "block");
  Block block;
  for (int i = 0; i < kPoses; ++i) {
    const double a = 2.0 * std::numbers::pi * i / kPerLap;
    block.truth.push_back(pose_from_planar(30.0 * std::sin(a), 20.0 * (1.0 - std::cos(a)),
                                           std::atan2(20.0 * std::sin(a), 30.0 * std::cos(a))));
  }
  const auto measure = [&](int a, int b, double m, double rad, double bias) {
    Vector6d xi;
    for (int i = 0; i < 6; ++i) xi[i] = (i < 3 ? m : rad) * random.normal();
    xi[5] += bias;
    const auto& T = block.truth;
    return RelativePose{
        a, b,
        T[static_cast<std::size_t>(a)].inverse() * T[static_cast<std::size_t>(b)] * se3_exp(xi),
        information(m, rad), -1};
  };
  for (int i = 0; i + 1 < kPoses; ++i)
    block.graph.odometry.push_back(measure(i, i + 1, 0.005, 0.001, yaw_bias));
  for (int i = kPerLap; i < kPoses; i += 2)
    block.graph.loops.push_back(measure(i - kPerLap, i, 0.02, 0.003, 0.0));
  block.bent = {block.truth.front()};
  for (const RelativePose& edge : block.graph.odometry)
    block.bent.push_back(block.bent.back() * edge.T_from_to);
  block.graph.T_map_vehicle = block.bent;
  PoseGraphOptions options;
  options.robust = false;
  block.mended = relax(block.graph, options).T_map_vehicle;
  return block;
}

// The covariances of a map without knowledge of the bend: the noise of its odometry, accumulated
// step by step.
std::vector<Matrix6d> believed_covariances(const std::vector<Eigen::Isometry3d>& poses) {
  std::vector<Matrix6d> covariances{Matrix6d::Zero()};
  const Matrix6d step = information(0.005, 0.001).inverse();
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const Matrix6d A = se3_adjoint(poses[i].inverse() * poses[i - 1]);
    covariances.push_back(A * covariances.back() * A.transpose() + step);
  }
  return covariances;
}

Map map_of(const std::vector<Eigen::Isometry3d>& poses) {
  Map map = test::label_map(static_cast<int>(poses.size()));
  const auto covariances = believed_covariances(poses);
  for (std::size_t k = 0; k < poses.size(); ++k) {
    map.map_frames[k].T_map_frame = poses[k];
    map.keyframes[k].T_frame_vehicle.setIdentity();
    map.keyframes[k].covariance = covariances[k];
  }
  return map;
}

// A space to the left of a pose, drawn with a random error at its place in the image of that pose.
// The label is anchored to the image before. If the relative pose of the two images is wrong in the
// map, the label is wrong by the same amount.
Label drawn(const Map& map, std::size_t k, Random& random) {
  const Eigen::Isometry3d T = map.T_map_vehicle(static_cast<int>(k));
  OrientedBox box;
  box.centre = (T * Eigen::Vector3d(1.0, 5.0, 0.0)).head<2>() +
               kDrawingM * Eigen::Vector2d(random.normal(), random.normal());
  box.heading = std::atan2(T(1, 0), T(0, 0));
  Label label = label_of_box(map, {0, map.keyframes[k - 1].t_ns, 1}, box);
  label.kind = "parking_space";
  label.sigma_m = kDrawingM;
  return label;
}

// Several labels at each pose, so that the medians of their errors depend on the map and not on
// single draws.
std::vector<Label> all_drawn(const Map& map, Random& random) {
  std::vector<Label> labels;
  for (int i = 0; i < 8; ++i)
    for (std::size_t k = 2; k < kPoses; ++k) labels.push_back(drawn(map, k, random));
  return labels;
}

double median_error_m(const std::vector<Eigen::Isometry3d>& truth,
                      const Map& map,
                      const std::vector<Label>& labels) {
  std::vector<double> errors;
  for (const Label& label : labels) {
    const auto k = static_cast<std::size_t>(*keyframe_of(map, label.anchor)) + 1;
    const Eigen::Vector2d want = (truth[k] * Eigen::Vector3d(1.0, 5.0, 0.0)).head<2>();
    errors.push_back((box_in_map(map, label)->centre - want).norm());
  }
  std::sort(errors.begin(), errors.end());
  return errors[errors.size() / 2];
}

TEST(LabelShift, LabelsOfABentMapAreAsGoodAsNewOnesOnceALoopHasMendedIt) {
  const test::Folder folder;
  const auto file = folder / "map.gpkg";
  const Block block = drive_round_the_block(0.0004, 1);
  const Map bent = map_of(block.bent);
  MapFileBuilder(file, "one").finish(bent, {});
  Random random(2, "labels");
  {
    LabelStore store(file);
    store.create_all(all_drawn(bent, random), "ann");
  }
  const double bent_m = median_error_m(block.truth, bent, read_labels(file));
  MapFileBuilder(file, "two")
      .finish(map_of(block.mended), {});  // the same drive with its loop closure

  const Map mended = load_map(file);
  const auto moved = read_labels(file);
  const std::vector<Label> fresh = all_drawn(mended, random);
  ASSERT_EQ(moved.size(), fresh.size());
  const double moved_m = median_error_m(block.truth, mended, moved);
  const double fresh_m = median_error_m(block.truth, mended, fresh);
  EXPECT_GT(bent_m, 4.0 * fresh_m);  // the bend is large enough to need a repair
  EXPECT_LE(moved_m, 1.1 * fresh_m) << "bent " << bent_m;
  RecordProperty("bent_m", std::to_string(bent_m));
  RecordProperty("moved_m", std::to_string(moved_m));
  RecordProperty("fresh_m", std::to_string(fresh_m));
  // The shift report is correct both from the old map and from the places where ann saw the labels.
  const LabelShifts shifts = label_shifts(bent, mended, moved);
  const LabelShifts since = shifts_since_seen(mended, moved);
  ASSERT_EQ(shifts.shifts.size(), moved.size());
  ASSERT_EQ(since.shifts.size(), moved.size());
  for (std::size_t i = 0; i < moved.size(); ++i) {
    const int k = *keyframe_of(mended, moved[i].anchor);
    const Eigen::Vector3d in_vehicle = moved[i].T_vehicle_label.translation();
    const Eigen::Vector3d want =
        mended.T_map_vehicle(k) * in_vehicle - bent.T_map_vehicle(k) * in_vehicle;
    EXPECT_NEAR((shifts.shifts[i].after - shifts.shifts[i].before - want.head<2>()).norm(), 0,
                1e-9);
    EXPECT_NEAR(since.shifts[i].sigmas, shifts.shifts[i].sigmas, 1e-6);
  }
  EXPECT_GT(shift_quantile_m(shifts.shifts, 0.5), 0.5 * bent_m);
}

TEST(LabelShift, OnlyWhatMovedFartherThanItsPlaceWasKnownNeedsAHuman) {
  Map map = test::label_map(40);
  std::vector<Label> labels;
  for (std::size_t k = 5; k < 40; ++k) {
    Label label = label_of_box(map, {0, map.keyframes[k].t_ns, 1},
                               {{0.5 * static_cast<double>(k), 5.0}, 0.0, 5.0, 2.5});
    label.id = static_cast<std::int64_t>(k);
    label.kind = "parking_space";
    label.seen = seen_in_map(map, label);
    labels.push_back(label);
  }
  // The map is solved again. All poses move as their covariances allow; one pose moves much
  // farther.
  Random random(4, "poses");
  for (Keyframe& keyframe : map.keyframes) {
    Vector6d xi;
    for (int j = 0; j < 6; ++j) xi[j] = random.normal();
    xi = keyframe.covariance.llt().matrixL() * xi;
    keyframe.T_frame_vehicle = keyframe.T_frame_vehicle * se3_exp(0.7 * xi);
  }
  map.keyframes[20].T_frame_vehicle.translation().y() += 0.5;
  std::vector<std::int64_t> listed;
  for (const LabelShift& shift : shifts_since_seen(map, labels).shifts)
    if (shift.sigmas > kLargestShiftSigmas) listed.push_back(shift.label.id);
  EXPECT_EQ(listed, std::vector<std::int64_t>{20});
}

// Each space of the first metres has a sighting in an image of the second pass.
std::vector<Label> seen_twice(const Block& block, std::uint64_t seed) {
  Random random(seed, "twice");
  const Map map = map_of(block.truth);
  std::vector<Label> labels;
  for (std::size_t k = 2; k + kPerLap < kPoses; ++k) {
    Label label = drawn(map, k, random);
    const Label again = drawn(map, k, random);
    const std::size_t later = k + kPerLap;
    const Eigen::Vector3d place = block.truth[k - 1] * again.T_vehicle_label.translation();
    label.sightings.push_back(
        {{0, map.keyframes[later].t_ns, 1}, block.truth[later].inverse() * place, kDrawingM});
    labels.push_back(label);
  }
  return labels;
}

TEST(LabelAgreement, ABendThatTheMapDoesNotKnowOfShowsInLabelsSeenTwice) {
  int flagged = 0;
  int false_alarms = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Block bent = drive_round_the_block(0.0008, seed);
    const LabelAgreement bad = agreement_of(map_of(bent.bent), seen_twice(bent, seed));
    flagged += bad.contradicts() ? 1 : 0;
    EXPECT_EQ(bad.sightings.size(), seen_twice(bent, seed).size());
    // The same drive without a bias, and the repaired map.
    const Block straight = drive_round_the_block(0.0, seed);
    false_alarms += agreement_of(map_of(straight.bent), seen_twice(straight, seed)).contradicts();
    false_alarms += agreement_of(map_of(bent.mended), seen_twice(bent, seed)).contradicts();
  }
  EXPECT_GE(flagged, 19);
  EXPECT_EQ(false_alarms, 0);
}

TEST(LabelAgreement, WithoutSightingsThereIsNothingToContradict) {
  const Map map = test::label_map(5);
  EXPECT_FALSE(agreement_of(map, {}).contradicts());
  EXPECT_EQ(agreement_of(map, {}).chance, 1.0);
}

}  // namespace
}  // namespace roadbook
