#include "mapping/sessions/session_value.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/error.hpp"
#include "base/index.hpp"
#include "tests/mapping/localisation/synthetic_place.hpp"

// A session is worth what it takes off the standard deviations of the others. A drive that closes a
// loop ties the end of a long drive to its start; a drive beside a part of it does not.

namespace roadbook {
namespace {

constexpr double kRingStepM = 1.5;
constexpr double kReachM = 7.0;
constexpr double kRingDegree = std::numbers::pi / 180.0;

enum class JoinedBy { kLoops, kLandmarks };

// Three sessions on a ring road: the first drives 300 degrees of it, the second closes the ring,
// the third drives as far beside the first.
class RingMap {
 public:
  RingMap(std::uint64_t seed, JoinedBy joined_by, double step_m = kRingStepM)
      : random_(seed, "ring map"),
        radius_m_(random_.uniform(14.0, 22.0)),
        joined_by_(joined_by),
        step_m_(step_m) {
    for (int i = 0; i < 400; ++i) {
      const double a = random_.uniform(0.0, 2.0 * std::numbers::pi);
      const double r = radius_m_ + random_.uniform(-5.0, 5.0);
      points_.emplace_back(r * std::sin(a), radius_m_ - r * std::cos(a), random_.uniform(0.2, 3.0));
    }
    drive("long", 0.0, 300.0, 0.0);
    drive("closing", 280.0, 380.0, 0.5);
    const double begin = random_.uniform(60.0, 160.0);
    drive("parallel", begin, begin + 100.0, 0.5);
    add_landmarks();
  }
  [[nodiscard]] const Map& map() const { return map_; }

 private:
  void drive(const std::string& name, double from_deg, double to_deg, double left_m) {
    Session session;
    session.name = name;
    session.rig = test::fisheye_rig();
    session.wheels = WheelModel();
    session.scale_source = ScaleSource::kWheels;
    const int s = static_cast<int>(map_.sessions.size());
    map_.sessions.push_back(session);
    const double end_m = to_deg * kRingDegree * radius_m_;
    bool is_first = true;
    for (double along = from_deg * kRingDegree * radius_m_; along < end_m; along += step_m_) {
      const Eigen::Isometry3d T = test::ring_pose(radius_m_, along, left_m);
      Keyframe keyframe;
      keyframe.session = s;
      keyframe.map_frame = static_cast<int>(map_.map_frames.size());
      keyframe.t_ns = static_cast<std::int64_t>(map_.keyframes.size()) * 200'000'000;
      const int k = static_cast<int>(map_.keyframes.size());
      if (!is_first)
        keyframe.wheels = test::synthetic_wheels(map_.T_map_vehicle(k - 1), T, random_);
      is_first = false;
      map_.map_frames.push_back({T});
      map_.keyframes.push_back(keyframe);
      if (s > 0 && joined_by_ == JoinedBy::kLoops) close_loop(k);
    }
  }
  void close_loop(int k) {
    int nearest = -1;
    double least = kRingStepM;
    for (int other = 0; map_.keyframes[at(other)].session == 0; ++other) {
      const Eigen::Isometry3d T = map_.T_map_vehicle(other).inverse() * map_.T_map_vehicle(k);
      if (T.translation().norm() < least) {
        least = T.translation().norm();
        nearest = other;
      }
    }
    if (nearest < 0) return;
    LoopEdge loop;
    loop.from = nearest;
    loop.to = k;
    loop.T_from_to = map_.T_map_vehicle(nearest).inverse() * map_.T_map_vehicle(k);
    loop.information.diagonal() << Eigen::Vector3d::Constant(1.0 / (0.03 * 0.03)),
        Eigen::Vector3d::Constant(1.0 / (0.003 * 0.003));
    loop.accepted = true;
    map_.loops.push_back(loop);
  }
  void add_landmarks() {
    if (joined_by_ != JoinedBy::kLandmarks) return;
    const Rig rig = test::fisheye_rig();
    for (const Eigen::Vector3d& p : points_) {
      std::vector<Observation> seen;
      for (std::size_t k = 0; k < map_.keyframes.size(); ++k)
        for (std::size_t c = 0; c < rig.cameras.size(); ++c)
          if (const auto pixel =
                  test::seen_at(rig, c, map_.T_map_vehicle(static_cast<int>(k)), p, kReachM))
            seen.push_back({static_cast<int>(map_.landmarks.size()), static_cast<int>(k),
                            static_cast<int>(c), pixel->cast<float>(), 1.2F});
      if (seen.size() < 3) continue;
      Landmark landmark;
      landmark.map_frame = map_.keyframes[at(seen.front().keyframe)].map_frame;
      landmark.p_frame = map_.map_frames[at(landmark.map_frame)].T_map_frame.inverse() * p;
      map_.landmarks.push_back(landmark);
      map_.observations.insert(map_.observations.end(), seen.begin(), seen.end());
    }
    std::stable_sort(map_.observations.begin(), map_.observations.end(),
                     [](const Observation& a, const Observation& b) {
                       return std::pair(a.keyframe, a.camera) < std::pair(b.keyframe, b.camera);
                     });
  }

