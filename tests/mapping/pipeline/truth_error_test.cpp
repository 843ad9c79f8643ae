#include "mapping/pipeline/truth_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "base/se3.hpp"

namespace roadbook {
namespace {

// Two sessions of 20 keyframes along one bend, whose stamps are the same. The truth lies in a world
// that is turned and moved against the map.
class TwoSessions : public ::testing::Test {
 protected:
  TwoSessions() {
    for (int s = 0; s < 2; ++s) {
      map_.sessions.emplace_back().name = "visit" + std::to_string(s);
      map_.sessions.back().scale_source = ScaleSource::kWheels;
      truths_.push_back({{}, "lot, size full, seed 1"});
      for (int k = 0; k < 20; ++k) {
        const double along = 0.1 * k;
        const Eigen::Isometry3d T_map_vehicle =
            pose_from_planar(10.0 * std::sin(along) + 0.3 * s, 10.0 * std::cos(along), -along);
        Keyframe keyframe;
        keyframe.session = s;
        keyframe.t_ns = 1'000'000'000LL * k;
        keyframe.map_frame = static_cast<int>(map_.map_frames.size());
        map_.map_frames.push_back({T_map_vehicle});
        map_.keyframes.push_back(keyframe);
        truths_.back().poses.push_back({keyframe.t_ns, T_world_map_ * T_map_vehicle});
      }
    }
  }
  // Moves session `s` in the map by `D`, in map axes.
  void move_session(int s, const Eigen::Isometry3d& D) {
    for (const Keyframe& keyframe : map_.keyframes)
      if (keyframe.session == s) {
        auto& T = map_.map_frames[static_cast<std::size_t>(keyframe.map_frame)].T_map_frame;
        T = D * T;
      }
  }

