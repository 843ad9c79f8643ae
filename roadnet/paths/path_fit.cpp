#include "roadnet/paths/path_fit.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.hpp"
#include "roadnet/paths/path_spline.hpp"

namespace roadbook {
namespace {

using Matrix = Eigen::MatrixXd;
using Row = Eigen::RowVectorXd;

[[noreturn]] void bad_fit(const std::string& field,
                          const std::string& got,
                          const std::string& want) {
  throw BadInput(Problem{Severity::kError, "", 0, field, got, want});
}

// Place of a parameter: its segment and u in [0, 1] there.
struct Spot {
  int segment = 0;
  double u = 0.0;
};

Spot spot_of(double t, double t_end, int segments) {
  const double at = t / t_end * segments;
  const int segment = std::clamp(static_cast<int>(std::floor(at)), 0, segments - 1);
  return {segment, at - segment};
}

// Normal equations N x = r, summed segment by segment.
struct Normal {
  const PathSpline& spline;
  int degree;
  std::vector<Matrix> blocks;  // of the coefficients that matter on a segment
  Matrix rhs;

  Normal(const PathSpline& s, int n, int segments)
      : spline(s),
        degree(n),
        blocks(static_cast<std::size_t>(segments), Matrix::Zero(n + 1, n + 1)),
        rhs(Matrix::Zero(s.unknowns(), 3)) {}

  [[nodiscard]] Row row(const Spot& spot) const {
    double values[kMaxPathDegree + 1];
    bernstein(degree, spot.u, values);
    return Eigen::Map<const Row>(values, degree + 1) * spline.extraction(spot.segment);
  }
  void add_point(const Spot& spot, const Eigen::Vector3d& p, double weight) {
    const Row a = row(spot);
    blocks[static_cast<std::size_t>(spot.segment)].noalias() += weight * a.transpose() * a;
    for (int k = 0; k <= degree; ++k)
      rhs.row(spline.unknown(spot.segment, k)) += weight * a[k] * p.transpose();
  }
};

// Integral over a segment of the square of the third derivative with respect to u, in the control
// points: differences of third order are the control points of a curve of degree n - 3, whose
// products integrate to known ratios of binomials.
Matrix roughness(int n) {
  Matrix differences = Matrix::Identity(n + 1, n + 1);
  for (int r = 0; r < 3; ++r) {
    const auto rows = differences.rows() - 1;
    differences = (n - r) * (differences.bottomRows(rows) - differences.topRows(rows)).eval();
  }
  const auto binomial = [](int a, int b) {
    double value = 1.0;
    for (int k = 1; k <= b; ++k) value *= static_cast<double>(a - b + k) / k;
    return value;
  };
  const int m = n - 3;
  Matrix gram(m + 1, m + 1);
  for (int i = 0; i <= m; ++i)
    for (int j = 0; j <= m; ++j)
      gram(i, j) = binomial(m, i) * binomial(m, j) /
                   (binomial(2 * m, i + j) * static_cast<double>(2 * m + 1));
  return differences.transpose() * gram * differences;
}

void add_smoothness(Normal& normal, double t_end, double points, double wavelength_m) {
  const double segments = static_cast<double>(normal.blocks.size());
  const double h = t_end / segments;
  // A wave of this length costs as much by its roughness as by missing the points.
  const double weight =
      points / t_end * std::pow(wavelength_m / (2.0 * std::numbers::pi), 6) / std::pow(h, 5);
  const Matrix R = roughness(normal.degree);
  for (std::size_t i = 0; i < normal.blocks.size(); ++i) {
    const Matrix& C = normal.spline.extraction(static_cast<int>(i));
    normal.blocks[i].noalias() += weight * C.transpose() * R * C;
  }
}

// The coefficients. `pinned`: first and last are the points' ends and leave the equations.
Matrix solve(const Normal& normal, const std::vector<Eigen::Vector3d>& points, bool pinned) {
  const int n = normal.spline.unknowns();
  Matrix rhs = normal.rhs;
  Matrix x = Matrix::Zero(n, 3);
  if (pinned) {
    x.row(0) = points.front().transpose();
    x.row(n - 1) = points.back().transpose();
  }
  const auto fixed = [&](int i) { return pinned && (i == 0 || i == n - 1); };
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t s = 0; s < normal.blocks.size(); ++s) {
    for (int a = 0; a <= normal.degree; ++a) {
      const int i = normal.spline.unknown(static_cast<int>(s), a);
      for (int b = 0; b <= normal.degree; ++b) {
        const int j = normal.spline.unknown(static_cast<int>(s), b);
        if (fixed(i)) continue;
        if (fixed(j))
          rhs.row(i) -= normal.blocks[s](a, b) * x.row(j);
        else
          entries.emplace_back(i, j, normal.blocks[s](a, b));
      }
    }
  }
  if (pinned) {
    for (const int i : {0, n - 1}) {
      entries.emplace_back(i, i, 1.0);
      rhs.row(i) = x.row(i);
    }
  }
  Eigen::SparseMatrix<double> N(n, n);
  N.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> cholesky(N);
  const auto pivots = cholesky.vectorD();
  // The B-splines are well conditioned where there are points: a pivot this small has no point.
  if (cholesky.info() != Eigen::Success || !(pivots.minCoeff() > 1e-12 * pivots.maxCoeff()))
    bad_fit("path points", std::to_string(points.size()) + " points",
            "more of them, evenly spread, or fewer than " + std::to_string(normal.blocks.size()) +
                " segments");
  return cholesky.solve(rhs);
}

PathFit fit_of(const Matrix& x, const Normal& normal, double t_end, bool closed) {
  PathFit fit;
  fit.path.degree = normal.degree;
  fit.path.closed = closed;
  const auto segments = static_cast<int>(normal.blocks.size());
  for (int i = 0; i <= segments; ++i) fit.path.knots.push_back(t_end * i / segments);
  for (int i = 0; i < segments; ++i) {
    Matrix local(normal.degree + 1, 3);
    for (int k = 0; k <= normal.degree; ++k) local.row(k) = x.row(normal.spline.unknown(i, k));
    const Matrix control = normal.spline.extraction(i) * local;
    for (int k = 0; k <= normal.degree; ++k) fit.path.points.push_back(control.row(k).transpose());
  }
  return fit;
}

void check_points(const std::vector<Eigen::Vector3d>& points, bool closed) {
  const std::size_t wanted = closed ? 3 : 2;
  if (points.size() < wanted)
    bad_fit("path points", std::to_string(points.size()), std::to_string(wanted) + " or more");
  for (std::size_t i = 0; i < points.size(); ++i)
    if (!points[i].allFinite())
      bad_fit("path point " + std::to_string(i), "a value that is not finite", "metres");
}

}  // namespace