  Random random_;
  double radius_m_;
  JoinedBy joined_by_;
  double step_m_;  // between keyframes
  std::vector<Eigen::Vector3d> points_;
  Map map_;
};

void expect_closing_above_parallel(JoinedBy joined_by) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const RingMap ring(seed, joined_by);
    const Map& map = ring.map();
    std::vector<AnchoredPoint> labels;  // 2 m to the left of each pose of the first session
    for (int k = 0; map.keyframes[at(k)].session == 0; ++k) labels.push_back({k, {0.0, 2.0, 0.0}});
    const auto values = session_values(map, labels);
    ASSERT_EQ(values.size(), 3U);
    EXPECT_GT(values[1].poses.gain_m(), values[2].poses.gain_m());
    EXPECT_GT(values[1].points.gain_m(), values[2].points.gain_m());
    EXPECT_GT(values[2].poses.gain_m(), 0.0);
    EXPECT_EQ(values[1].points.count, labels.size());
    EXPECT_EQ(values[0].points.count, 0U);
    if (joined_by == JoinedBy::kLandmarks) continue;  // the ends of the two others may share some
    EXPECT_EQ(values[0].pieces_more, 1);
    EXPECT_EQ(values[1].pieces_more, 0);
    EXPECT_EQ(values[2].pieces_more, 0);
  }
}

TEST(SessionValue, RanksASessionThatClosesALoopAboveAParallelOneByLoops) {
  expect_closing_above_parallel(JoinedBy::kLoops);
}

TEST(SessionValue, RanksASessionThatClosesALoopAboveAParallelOneByLandmarks) {
  expect_closing_above_parallel(JoinedBy::kLandmarks);
}

LoopEdge edge_at_rest(int from, int to, double sigma) {
  LoopEdge loop;
  loop.from = from;
  loop.to = to;
  loop.information = Matrix6d::Identity() / (sigma * sigma);
  loop.accepted = true;
  return loop;
}

// Three poses at one place: motions do not turn, so that each axis is a system of two unknowns.
TEST(SessionValue, IsTheDifferenceOfTwoMarginals) {
  constexpr double kDirect = 0.3;
  constexpr double kDetour = 0.1;
  Map map;
  for (int s = 0; s < 2; ++s) {
    Session session;
    session.name = s == 0 ? "a" : "b";
    session.rig = test::fisheye_rig();
    map.sessions.push_back(session);
  }
  map.map_frames.push_back({});
  for (int k = 0; k < 3; ++k) {
    Keyframe keyframe;
    keyframe.session = k / 2;
    keyframe.t_ns = k;
    map.keyframes.push_back(keyframe);
  }
  map.loops = {edge_at_rest(0, 1, kDirect), edge_at_rest(0, 2, kDetour),
               edge_at_rest(1, 2, kDetour)};
  const auto values = session_values(map, {{1, {0.0, 2.0, 0.0}}});
  ASSERT_EQ(values.size(), 2U);

  const double bound_m = 0.01;  // 1 / (10 m)^2
  const auto variance = [&](double bound, bool with) {
    Eigen::Matrix2d H;  // of poses 1 and 2
    const double direct = 1.0 / (kDirect * kDirect);
    const double detour = with ? 1.0 / (kDetour * kDetour) : 0.0;
    H << direct + detour + bound, -detour, -detour, 2.0 * detour + bound;
    return Eigen::Matrix2d(H.inverse())(0, 0);
  };
  EXPECT_EQ(values[1].poses.count, 2U);  // the first is the gauge: half of the sum
  EXPECT_NEAR(values[1].poses.with_m, 0.5 * std::sqrt(3.0 * variance(bound_m, true)), 1e-9);
  EXPECT_NEAR(values[1].poses.without_m, 0.5 * std::sqrt(3.0 * variance(bound_m, false)), 1e-9);
  // A point 2 m aside moves with two of the rotations.
  const auto of_point = [&](bool with) {
    return std::sqrt(3.0 * variance(bound_m, with) + 2.0 * 4.0 * variance(1.0, with));
  };
  EXPECT_NEAR(values[1].points.with_m, of_point(true), 1e-9);
  EXPECT_NEAR(values[1].points.without_m, of_point(false), 1e-9);
}

// Half of the keyframes rank the sessions as all do. The sizes differ: the prior counts less.
TEST(SessionValue, RanksSessionsTheSameInAThinnedMap) {
  for (const JoinedBy joined_by : {JoinedBy::kLoops, JoinedBy::kLandmarks})
    for (std::uint64_t seed = 0; seed < 2; ++seed) {
      SCOPED_TRACE(::testing::Message() << "seed " << seed);
      const RingMap ring(seed, joined_by, 0.75);
      std::vector<AnchoredPoint> labels;
      for (int k = 0; k < 20; ++k) labels.push_back({k, {0.0, 2.0, 0.0}});
      SessionValueOptions options;
      options.most_keyframes = ring.map().keyframes.size();
      const auto all = session_values(ring.map(), labels, options);
      options.most_keyframes /= 2;
      const auto few = session_values(ring.map(), labels, options);
      ASSERT_EQ(few.size(), all.size());
      for (std::size_t s = 1; s < all.size(); ++s) {
        EXPECT_LT(few[s].poses.count, all[s].poses.count * 6 / 10);
        EXPECT_EQ(few[s].points.count, all[s].points.count);
      }
      EXPECT_GT(all[1].poses.gain_m(), all[2].poses.gain_m());
      EXPECT_GT(few[1].poses.gain_m(), few[2].poses.gain_m());
    }
}

TEST(SessionValue, IsEmptyForOneSession) {
  const Map map = test::synthetic_place(1, {.point_count = 50, .spacing_m = 5.0}).map;
  EXPECT_TRUE(session_values(map, {}).empty());
}

}  // namespace
}  // namespace roadbook
