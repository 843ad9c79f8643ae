#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <numbers>
#include <thread>

#include "base/error.hpp"
#include "base/random.hpp"
#include "mapping/optimisation/graph_relaxation.hpp"
#include "mapping/similarity.hpp"
#include "tests/support/g2o.hpp"
#include "tests/support/real_data.hpp"

namespace roadbook {
namespace {

constexpr double kSigmaStep = 0.01;   // odometry: metres a step
constexpr double kSigmaTurn = 0.003;  // radians a step
constexpr double kSigmaLoop = 0.03;
constexpr double kSigmaLoopTurn = 0.005;

Matrix6d information(double sigma_m, double sigma_rad) {
  Vector6d diagonal;
  diagonal << Eigen::Vector3d::Constant(1.0 / (sigma_m * sigma_m)),
      Eigen::Vector3d::Constant(1.0 / (sigma_rad * sigma_rad));
  return diagonal.asDiagonal();
}

Eigen::Isometry3d disturbed(const Eigen::Isometry3d& T, double m, double rad, Random& random) {
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi(i) = (i < 3 ? m : rad) * random.normal();
  return T * se3_exp(xi);
}

struct Laps {
  std::vector<Eigen::Isometry3d> truth;
  PoseGraph graph;
};

// Laps of an oval, `per_lap` poses each; a loop every few poses to the same place a lap before.
Laps drive_laps(int per_lap, int laps, std::uint64_t seed, int every = 4) {
  Random random(seed, "laps");
  Laps result;
  const int n = per_lap * laps;
  for (int i = 0; i < n; ++i) {
    const double a = 2.0 * std::numbers::pi * i / per_lap;
    result.truth.push_back(pose_from_planar(30.0 * std::sin(a), 20.0 * (1.0 - std::cos(a)),
                                            std::atan2(20.0 * std::sin(a), 30.0 * std::cos(a))));
  }
  const auto add = [&](std::vector<RelativePose>& edges, int a, int b, double m, double rad) {
    const Eigen::Isometry3d T = result.truth[static_cast<std::size_t>(a)].inverse() *
                                result.truth[static_cast<std::size_t>(b)];
    edges.push_back({a, b, disturbed(T, m, rad, random), information(m, rad), -1});
  };
  for (int i = 0; i + 1 < n; ++i) add(result.graph.odometry, i, i + 1, kSigmaStep, kSigmaTurn);
  for (int i = per_lap; i < n; i += every)
    add(result.graph.loops, i - per_lap, i, kSigmaLoop, kSigmaLoopTurn);
  result.graph.T_map_vehicle = {result.truth.front()};
  for (const RelativePose& edge : result.graph.odometry)
    result.graph.T_map_vehicle.push_back(result.graph.T_map_vehicle.back() * edge.T_from_to);
  return result;
}

double ate_rmse(const std::vector<Eigen::Isometry3d>& truth,
                const std::vector<Eigen::Isometry3d>& poses) {
  std::vector<Eigen::Vector3d> a;
  std::vector<Eigen::Vector3d> b;
  for (const auto& T : truth) a.emplace_back(T.translation());
  for (const auto& T : poses) b.emplace_back(T.translation());
  return trajectory_error(a, b, false).rmse_m;
}

// The same residual written independently, with automatic derivatives.
struct JudgeResidual {
  RelativePose edge;
  Matrix6d root;
  template <typename T>
  bool operator()(const T* q_a, const T* t_a, const T* q_b, const T* t_b, T* residual) const {
    using Quaternion = Eigen::Quaternion<T>;
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Quaternion qa(q_a[0], q_a[1], q_a[2], q_a[3]);
    const Quaternion qb(q_b[0], q_b[1], q_b[2], q_b[3]);
    const Quaternion qz = Quaternion(Eigen::Quaterniond(edge.T_from_to.linear()).cast<T>());
    const Vector ta(t_a[0], t_a[1], t_a[2]);
    const Vector tb(t_b[0], t_b[1], t_b[2]);
    const Vector tz = edge.T_from_to.translation().cast<T>();
    const Vector e_t = qz.conjugate() * (qa.conjugate() * (tb - ta) - tz);
    const Quaternion e_q = qz.conjugate() * qa.conjugate() * qb;
    const T q[4] = {e_q.w(), e_q.x(), e_q.y(), e_q.z()};
    Eigen::Matrix<T, 6, 1> e;
    e.template head<3>() = e_t;
    ceres::QuaternionToAngleAxis(q, e.data() + 3);
    Eigen::Map<Eigen::Matrix<T, 6, 1>> out(residual);
    out = root.cast<T>() * e;
    return true;
  }
};

double judge_chi2(const PoseGraph& graph, const std::vector<Eigen::Isometry3d>& start) {
  std::vector<std::array<double, 7>> x;
  for (const auto& T : start) {
    const Eigen::Quaterniond q(T.linear());
    x.push_back({q.w(), q.x(), q.y(), q.z(), T(0, 3), T(1, 3), T(2, 3)});
  }
  ceres::Problem problem;
  ceres::QuaternionManifold manifold;
  ceres::Problem::Options problem_options;
  problem_options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem judge(problem_options);
  for (const auto* edges : {&graph.odometry, &graph.loops})
    for (const RelativePose& edge : *edges) {
      const Matrix6d root = Eigen::LLT<Matrix6d>(edge.information).matrixL().transpose();
      double* a = x[static_cast<std::size_t>(edge.from)].data();
      double* b = x[static_cast<std::size_t>(edge.to)].data();
      judge.AddResidualBlock(new ceres::AutoDiffCostFunction<JudgeResidual, 6, 4, 3, 4, 3>(
                                 new JudgeResidual{edge, root}),
                             nullptr, a, a + 4, b, b + 4);
    }
  for (auto& pose : x) judge.SetManifold(pose.data(), &manifold);
  judge.SetParameterBlockConstant(x[0].data());
  judge.SetParameterBlockConstant(x[0].data() + 4);
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  options.max_num_iterations = 100;
  options.function_tolerance = 1e-10;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &judge, &summary);
  return 2.0 * summary.final_cost;
}

TEST(PoseGraph, MotionJacobiansAgreeWithFiniteDifferences) {
  Random random(1, "jacobian");
  for (int trial = 0; trial < 20; ++trial) {
    const Eigen::Isometry3d I = Eigen::Isometry3d::Identity();
    const Eigen::Isometry3d a = disturbed(I, 3.0, 0.8, random);
    const Eigen::Isometry3d b = disturbed(I, 3.0, 0.8, random);
    const Eigen::Isometry3d z = disturbed(a.inverse() * b, 0.5, 0.4, random);
    const MotionResidual m = motion_residual(a, b, z, 1.1);
    EXPECT_LT((m.r - motion_error(a, b, z, 1.1)).norm(), 1e-12);
    constexpr double h = 1e-6;  // central: error h^2 plus rounding 1e-16 / h
    for (int i = 0; i < 6; ++i) {
      const Vector6d d = h * Vector6d::Unit(i);
      const Vector6d from =
          (motion_error(a * se3_exp(d), b, z, 1.1) - motion_error(a * se3_exp(-d), b, z, 1.1)) /
          (2 * h);
      const Vector6d to =
          (motion_error(a, b * se3_exp(d), z, 1.1) - motion_error(a, b * se3_exp(-d), z, 1.1)) /
          (2 * h);
      EXPECT_LT((from - m.J_from.col(i)).norm(), 1e-7);
      EXPECT_LT((to - m.J_to.col(i)).norm(), 1e-7);
    }
    const Vector6d scale =
        (motion_error(a, b, z, 1.1 + h) - motion_error(a, b, z, 1.1 - h)) / (2 * h);
    EXPECT_LT((scale - m.J_scale).norm(), 1e-7);
  }
}

TEST(PoseGraph, ReachesTheOptimumOfResidualsWithAutomaticDerivatives) {
  ROADBOOK_REQUIRE_DATA(folder, "g2o_graphs");
  for (const char* name : {"parking-garage.g2o", "sphere2500.g2o", "intel.g2o"}) {
    SCOPED_TRACE(name);
    const PoseGraph graph = test::read_g2o(folder / name);
    PoseGraphOptions options;
    options.robust = false;
    const auto begin = std::chrono::steady_clock::now();
    const PoseGraphResult result = relax(graph, options);
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
    std::printf("%s: %zu poses, chi2 %.6f -> %.6f, %d iterations, %.2f s\n", name,
                graph.T_map_vehicle.size(), result.initial_chi2, result.final_chi2,
                result.iterations, seconds.count());
    EXPECT_TRUE(result.usable) << result.message;
    const double judged = judge_chi2(graph, graph.T_map_vehicle);
    EXPECT_NEAR(result.final_chi2, judged, 1e-4 * judged);
  }
}

TEST(PoseGraph, FalseLoopsDoNotBendTheMap) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    SCOPED_TRACE(::testing::Message() << "seed " << seed);
    const Laps clean = drive_laps(150, 3, seed);
    const double clean_ate = ate_rmse(clean.truth, relax(clean.graph).T_map_vehicle);
    Laps spoiled = clean;
    Random random(seed, "false loops");
    const std::size_t good = clean.graph.loops.size();
    for (std::size_t k = 0; k < good / 4; ++k) {  // 20 % of all loops
      const int a = static_cast<int>(random.below(200));
      const int b = 220 + static_cast<int>(random.below(200));
      if ((b - a) % 150 < 15 || (b - a) % 150 > 135) continue;
      spoiled.graph.loops.push_back({a, b,
                                     disturbed(Eigen::Isometry3d::Identity(), 0.5, 0.05, random),
                                     information(kSigmaLoop, kSigmaLoopTurn), -1});
    }
    const PoseGraphResult result = relax(spoiled.graph);
    EXPECT_TRUE(result.usable);
    EXPECT_LT(ate_rmse(spoiled.truth, result.T_map_vehicle), 1.2 * clean_ate);
    for (std::size_t k = 0; k < spoiled.graph.loops.size(); ++k)
      EXPECT_EQ(result.loop_accepted[k] != 0, k < good) << "loop " << k;
  }
}