  const Eigen::Isometry3d T_world_map_ = pose_from_planar(40.0, -7.0, 2.0);
  Map map_;
  std::vector<DriveTruth> truths_;
};

TEST_F(TwoSessions, InPlaceHaveNoError) {
  const TruthErrors errors = truth_errors(map_, truths_);
  ASSERT_TRUE(errors.together);
  EXPECT_EQ(errors.together->count, 40U);
  EXPECT_LT(errors.together->max_m, 1e-9);
  ASSERT_EQ(errors.sessions.size(), 2U);
  for (const SessionTruthError& session : errors.sessions) {
    ASSERT_TRUE(session.offset);
    EXPECT_LT(session.offset->shift_m.norm(), 1e-9);
    EXPECT_NEAR(session.offset->heading_rad.value(), 0.0, 1e-9);
  }
}

// Each session alone is without error. Together they lie 0.2 m and 0.01 rad apart; the common
// alignment goes through the middle.
TEST_F(TwoSessions, ASessionBesideTheOtherShowsInTheCommonErrorAndTheOffsetsAlone) {
  const Eigen::Isometry3d turned = pose_from_planar(0.0, 0.0, 0.01);
  move_session(1, turned);
  const auto middle = [&](int s) {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Keyframe& keyframe : map_.keyframes)
      if (keyframe.session == s)
        sum +=
            map_.map_frames[static_cast<std::size_t>(keyframe.map_frame)].T_map_frame.translation();
    return Eigen::Vector3d(sum / 20.0);
  };
  const Eigen::Vector3d shift(0.12, -0.16, 0.0);
  // Turned about its own middle, then shifted.
  const Eigen::Vector3d back = turned.inverse() * middle(1) - middle(1);
  move_session(1, Eigen::Isometry3d(Eigen::Translation3d(shift + back)));
  const TruthErrors errors = truth_errors(map_, truths_);
  ASSERT_EQ(errors.sessions.size(), 2U);
  for (const SessionTruthError& session : errors.sessions) EXPECT_LT(session.error.max_m, 1e-9);
  ASSERT_TRUE(errors.together);
  EXPECT_GT(errors.together->median_m, 0.08);
  EXPECT_LT(errors.together->median_m, 0.16);
  const SessionOffset first = errors.of_session(0)->offset.value();
  const SessionOffset second = errors.of_session(1)->offset.value();
  EXPECT_LT((second.shift_m - first.shift_m - shift).norm(), 0.003);
  EXPECT_LT((second.shift_m + first.shift_m).norm(), 1e-9);
  EXPECT_NEAR(second.heading_rad.value() - first.heading_rad.value(), 0.01, 1e-9);
  EXPECT_GT(second.heading_rad.value(), 0.0);
}

TEST_F(TwoSessions, AreNotComparedTogetherWithoutACommonWorld) {
  const auto expect_apart = [&](const std::string& why) {
    const TruthErrors errors = truth_errors(map_, truths_);
    EXPECT_FALSE(errors.together);
    EXPECT_NE(errors.apart.find(why), std::string::npos) << errors.apart;
    for (const SessionTruthError& session : errors.sessions) EXPECT_FALSE(session.offset);
    return errors.sessions.size();
  };
  truths_[1].world = "lot, size full, seed 2";
  EXPECT_EQ(expect_apart("different worlds (lot, size full, seed 1; lot, size full, seed 2)"), 2U);
  truths_[1].world.reset();
  EXPECT_EQ(expect_apart("recorded references"), 2U);
  truths_[1] = {{}, truths_[0].world};
  EXPECT_EQ(expect_apart("not all sessions have truth"), 1U);
  truths_[0].poses.clear();
  EXPECT_EQ(expect_apart(""), 0U);
  EXPECT_TRUE(truth_errors(map_, truths_).apart.empty()) << "nothing to say without any truth";
}

TEST_F(TwoSessions, OfDifferentPiecesAreNotComparedTogether) {
  for (Keyframe& keyframe : map_.keyframes) keyframe.piece = keyframe.session;
  const TruthErrors errors = truth_errors(map_, truths_);
  EXPECT_FALSE(errors.together);
  EXPECT_EQ(errors.apart, "the map has pieces that nothing joins");
  EXPECT_EQ(errors.sessions.size(), 2U);
  // A session in two pieces has no error even alone.
  map_.keyframes[3].piece = 2;
  EXPECT_EQ(truth_errors(map_, truths_).sessions.size(), 1U);
}

TEST_F(TwoSessions, OneOfThemAloneNeedsNoWorldAndHasNoOffset) {
  map_.sessions.resize(1);
  map_.keyframes.resize(20);
  truths_.resize(1);
  truths_.front().world.reset();
  const TruthErrors errors = truth_errors(map_, truths_);
  ASSERT_TRUE(errors.together);
  EXPECT_EQ(errors.together->count, 20U);
  EXPECT_FALSE(errors.sessions.front().offset);
}

TEST_F(TwoSessions, OnALineHaveNoHeadingOfTheirOwn) {
  for (std::size_t k = 0; k < map_.keyframes.size(); ++k) {
    const Eigen::Isometry3d T = pose_from_planar(0.5 * static_cast<double>(k % 20), 0.0, 0.0);
    map_.map_frames[k].T_map_frame = T;
    truths_[k / 20].poses[k % 20].T_world_vehicle = T;
  }
  const TruthErrors errors = truth_errors(map_, truths_);
  ASSERT_TRUE(errors.sessions.front().offset);
  EXPECT_FALSE(errors.sessions.front().offset->heading_rad);
}

// The map's scale is free only if no session has one.
TEST_F(TwoSessions, KeepTheirScaleUnlessNothingGaveOne) {
  for (auto& frame : map_.map_frames) frame.T_map_frame.translation() *= 1.1;
  EXPECT_GT(truth_errors(map_, truths_).together->median_m, 0.1);
  map_.sessions[0].scale_source = ScaleSource::kFree;
  EXPECT_GT(truth_errors(map_, truths_).together->median_m, 0.1);
  map_.sessions[1].scale_source = ScaleSource::kFree;
  EXPECT_LT(truth_errors(map_, truths_).together->median_m, 1e-9);
}

}  // namespace
}  // namespace roadbook
