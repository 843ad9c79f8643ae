#include "mapping/pipeline/parking_row_prior.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/require_option.hpp"

namespace roadbook {
namespace {

// Loose enough to say nothing (floors slope, labels lie on their vehicle's plane), tight enough for
// the equations to have one solution: [m], [rad].
constexpr double kLooseM = 100.0;
constexpr double kLooseRad = 1.0;
constexpr double kHeightM = 0.05;  // of a space over its vehicle's plane
constexpr double kTiltRad = 0.05;

// Rows bend what corners hold stiffly along its whole length: many small steps, each of little
// cost. A solution that ends before them is worse than none (docs/guide/labelling.md).
constexpr double kRowsTolerance = 1e-7;
constexpr int kRowsIterations = 100;

// Information of planar standard deviations and those of height, and of roll and pitch.
Matrix6d information_of(double xy_m, double z_m, double tilt_rad, double heading_rad) {
  Vector6d sigma;
  sigma << xy_m, xy_m, z_m, tilt_rad, tilt_rad, heading_rad;
  return sigma.cwiseAbs2().cwiseInverse().asDiagonal();
}

void check_row(const EqualRow& row, std::size_t number, std::size_t poses) {
  const std::string field = "rows[" + std::to_string(number) + "]";
  const auto fail = [&](const std::string& got, const std::string& want) {
    throw BadInput(Problem{Severity::kError, "", 0, field, got, want});
  };
  if (row.spaces.size() < 3) fail(std::to_string(row.spaces.size()) + " spaces", "3 or more");
  for (std::size_t i = 0; i < row.spaces.size(); ++i) {
    if (row.spaces[i].views.empty()) fail("a space that no pose has", "a view of each");
    if (i > 0 && row.spaces[i].steps <= row.spaces[i - 1].steps)
      fail("spaces out of order", "ascending steps");
    for (const SpaceView& view : row.spaces[i].views)
      if (view.pose < 0 || at(view.pose) >= poses)
        fail("pose " + std::to_string(view.pose), "a pose of the problem");
  }
}

/// The line through the start places of a row's spaces.
struct RowLine {
  Eigen::Isometry3d T_map_row = Eigen::Isometry3d::Identity();  ///< x along it, z up
  double step_m = 0.0;
};

// Least squares over steps.
RowLine line_through(const EqualRow& row, const std::vector<Eigen::Vector3d>& places) {
  const auto n = static_cast<double>(places.size());
  double mean = 0.0;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < places.size(); ++i) {
    mean += row.spaces[i].steps / n;
    middle += places[i] / n;
  }
  double spread = 0.0;
  Eigen::Vector3d slope = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double from_mean = row.spaces[i].steps - mean;
    spread += from_mean * from_mean;
    slope += from_mean * (places[i] - middle);
  }
  slope /= spread;
  RowLine line;
  line.step_m = slope.norm();
  line.T_map_row.linear() =
      Eigen::AngleAxisd(std::atan2(slope.y(), slope.x()), Eigen::Vector3d::UnitZ())
          .toRotationMatrix();
  line.T_map_row.translation() = middle - mean * slope;
  return line;
}

void add_row_prior(const EqualRow& row, const EqualRowOptions& options, BundleProblem& problem) {
  const int first = static_cast<int>(problem.poses.size());
  std::vector<Eigen::Vector3d> places;
  for (const RowSpace& space : row.spaces) {
    const SpaceView& main = space.views.front();
    const int node = static_cast<int>(problem.poses.size());
    const Eigen::Isometry3d T = problem.poses[at(main.pose)].T_map_vehicle * main.T_vehicle_space;
    places.emplace_back(T.translation());
    problem.poses.push_back({T, false});
    for (const SpaceView& view : space.views)
      problem.motions.push_back({view.pose, node, view.T_vehicle_space,
                                 information_of(view.sigma_m, kHeightM, kTiltRad,
                                                view.sigma_rad > 0.0 ? view.sigma_rad : kLooseRad),
                                 -1});
  }
  const RowLine line = line_through(row, places);
  const int line_node = static_cast<int>(problem.poses.size());
  const int heading_node = line_node + 1;
  problem.poses.push_back({line.T_map_row, false});
  problem.poses.push_back(problem.poses[at(first)]);
  const int scale = static_cast<int>(problem.scales.size());
  problem.scales.push_back({1.0, 1.0, options.step_sigma, false});
  const Matrix6d on_line = information_of(options.paint_sigma_m, kLooseM, kLooseRad, kLooseRad);
  const Matrix6d one_way = information_of(kLooseM, kLooseM, kLooseRad, options.paint_sigma_rad);
  for (std::size_t i = 0; i < row.spaces.size(); ++i) {
    const int node = first + static_cast<int>(i);
    // Free parameters start without a residual, so that they do not pull.
    Eigen::Isometry3d T_row_space =
        line.T_map_row.inverse() * problem.poses[at(node)].T_map_vehicle;
    T_row_space.translation() = Eigen::Vector3d(row.spaces[i].steps * line.step_m, 0.0, 0.0);
    problem.motions.push_back({line_node, node, T_row_space, on_line, scale});
    Eigen::Isometry3d T_heading_space = Eigen::Isometry3d::Identity();
    T_heading_space.translation() =
        problem.poses[at(heading_node)].T_map_vehicle.inverse() * places[i];
    problem.motions.push_back({heading_node, node, T_heading_space, one_way, -1});
  }
}