TEST(PoseGraph, ManyFalseLoopsBetweenTwoPlacesCountAsOne) {
  Laps laps = drive_laps(150, 2, 3);
  const std::size_t good = laps.graph.loops.size();
  // Two bays look the same and cause thirty false loops. These loops agree with each other and with
  // nothing else.
  for (int k = 0; k < 30; ++k)
    laps.graph.loops.push_back({40 + k, 110 + k, laps.truth[40].inverse() * laps.truth[40],
                                information(kSigmaLoop, kSigmaLoopTurn), -1});
  const PoseGraphResult result = relax(laps.graph);
  for (std::size_t k = 0; k < laps.graph.loops.size(); ++k)
    EXPECT_EQ(result.loop_accepted[k] != 0, k < good) << "loop " << k;
}

TEST(PoseGraph, LoopsJoinTheComponentsOfADriveWithAGap) {
  Laps laps = drive_laps(150, 2, 4);
  laps.graph.odometry.erase(laps.graph.odometry.begin() + 149);
  const Eigen::Isometry3d elsewhere = pose_from_planar(500.0, -80.0, 2.0);
  for (std::size_t i = 150; i < 300; ++i)
    laps.graph.T_map_vehicle[i] = elsewhere * laps.graph.T_map_vehicle[i];
  const PoseGraphResult result = relax(laps.graph);
  EXPECT_TRUE(result.usable);
  EXPECT_EQ(result.components, 1);
  // Loops of 3 cm tie the passes to each other. Within a lap, the odometry drifts by some
  // decimetres.
  EXPECT_LT(ate_rmse(laps.truth, result.T_map_vehicle), 1.0);
  for (std::size_t i = 150; i < 300; i += 4) {
    const Eigen::Vector3d between =
        result.T_map_vehicle[i].translation() - result.T_map_vehicle[i - 150].translation();
    EXPECT_LT(between.norm(), 4.0 * kSigmaLoop * std::sqrt(3.0));
  }
  laps.graph.loops.clear();
  EXPECT_EQ(relax(laps.graph).components, 2);
}

