#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "base/random.hpp"
#include "diagnosis/views/view_problem.hpp"
#include "diagnosis/views/view_saturation.hpp"
#include "mapping/store/map_file.hpp"
#include "tests/diagnosis/hidden_views/view_injector.hpp"
#include "tests/mapping/store/small_map.hpp"

namespace roadbook::test {
namespace {

Eigen::MatrixXd all_rows(const ViewSystem& system, const ViewSides& sides, bool raw = false) {
  Eigen::MatrixXd rows(static_cast<Eigen::Index>(system.row_count()), sides.count);
  Eigen::Index at = 0;
  ViewPanel values;
  for (std::size_t k = 0; k < system.poses(); ++k) {
    system.rows(k, sides, values, raw);
    rows.middleRows(at, values.rows()) = values;
    at += values.rows();
  }
  return rows;
}

struct Case {
  Folder folder;
  ViewBasis basis;
  ViewFit fit;

  Case() {
    HiddenViewOptions hidden;
    hidden.length_m = 12.0;
    hidden.outliers = 0.0;
    hidden.secret = {{"cam1.focal", 0.004}};
    write_hidden_views(hidden, folder / "views");
    ViewData data =
        view_data(load_map(folder / "views/map.gpkg"), 0, Drive::open(folder / "views/drive"));
    basis.cameras = data.bundle.cameras.size();
    fit = fit_views(std::move(data), basis, {}, false);
  }
};

// Moving poses and landmarks must not change the projected residuals.
TEST(ViewSystem, ProjectedResidualsDoNotDependOnWherePosesAndLandmarksStand) {
  const Case c;
  ASSERT_TRUE(c.fit.usable) << c.fit.message;
  const Eigen::MatrixXd none(static_cast<Eigen::Index>(c.basis.size()), 0);
  ViewSystem system(c.fit.data, c.basis);
  ASSERT_TRUE(system.linearise(c.fit.point, c.fit.noise));
  const Eigen::MatrixXd before = all_rows(system, system.sides(none));
  ViewPoint shaken = c.fit.point;
  Random random(1);
  for (std::size_t k = 1; k < shaken.state.poses.size(); ++k) {
    Vector6d xi;
    for (double& x : xi) x = 2e-5 * random.normal();
    shaken.state.poses[k] = shaken.state.poses[k] * se3_exp(xi);
  }
  for (Eigen::Vector3d& p : shaken.state.points)
    p += 1e-4 * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
  ASSERT_TRUE(system.linearise(shaken, c.fit.noise));
  const Eigen::MatrixXd after = all_rows(system, system.sides(none));
  EXPECT_GT(before.cwiseAbs().maxCoeff(), 1.0);
  EXPECT_LT((after - before).cwiseAbs().maxCoeff(), 0.02);
}

// Landmarks start at the minimum for wrong cameras. With fixed poses and the right cameras they
// must move to the minimum of a general solver.
TEST(ViewSystem, LandmarksSettleWhereLeastSquaresHasThem) {
  const Case c;
  ViewPoint point = c.fit.point;
  const Eigen::MatrixXd none(static_cast<Eigen::Index>(c.basis.size()), 0);
  ViewSystem system(c.fit.data, c.basis);
  point.effects = {{"cam1.focal", 0.004}, {"ground.height", 0.02}};
  ASSERT_TRUE(system.linearise(point, c.fit.noise));
  BundleProblem problem = c.fit.data.bundle;
  ViewPrediction(c.fit.data, c.basis).apply(point, problem, 1);
  for (std::size_t k = 0; k < problem.poses.size(); ++k)
    problem.poses[k] = {point.state.poses[k], true};
  for (std::size_t p = 0; p < problem.points.size(); ++p)
    problem.points[p].p_map = point.state.points[p];
  for (BundleObservation& o : problem.observations)
    o.sigma_px *= c.fit.noise.pixel[static_cast<std::size_t>(o.camera)];
  BundleOptions options;
  options.ground_sigma_m = c.fit.noise.ground_m;
  options.outlier_rounds = 0;
  options.loss = RobustLoss::kNone;
  options.relative_tolerance = 1e-12;
  ASSERT_TRUE(bundle_adjust(problem, options).usable);
  const double before = system.squares();
  system.settle_points(point);
  for (std::size_t p = 0; p < problem.points.size(); ++p) {
    if (!problem.points[p].ground) continue;
    EXPECT_NEAR(point.state.points[p].z(), problem.points[p].p_map.z(), 1e-4);
  }
  ASSERT_TRUE(system.linearise(point, c.fit.noise));
  const double after = system.squares();
  ViewPoint reference = point;
  for (std::size_t p = 0; p < problem.points.size(); ++p)
    reference.state.points[p] = problem.points[p].p_map;
  ASSERT_TRUE(system.linearise(reference, c.fit.noise));
  EXPECT_LT(after, before);
  EXPECT_NEAR(after, system.squares(), 1e-3 * (before - after));
}

// Ten poses in a row, 0.2 m apart, and landmarks 6 to 40 m ahead that two of them see.
ViewData little_parallax(double noise_px) {
  ViewData data;
  MountedCamera& mounted = data.bundle.cameras.emplace_back();
  mounted.camera.width = 1280;
  mounted.camera.height = 800;
  mounted.camera.model = CameraModel::kPinholeRadtan;
  mounted.camera.parameters = {500, 500, 640, 400, 0, 0, 0, 0};
  mounted.T_vehicle_camera.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  for (int k = 0; k < 10; ++k) {
    BundlePose& pose = data.bundle.poses.emplace_back();
    pose.T_map_vehicle.translation().x() = 0.2 * k;
    pose.fixed = k == 0;
    data.moments.emplace_back().t_s = 0.1 * k;
    if (k == 0) continue;
    MotionConstraint& motion = data.bundle.motions.emplace_back();
    motion.from = k - 1;
    motion.to = k;
    motion.T_from_to.translation().x() = 0.2;
    motion.information *= 1e6;
  }
  Random random(3);
  for (int i = 0; i < 400; ++i) {
    const double far = random.uniform(6.0, 40.0);
    BundlePoint& point = data.bundle.points.emplace_back();
    point.p_map = {far, random.uniform(-0.06, 0.06) * far, random.uniform(-0.06, 0.06) * far};
    const int first = static_cast<int>(random.uniform(0.0, 8.9));
    for (int k = first; k < first + 2; ++k) {
      const auto& T = data.bundle.poses[static_cast<std::size_t>(k)].T_map_vehicle;
      const Eigen::Vector3d p = mounted.T_vehicle_camera.inverse() * (T.inverse() * point.p_map);
      BundleObservation& seen = data.bundle.observations.emplace_back();
      seen.pose = k;
      seen.point = i;
      seen.pixel =
          *mounted.camera.project(p) + noise_px * Eigen::Vector2d(random.normal(), random.normal());
    }
    data.landmark.push_back(i);
  }
  data.keyframe.resize(data.bundle.poses.size());
  data.has_wheels = true;
  return data;
}

// A landmark must not gain by moving behind the camera, where its views would cost nothing.
TEST(ViewSystem, LandmarksWithLittleParallaxStayInSight) {
  for (const double noise_px : {0.2, 0.4, 1.0}) {
    const ViewData data = little_parallax(noise_px);
    ViewBasis basis;
    basis.cameras = 1;
    ViewNoise noise;
    noise.pixel = {noise_px};
    ViewPoint point{state_of(data.bundle),
                    {},
                    Eigen::VectorXd::Zero(static_cast<Eigen::Index>(basis.size())),
                    {}};
    ViewSystem system(data, basis);
    ASSERT_TRUE(system.linearise(point, noise));
    const double before = system.squares();
    system.settle_points(point);
    ASSERT_TRUE(system.linearise(point, noise));
    EXPECT_LT(system.squares(), before);
    for (const BundleObservation& seen : data.bundle.observations) {
      const auto& T = point.state.poses[static_cast<std::size_t>(seen.pose)];
      EXPECT_GT((T.inverse() * point.state.points[static_cast<std::size_t>(seen.point)]).x(), 0.0);
    }
  }
}

TEST(ViewSystem, ProjectingTwiceIsProjectingOnce) {
  const Case c;
  ViewSystem system(c.fit.data, c.basis);
  ASSERT_TRUE(system.linearise(c.fit.point, c.fit.noise));
  const ViewSides sides = system.all_sides();
  const Eigen::MatrixXd projected = all_rows(system, sides);
  const Eigen::MatrixXd raw = all_rows(system, sides, true);
  // P is a projection: s^T P t = (P s)^T (P t).
  const Eigen::MatrixXd once = raw.transpose() * projected;
  const Eigen::MatrixXd twice = projected.transpose() * projected;
  const Eigen::VectorXd scale = raw.colwise().norm().cwiseMax(1e-12);
  const Eigen::MatrixXd off =
      scale.cwiseInverse().asDiagonal() * (once - twice) * scale.cwiseInverse().asDiagonal();
  EXPECT_LT(off.cwiseAbs().maxCoeff(), 1e-6);
}

// Of n rows, a fit of p free values leaves n - p. The effects are free within their priors, so they
// take between none and all of their number. Random signs give each trace with a variance of at
// most twice the sum of r (1 - r) over rows of redundancy r (Hutchinson), over the number of draws.
TEST(ViewSystem, RedundanciesSumToTheRowsLessTheFreeValues) {
  const Case c;
  ViewSystem system(c.fit.data, c.basis);
  ViewPoint point = c.fit.point;
  ASSERT_TRUE(system.linearise(point, c.fit.noise));
  const std::vector<ViewCause> causes = view_causes(c.fit.data, c.basis);
  const Saturated left = saturate(system, causes, c.basis, c.fit.data, {}, point);
  const double sum = std::accumulate(left.redundancy.begin(), left.redundancy.end(), 0.0);
  double free = 3.0 * static_cast<double>(point.state.points.size());
  for (const BundlePose& pose : c.fit.data.bundle.poses) free += pose.fixed ? 0.0 : 6.0;
  const auto rows = static_cast<double>(system.row_count());
  const double share = free / rows;
  const double sigma = std::sqrt(2.0 * rows * share * (1.0 - share) / 4.0);
  EXPECT_LT(sum, rows - free + 4.0 * sigma);
  EXPECT_GT(sum, rows - free - static_cast<double>(causes.size()) - 4.0 * sigma);
  EXPECT_LT(4.0 * sigma, 0.1 * (rows - free)) << "the test tells little";
}

// The columns of the search equal changes of the prediction.
TEST(ViewSystem, ColumnsAreTheChangesOfPredictions) {
  const Case c;
  ViewSystem system(c.fit.data, c.basis);
  ViewPoint other = c.fit.point;
  ASSERT_TRUE(system.linearise(c.fit.point, c.fit.noise));
  const ViewSides sides = system.all_sides();
  const Eigen::MatrixXd rows = all_rows(system, sides);
  const Eigen::MatrixXd raw = all_rows(system, sides, true);
  for (const ViewCause& cause : view_causes(c.fit.data, c.basis)) {
    SCOPED_TRACE(cause.name);
    const double step = 1e-3 * cause.tau;
    other.effects = {{cause.name, step}};
    ASSERT_TRUE(system.linearise(other, c.fit.noise));
    const Eigen::VectorXd moved =
        all_rows(system,
                 system.sides(Eigen::MatrixXd(static_cast<Eigen::Index>(c.basis.size()), 0)))
            .col(0);
    Eigen::VectorXd column = Eigen::VectorXd::Zero(rows.rows());
    Eigen::VectorXd whole = column;
    for (const std::size_t k : cause.columns) {
      column += rows.col(1 + static_cast<Eigen::Index>(k));
      whole += raw.col(1 + static_cast<Eigen::Index>(k));
    }
    const Eigen::VectorXd seen = (rows.col(0) - moved) / step;
    // Poses absorb nearly all of some columns. The remainder changes with the point itself.
    EXPECT_LT((seen - column).norm(), 0.02 * column.norm() + 2e-3 * whole.norm());
  }
}

// The same for the line of a hinge that the drive crosses.
TEST(ViewSystem, ColumnsOfALineAreTheChangesOfPredictionsAsItMoves) {
  const Case c;
  ViewBasis basis = c.basis;
  basis.hinges = 1;
  ViewPoint point = c.fit.point;
  const auto middle_of_way = point.state.poses[point.state.poses.size() / 2];
  const Eigen::Vector2d normal = middle_of_way.linear().topLeftCorner<2, 1>().normalized();
  const Eigen::Vector2d pivot = middle_of_way.translation().head<2>() + 0.03 * normal;
  point.hinges = {{normal, normal.dot(pivot), pivot}};
  point.linear = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(basis.size()));
  const double size = 0.02;
  point.linear[static_cast<Eigen::Index>(basis.hinge())] = size;
  ViewSystem system(c.fit.data, basis);
  ASSERT_TRUE(system.linearise(point, c.fit.noise));
  const Eigen::MatrixXd raw = all_rows(system, system.all_sides(), true);
  for (const Eigen::Vector2d& step : {Eigen::Vector2d(0.004, 0.0), {0.0, 0.05}}) {
    const auto left = [&](double sign) -> Eigen::VectorXd {
      ViewPoint other = point;
      other.hinges[0] = point.hinges[0].moved(sign * step[0], sign * step[1]);
      EXPECT_TRUE(system.linearise(other, c.fit.noise));
      const Eigen::MatrixXd none(static_cast<Eigen::Index>(basis.size()), 0);
      return all_rows(system, system.sides(none), true).col(0);
    };
    const Eigen::VectorXd seen = (left(-1.0) - left(1.0)) / (2.0 * step.norm());
    const auto column = static_cast<Eigen::Index>(1 + basis.hinge() + (step[0] != 0.0 ? 1U : 2U));
    ASSERT_GT(seen.norm(), 0.0);
    EXPECT_LT((seen - size * raw.col(column)).norm(), 0.05 * seen.norm());
  }
}

TEST(ViewSystem, TheNominalFitEndsAtTheSameBytesTwice) {
  const Case a;
  const Case b;
  ASSERT_EQ(a.fit.point.state.points.size(), b.fit.point.state.points.size());
  for (std::size_t p = 0; p < a.fit.point.state.points.size(); ++p)
    EXPECT_EQ(a.fit.point.state.points[p], b.fit.point.state.points[p]);
}

}  // namespace
}  // namespace roadbook::test