void PathFitOptions::check() const {
  const auto whole = [](const char* field, int got, int low, int high) {
    if (got < low || got > high)
      throw InvalidOption(field, std::to_string(got),
                          std::to_string(low) + " to " + std::to_string(high));
  };
  whole("segments", segments, closed ? 3 : 1, 1'000'000);
  whole("degree", degree, kMinPathDegree, kMaxPathDegree);
  if (closed && pin_ends) throw InvalidOption("pin_ends", "true", "false: a ring has no ends");
  if (!(std::isfinite(smooth_below_m) && smooth_below_m >= 0.0))
    throw InvalidOption("smooth_below_m", std::to_string(smooth_below_m), "0 or more");
}

PathFit fit_path(const std::vector<Eigen::Vector3d>& points,
                 const std::vector<double>& t,
                 double t_end,
                 const PathFitOptions& options,
                 const std::vector<double>& weights) {
  options.check();
  check_points(points, options.closed);
  ROADBOOK_ASSERT(points.size() == t.size() && (weights.empty() || weights.size() == t.size()));
  if (!(std::isfinite(t_end) && t_end > 0.0))
    bad_fit("path parameter range", std::to_string(t_end), "more than 0");
  const PathSpline spline(options.degree, options.segments, options.closed);
  Normal normal(spline, options.degree, options.segments);
  double weight_sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (!(t[i] >= 0.0 && t[i] <= t_end))
      bad_fit("parameter of path point " + std::to_string(i), std::to_string(t[i]),
              "0 to " + std::to_string(t_end));
    const double weight = weights.empty() ? 1.0 : weights[i];
    normal.add_point(spot_of(t[i], t_end, options.segments), points[i], weight);
    weight_sum += weight;
  }
  if (options.smooth_below_m > 0.0)
    add_smoothness(normal, t_end, weight_sum, options.smooth_below_m);
  const Matrix x = solve(normal, points, options.pin_ends);
  PathFit fit = fit_of(x, normal, t_end, options.closed);
  double sum2 = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Spot spot = spot_of(t[i], t_end, options.segments);
    const Row a = normal.row(spot);
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    for (int k = 0; k <= options.degree; ++k)
      p += a[k] * x.row(spline.unknown(spot.segment, k)).transpose();
    const double distance = (p - points[i]).norm();
    sum2 += (weights.empty() ? 1.0 : weights[i]) * distance * distance;
    if (distance > fit.max_deviation_m) {
      fit.max_deviation_m = distance;
      fit.worst_point = i;
    }
  }
  fit.rms_m = std::sqrt(sum2 / weight_sum);
  return fit;
}

PathFit fit_path(const std::vector<Eigen::Vector3d>& points, const PathFitOptions& options) {
  options.check();
  check_points(points, options.closed);
  std::vector<Eigen::Vector3d> kept = points;
  if (options.closed && kept.size() > 3 && kept.front() == kept.back()) kept.pop_back();
  std::vector<double> t{0.0};
  const std::size_t chords = kept.size() - (options.closed ? 0 : 1);
  for (std::size_t i = 0; i < chords; ++i) {
    const double chord = (kept[(i + 1) % kept.size()] - kept[i]).head<2>().norm();
    if (!(chord > 0.0))
      bad_fit("path points " + std::to_string(i) + " and " + std::to_string((i + 1) % kept.size()),
              "the same place twice", "neighbours apart");
    t.push_back(t.back() + chord);
  }
  const double t_end = t.back();
  t.resize(kept.size());
  return fit_path(kept, t, t_end, options);
}

}  // namespace roadbook