std::size_t view_count(const EqualRow& row) {
  std::size_t views = 0;
  for (const RowSpace& space : row.spaces) views += space.views.size();
  return views;
}

// Squared normalised residual of a row's motions, `next` on: as many as it has views and twice its
// spaces.
double row_chi2(const BundleProblem& problem, std::size_t next, const EqualRow& row) {
  double chi2 = 0.0;
  for (const std::size_t end = next + view_count(row) + 2 * row.spaces.size(); next < end; ++next) {
    const MotionConstraint& m = problem.motions[next];
    const double scale = m.scale < 0 ? 1.0 : problem.scales[at(m.scale)].value;
    const Vector6d r = motion_error(problem.poses[at(m.from)].T_map_vehicle,
                                    problem.poses[at(m.to)].T_map_vehicle, m.T_from_to, scale);
    chi2 += r.dot(m.information * r);
  }
  return chi2;
}

// Exceeded with probability 0.01 (Wilson and Hilferty 1931).
double largest_chi2(double freedom) {
  constexpr double kNormal = 2.326;
  const double part = 2.0 / (9.0 * freedom);
  return freedom * std::pow(1.0 - part + kNormal * std::sqrt(part), 3);
}

bool fits(const BundleProblem& problem, std::size_t first_motion, const EqualRow& row) {
  double values = 0.0;
  for (const RowSpace& space : row.spaces)
    for (const SpaceView& view : space.views) values += view.sigma_rad > 0.0 ? 3.0 : 2.0;
  constexpr double kParameters = 5.0;  // a place, a direction, a step; one heading
  return row_chi2(problem, first_motion, row) <= largest_chi2(std::max(1.0, values - kParameters));
}

}  // namespace

void EqualRowOptions::check() const {
  require_option(paint_sigma_m > 0.0, "paint_sigma_m", paint_sigma_m, "above 0");
  require_option(paint_sigma_rad > 0.0, "paint_sigma_rad", paint_sigma_rad, "above 0");
  require_option(step_sigma > 0.0, "step_sigma", step_sigma, "above 0");
}

void add_equal_rows(BundleProblem& problem,
                    const std::vector<EqualRow>& rows,
                    const EqualRowOptions& options) {
  options.check();
  const std::size_t poses = problem.poses.size();
  for (std::size_t i = 0; i < rows.size(); ++i) check_row(rows[i], i, poses);
  for (const EqualRow& row : rows) add_row_prior(row, options, problem);
}

BundleResult bundle_adjust_with_rows(BundleProblem& problem,
                                     const std::vector<EqualRow>& rows,
                                     const BundleOptions& options,
                                     const EqualRowOptions& row_options,
                                     EqualRowsUsed& used,
                                     const Progress& progress) {
  used = {};
  const BundleResult plain = bundle_adjust(problem, options, progress);
  if (rows.empty() || !plain.usable) return plain;
  const BundleProblem start = problem;
  BundleOptions to_the_end = options;
  to_the_end.relative_tolerance = std::min(options.relative_tolerance, kRowsTolerance);
  to_the_end.max_iterations = std::max(options.max_iterations, kRowsIterations);
  for (std::vector<EqualRow> taken = rows; !taken.empty();) {
    add_equal_rows(problem, taken, row_options);
    BundleResult result = bundle_adjust(problem, to_the_end, progress);
    if (!result.usable) break;
    std::vector<EqualRow> good;
    std::size_t motion = start.motions.size();
    used = {0, 0, rows.size() - taken.size()};
    for (const EqualRow& row : taken) {
      if (fits(problem, motion, row)) {
        good.push_back(row);
        used.spaces += row.spaces.size();
      }
      motion += view_count(row) + 2 * row.spaces.size();
    }
    used.rows = good.size();
    if (good.size() == taken.size()) return result;
    taken = good;
    problem = start;
  }
  problem = start;
  used = {0, 0, rows.size()};
  return plain;
}

}  // namespace roadbook
