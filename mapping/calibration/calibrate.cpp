#include "mapping/calibration/calibrate.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "base/error.hpp"
#include "base/index.hpp"
#include "base/median.hpp"
#include "base/require_option.hpp"
#include "base/text.hpp"
#include "mapping/calibration/calibration_interval.hpp"

namespace roadbook {
namespace {

using Held = std::vector<std::uint8_t>;

// Lengths of the pixels' residuals [px] with the columns at `values`.
std::vector<double> pixel_errors(const CalibrationData& data, const Eigen::VectorXd& values) {
  std::vector<double> errors;
  errors.reserve(data.views.size());
  for (const BundleObservation& view : data.views) {
    const CalibrationPose& pose = data.poses[at(view.pose)];
    const PixelCost cost(data.rig.cameras[at(view.camera)], pose.twist, view);
    const PoseBlock block = block_of(pose.T_map_vehicle);
    const std::array<const double*, 3> parameters{
        block.data(), data.points[at(view.point)].data(),
        values.data() + index(at(view.camera) * kColumnsOfCamera)};
    Eigen::Vector2d r;
    cost.Evaluate(parameters.data(), r.data(), nullptr);
    errors.push_back(view.sigma_px * r.norm());
  }
  return errors;
}

double median_error(const CalibrationData& data, const Eigen::VectorXd& values) {
  return data.views.empty() ? 0.0 : median(pixel_errors(data, values));
}

// Loss width of pixels in their stated standard deviations, from their median error.
double loss_width(const CalibrationData& data, double median_px, const CalibrationOptions& o) {
  constexpr double kMedianOfRayleigh = 1.17741;  // over its parameter
  if (data.views.empty()) return o.loss_width;
  return std::max(0.1, o.loss_width * median_px / kMedianOfRayleigh / data.views.front().sigma_px);
}

Held held_columns(const std::vector<CalibrationColumn>& columns,
                  const std::vector<std::string>& names) {
  Held held(columns.size(), 0);
  std::vector<std::string> known;
  for (const CalibrationColumn& column : columns) known.push_back(column.name);
  for (const std::string& name : names) {
    const auto found = std::find(known.begin(), known.end(), name);
    if (found == known.end()) {
      const auto near = nearest_name(name, known);
      throw InvalidOption("--hold", "'" + name + "'",
                          near ? "a column; did you mean " + *near + "?" : "a column");
    }
    held[static_cast<std::size_t>(found - known.begin())] = 1;
  }
  return held;
}

// The delay that counts as zero, the median of all. Empty where a held delay is given.
std::optional<std::size_t> reference_delay(const std::vector<CalibrationColumn>& columns,
                                           const Eigen::VectorXd& values,
                                           const Held& held) {
  std::vector<std::size_t> delays;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (!columns[i].is_delay()) continue;
    if (held[i] != 0) return std::nullopt;
    delays.push_back(i);
  }
  if (delays.empty()) return std::nullopt;
  std::stable_sort(delays.begin(), delays.end(), [&](std::size_t a, std::size_t b) {
    return values[index(a)] < values[index(b)];
  });
  return delays[(delays.size() - 1) / 2];
}

// Values, standard errors and intervals, with the delays relative to the reference.
void fill_columns(const std::vector<CalibrationColumn>& columns,
                  const Eigen::VectorXd& values,
                  const Held& held,
                  const ColumnEstimate& estimate,
                  EstimatedCalibration& calibration) {
  const auto count = index(columns.size());
  const auto reference = reference_delay(columns, values, held);
  Eigen::MatrixXd to_relative = Eigen::MatrixXd::Identity(count, count);
  for (std::size_t i = 0; i < columns.size(); ++i)
    if (reference && columns[i].is_delay()) to_relative(index(i), index(*reference)) -= 1.0;
  const Eigen::VectorXd relative = to_relative * values;
  calibration.covariance = to_relative * estimate.covariance * to_relative.transpose();
  calibration.columns.clear();
  for (std::size_t i = 0; i < columns.size(); ++i) {
    CalibratedColumn c;
    c.column = columns[i];
    c.value = relative[index(i)];
    c.sigma = std::sqrt(std::max(0.0, calibration.covariance(index(i), index(i))));
    c.half_width = half_width_95(estimate, to_relative.row(index(i)).transpose());
    c.held = held[i] != 0;
    c.reference = reference && i == *reference;
    c.observable = c.held || c.half_width <= widest_interval(columns[i].kind);
    calibration.columns.push_back(c);
  }
}

Eigen::VectorXd priors_of(const std::vector<CalibrationColumn>& columns) {
  Eigen::VectorXd priors(index(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) priors[index(i)] = prior_sigma(columns[i].kind);
  return priors;
}

// What is known before columns are estimated.
EstimatedCalibration without_estimate(const CalibrationData& data, const Eigen::VectorXd& start) {
  EstimatedCalibration calibration;
  calibration.views = data.views.size();
  calibration.motions = data.motions.size();
  calibration.reprojection_before_px = median_error(data, start);
  calibration.reprojection_after_px = calibration.reprojection_before_px;
  return calibration;
}

}  // namespace

void CalibrationOptions::check() const {
  require_option(max_iterations >= 1, "max_iterations", max_iterations, "at least 1");
  require_option(rounds >= 1, "rounds", rounds, "at least 1");
  require_option(ground_sigma_m > 0.0, "ground_sigma_m", ground_sigma_m, "above 0");
  require_option(loss_width > 0.0, "loss_width", loss_width, "above 0");
}

const CalibratedColumn* EstimatedCalibration::find(const std::string& name) const {
  const auto found = std::find_if(columns.begin(), columns.end(),
                                  [&](const auto& c) { return c.column.name == name; });
  return found == columns.end() ? nullptr : &*found;
}

EstimatedCalibration calibrate(CalibrationData& data,
                               const Eigen::VectorXd& start,
                               const CalibrationOptions& options,
                               const Progress& progress) {
  options.check();
  const auto columns = calibration_columns(data.rig, data.has_wheels());
  const Held held = held_columns(columns, options.held);
  EstimatedCalibration calibration = without_estimate(data, start);
  Eigen::VectorXd values = start;
  double median_px = calibration.reprojection_before_px;
  for (int round = 0; round < options.rounds; ++round) {
    CalibrationProblem problem(data, values, held, loss_width(data, median_px, options),
                               options.ground_sigma_m);
    const auto on_iteration = [&](int i) {
      report(progress, "calibration", at(round * options.max_iterations + i),
             at(options.rounds * options.max_iterations));
    };
    if (!problem.solve(options.max_iterations, on_iteration)) return calibration;
    values = problem.values();
    problem.write_to(data);
    set_twists(data.poses);
    median_px = median_error(data, values);
    if (round + 1 < options.rounds) continue;
    const ColumnEstimate estimate = estimate_columns(problem.linear(), held, priors_of(columns));
    if (!estimate.usable) return calibration;
    // The solver stops where steps are small; the last step is exact.
    fill_columns(columns, values + estimate.step, held, estimate, calibration);
  }
  calibration.reprojection_after_px = median_px;
  calibration.usable = true;
  return calibration;
}

EstimatedCalibration first_step(const CalibrationData& data,
                                const Eigen::VectorXd& start,
                                const CalibrationOptions& options) {
  options.check();
  const auto columns = calibration_columns(data.rig, data.has_wheels());
  const Held held = held_columns(columns, options.held);
  EstimatedCalibration calibration = without_estimate(data, start);
  const double width = loss_width(data, calibration.reprojection_before_px, options);
  CalibrationProblem problem(data, start, held, width, options.ground_sigma_m);
  const ColumnEstimate estimate = estimate_columns(problem.linear(), held, priors_of(columns));
  if (!estimate.usable) return calibration;
  fill_columns(columns, start + estimate.step, held, estimate, calibration);
  calibration.usable = true;
  return calibration;
}

EffectSizes to_effects(const EstimatedCalibration& calibration) {
  EffectSizes effects;
  for (const CalibratedColumn& c : calibration.columns)
    if (c.value != 0.0 && (c.observable || is_needed(c.column.kind)))
      effects[c.column.name] = c.value;
  const auto size = [&](const std::string& name) {
    const auto found = effects.find(name);
    return found == effects.end() ? 0.0 : found->second;
  };
  // The columns are a rotation vector; the effects are turns one after the other.
  for (const CalibratedColumn& c : calibration.columns) {
    if (c.column.kind != CalibrationKind::kPitch) continue;
    const std::string camera = c.column.name.substr(0, c.column.name.find('.'));
    const CameraTurn turn =
        turn_of({size(camera + ".pitch"), size(camera + ".rotation"), size(camera + ".roll")});
    for (const auto& [name, value] :
         {std::pair(camera + ".pitch", turn.pitch), std::pair(camera + ".rotation", turn.yaw),
          std::pair(camera + ".roll", turn.roll)})
      if (value != 0.0) effects[name] = value;
  }
  return effects;
}

Eigen::VectorXd column_values(const std::vector<CalibrationColumn>& columns,
                              const EffectSizes& effects) {
  Eigen::VectorXd values = Eigen::VectorXd::Zero(index(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    const auto dot = columns[i].name.find('.');
    values[index(i)] =
        effect_size(effects, columns[i].name.substr(0, dot), columns[i].name.substr(dot + 1));
  }
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].kind != CalibrationKind::kPitch) continue;
    const auto first = index(i);
    values.segment<3>(first) =
        rotation_vector_of({values[first], values[first + 1], values[first + 2]});
  }
  return values;
}

}  // namespace roadbook
