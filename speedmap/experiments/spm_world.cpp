#include "speedmap/experiments/spm_world.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/random.hpp"
#include "roadnet/paths/path_fit.hpp"
#include "roadnet/paths/path_sign.hpp"

namespace roadbook {
namespace {

constexpr double kFullCircle = 2.0 * std::numbers::pi;
constexpr int kGravel = 0;
constexpr int kAsphalt = 1;
constexpr int kWet = 2;

// White noise smeared by exp(-x^2 / length^2) is a Gaussian process with squared-exponential
// covariance of that length; scaled to a variance of 1.
std::vector<double> smear_kernel(double length, double spacing) {
  const int reach = static_cast<int>(std::ceil(3.0 * length / spacing));
  std::vector<double> kernel;
  double square = 0.0;
  for (int i = -reach; i <= reach; ++i) {
    const double x = i * spacing / length;
    kernel.push_back(std::exp(-x * x));
    square += kernel.back() * kernel.back();
  }
  for (double& k : kernel) k /= std::sqrt(square);
  return kernel;
}

// rows x columns of a Gaussian process, row by row.
std::vector<double> gaussian_process(int rows,
                                     int columns,
                                     const std::vector<double>& along,
                                     const std::vector<double>& across,
                                     Random& random) {
  const int wide = columns + static_cast<int>(across.size()) - 1;
  const int tall = rows + static_cast<int>(along.size()) - 1;
  const auto at = [](int row, int column, int width) {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(column);
  };
  std::vector<double> smeared(at(tall, 0, columns), 0.0);
  std::vector<double> noise(static_cast<std::size_t>(wide));
  for (int row = 0; row < tall; ++row) {
    for (double& x : noise) x = random.normal();
    for (int j = 0; j < columns; ++j)
      for (std::size_t k = 0; k < across.size(); ++k)
        smeared[at(row, j, columns)] += across[k] * noise[static_cast<std::size_t>(j) + k];
  }
  std::vector<double> result(at(rows, 0, columns), 0.0);
  for (int i = 0; i < rows; ++i)
    for (std::size_t k = 0; k < along.size(); ++k)
      for (int j = 0; j < columns; ++j)
        result[at(i, j, columns)] += along[k] * smeared[at(i + static_cast<int>(k), j, columns)];
  return result;
}

std::vector<int> draw_classes(const SpmExperimentOptions& options,
                              const Knots& knots,
                              std::uint64_t index) {
  const auto first_row = knots.places().front().s_m;
  const auto columns = static_cast<int>(
      std::count_if(knots.places().begin(), knots.places().end(),
                    [&](const PathPlace& place) { return place.s_m == first_row; }));
  const int rows = static_cast<int>(knots.size()) / columns;
  Random border_noise(options.seed, "spm.border", index);
  const auto border_kernel = smear_kernel(options.gravel_wander_length_m, options.spacing_m);
  const auto border = gaussian_process(rows, 2, border_kernel, {1.0}, border_noise);
  Random wet_noise(options.seed, "spm.wet", index);
  const auto wet =
      gaussian_process(rows, columns, smear_kernel(options.wet_length_s_m, options.spacing_m),
                       smear_kernel(options.wet_length_e_m, options.spacing_m), wet_noise);
  std::vector<int> classes;
  for (std::size_t l = 0; l < knots.size(); ++l) {
    const double e = knots.places()[l].e_m;
    const std::size_t row = l / static_cast<std::size_t>(columns);
    const double edge =
        options.gravel_from_m + options.gravel_wander_m * border[2 * row + (e > 0.0 ? 1 : 0)];
    classes.push_back(std::abs(e) > edge ? kGravel : wet[l] > options.wet_level ? kWet : kAsphalt);
  }
  return classes;
}

int drawn_class(std::span<const double> shares, Random& random) {
  double rest = random.uniform();
  for (std::size_t i = 0; i + 1 < shares.size(); ++i)
    if ((rest -= shares[i]) < 0.0) return static_cast<int>(i);
  return static_cast<int>(shares.size()) - 1;
}

// Position and direction of the vehicle, which follows its weave and looks where it goes.
Eigen::Isometry2d vehicle_pose(const SpmExperimentOptions& options,
                               const PathFrame& road,
                               double s_m) {
  const PathPoint at = road.curve().at(s_m);
  const double e = spm_weave(options, s_m);
  const double step = 1e-3;
  const double slope =
      (spm_weave(options, s_m + step) - spm_weave(options, s_m - step)) / (2.0 * step);
  Eigen::Isometry2d T = Eigen::Isometry2d::Identity();
  T.linear() = Eigen::Rotation2Dd(at.heading() + std::atan2(slope, 1.0 - at.curvature * e))
                   .toRotationMatrix();
  T.translation() = at.position + e * at.left();
  return T;
}

}  // namespace

Knots spm_knots(const SpmExperimentOptions& options, double spacing_m, double kernel_width_m) {
  KnotGridOptions grid;
  grid.length_m = options.length_m;
  grid.e_min_m = -options.half_width_m;
  grid.e_max_m = options.half_width_m;
  grid.spacing_s_m = spacing_m;
  grid.spacing_e_m = spacing_m;
  grid.width = {kernel_width_m, kernel_width_m};
  return Knots::grid(grid);
}

PathFrame spm_road(const SpmExperimentOptions& options) {
  // The heading integrated in steps so fine that the trapezoidal rule is exact to 1e-9 m.
  constexpr double kStep = 0.01;
  constexpr int kEvery = 200;
  const auto heading = [&](double s) {
    double sum = 0.0;
    for (std::size_t i = 0; i < options.heading_amplitude_rad.size(); ++i)
      sum += options.heading_amplitude_rad[i] *
             std::sin(kFullCircle * s / options.heading_wavelength_m[i]);
    return sum;
  };
  std::vector<Eigen::Vector3d> points = {Eigen::Vector3d::Zero()};
  Eigen::Vector3d p = Eigen::Vector3d::Zero();
  const int steps = static_cast<int>(std::round(options.length_m / kStep));
  for (int i = 0; i < steps; ++i) {
    const double h = heading((i + 0.5) * kStep);
    p += kStep * Eigen::Vector3d(std::cos(h), std::sin(h), 0.0);
    if ((i + 1) % kEvery == 0 || i + 1 == steps) points.push_back(p);
  }
  PathFitOptions fit;
  fit.segments = options.segments;
  fit.degree = options.degree;
  const double reach = options.half_width_m + options.kernel_width_m;
  return {PathCurve(fit_path(points, fit).path), Tube{-reach, reach}};
}

SpmTruth spm_truth(const SpmExperimentOptions& options, std::uint64_t index) {
  Random random(options.seed, "spm.friction", index);
  PropertyMapPrior prior;
  prior.classes = {"gravel", "asphalt", "wet"};
  prior.counts.assign(3, 1.0);
  PropertyPrior friction;
  for (std::size_t i = 0; i < 3; ++i) {
    const double spread = random.uniform(-options.friction_spread, options.friction_spread);
    const double variance = options.friction_sigma[i] * options.friction_sigma[i];
    friction.classes.push_back({options.friction[i] * (1.0 + spread), options.true_lambda,
                                options.true_alpha, variance * (options.true_alpha - 1.0)});
  }
  prior.properties.push_back(friction);
  PropertyMapOptions plain;
  plain.semantics = SemanticModel::kGeometricPool;
  plain.prior_mean_sigma = 0.0;
  SpmTruth truth{
      PropertyMap(spm_knots(options, options.spacing_m, options.kernel_width_m), prior, plain), {}};
  truth.knot_class = draw_classes(options, truth.map.knots(), index);
  for (std::size_t l = 0; l < truth.knot_class.size(); ++l) {
    std::array<double, 3> a = {1.0, 1.0, 1.0};
    a[static_cast<std::size_t>(truth.knot_class[l])] += options.true_purity;
    truth.map.set_belief(l, a, 0.0);
  }
  return truth;
}

PropertyMapPrior spm_prior(const SpmExperimentOptions& options,
                           const SpmTruth& truth,
                           std::uint64_t index) {
  Random random(options.seed, "spm.prior", index);
  PropertyMapPrior prior = truth.map.prior();
  prior.counts = options.prior_counts;
  for (NormalGamma& ng : prior.properties[0].classes) {
    for (double* const parameter : {&ng.mu, &ng.lambda, &ng.alpha, &ng.beta})
      *parameter *= 1.0 + random.uniform(-options.prior_error, options.prior_error);
  }
  return prior;
}

double spm_weave(const SpmExperimentOptions& options, double s_m) {
  double e = 0.0;
  for (std::size_t i = 0; i < options.weave_amplitude_m.size(); ++i)
    e += options.weave_amplitude_m[i] *
         std::sin(kFullCircle * s_m / options.weave_wavelength_m[i] + options.weave_phase_rad[i]);
  return from_paper_sign(e);
}

SpmRecord spm_record(const SpmExperimentOptions& options,
                     const PathFrame& road,
                     const SpmTruth& truth,
                     std::uint64_t index,
                     double until_m) {
  Random labels(options.seed, "spm.labels", index);
  Random values(options.seed, "spm.values", index);
  const std::vector<Eigen::Vector2d> pixels = spm_pixels(options);
  const double length = road.curve().length_m();
  SpmRecord record;
  std::array<double, 3> shares{};
  PathCursor cursor;
  const double frame_step = options.speed_mps / options.semantics_hz;
  for (int i = 0; i * frame_step <= std::min(until_m, length); ++i) {
    SpmFrame frame{i * frame_step, {}, {}};
    const Eigen::Isometry2d T_map_vehicle = vehicle_pose(options, road, frame.distance_m);
    for (const Eigen::Vector2d& pixel : pixels) {
      const PathProjection at = road.project(T_map_vehicle * pixel, cursor);
      if (!at.inside() || std::abs(at.e_m) > options.half_width_m) continue;
      const PathPlace place{at.s_m, at.e_m};
      if (!truth.map.class_shares(place, shares)) continue;
      frame.places.push_back(place);
      frame.labels.push_back(drawn_class(shares, labels));
    }
    record.frames.push_back(std::move(frame));
  }
  const double value_step = options.speed_mps / options.friction_hz;
  for (int i = 0; i * value_step <= std::min(until_m, length); ++i) {
    const double s = i * value_step;
    const PathPlace place{s, spm_weave(options, s)};
    if (!truth.map.class_shares(place, shares)) continue;
    const auto c = static_cast<std::size_t>(drawn_class(shares, values));
    const NormalGamma& ng = truth.map.property(0)[c];
    record.values.push_back({s, place, values.normal(ng.mu, std::sqrt(ng.predictive_variance()))});
  }
  return record;
}

}  // namespace roadbook