TEST(PoseGraph, FindsTheScaleOfOdometryFromMetricLoops) {
  Laps laps = drive_laps(150, 2, 5);
  laps.graph.scales = {{1.0, 1.0, 0.05, false}};
  for (RelativePose& edge : laps.graph.odometry) {
    edge.scale = 0;
    edge.T_from_to.translation() /= 1.03;
  }
  // Metric measurements across the lap fix the size.
  for (int i = 0; i < 140; i += 10)
    laps.graph.loops.push_back({i, i + 75,
                                laps.truth[static_cast<std::size_t>(i)].inverse() *
                                    laps.truth[static_cast<std::size_t>(i + 75)],
                                information(kSigmaLoop, kSigmaLoopTurn), -1});
  PoseGraphOptions options;
  options.robust = false;
  const PoseGraphResult result = relax(laps.graph, options);
  // 14 distances of some 50 m, each good to 3 cm plus the bending of odometry between: 1e-3.
  EXPECT_NEAR(result.scales[0], 1.03, 1e-3);
}

TEST(PoseGraph, GivesTheSameBytesWhenSeveralThreadsRelaxAtOnce) {
  const Laps laps = drive_laps(150, 3, 6);
  const PoseGraphResult alone = relax(laps.graph);
  for (const std::size_t count : {1U, 2U, 4U}) {
    std::vector<PoseGraphResult> results(count);
    std::vector<std::thread> threads;
    for (PoseGraphResult& result : results)
      threads.emplace_back([&] { result = relax(laps.graph); });
    for (std::thread& thread : threads) thread.join();
    for (const PoseGraphResult& result : results)
      for (std::size_t i = 0; i < alone.T_map_vehicle.size(); ++i)
        ASSERT_EQ(alone.T_map_vehicle[i].matrix(), result.T_map_vehicle[i].matrix());
  }
}

TEST(PoseGraph, RelaxesTwoThousandPosesWithAThousandLoopsInASecond) {
  const Laps laps = drive_laps(1000, 2, 7, 1);
  const auto begin = std::chrono::steady_clock::now();
  const PoseGraphResult result = relax(laps.graph);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  std::printf("2000 poses, 1000 loops: %.3f s, %d iterations\n", seconds.count(),
              result.iterations);
  EXPECT_TRUE(result.usable);
}

TEST(PoseGraph, RefusesEdgesToPosesThatDoNotExist) {
  Laps laps = drive_laps(20, 2, 8);
  laps.graph.loops[0].to = 4000;
  EXPECT_THROW((void)relax(laps.graph), BadInput);
}

}  // namespace
}  // namespace roadbook
