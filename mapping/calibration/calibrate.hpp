#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "mapping/calibration/calibration_columns.hpp"
#include "mapping/calibration/calibration_data.hpp"

namespace roadbook {

// Calibration by bundle adjustment: the errors of cameras and wheels are estimated together with
// poses and landmarks.
//
// Intervals are cluster-robust. With poses and points projected out of the derivatives J~ of the
// columns, C = H^-1 (sum over clusters of g g^T) H^-1, where H = J~^T J~ and g is the sum of J~^T r
// in a cluster (calibration_problem.cpp). Delays are relative to one sensor, since a delay of all
// sensors changes nothing: the one whose delay is the median of all.

struct CalibrationOptions {
  int max_iterations = 30;        ///< of one solve
  int rounds = 2;                 ///< of solves; the twists of the poses are renewed in between
  double ground_sigma_m = 0.02;   ///< height of a ground point in the frame of the nearest pose
  double loss_width = 2.0;        ///< of pixels, in their robust standard deviations
  std::vector<std::string> held;  ///< names of columns that stay as they start

  /// Throws InvalidOption.
  void check() const;
};

/// Estimate of one column.
struct CalibratedColumn {
  CalibrationColumn column;
  double value = 0.0;
  double sigma = 0.0;       ///< standard error
  double half_width = 0.0;  ///< of the 95 % interval
  bool held = false;        ///< stayed as it started
  bool observable = false;  ///< the interval is narrow enough (`widest_interval`)
  bool reference = false;   ///< the sensor whose delay is zero by definition
};

struct EstimatedCalibration {
  bool usable = false;  ///< a solution was found
  std::vector<CalibratedColumn> columns;
  Eigen::MatrixXd covariance;  ///< of the values; zero for held columns
  std::size_t views = 0;
  std::size_t motions = 0;
  double reprojection_before_px = 0.0;  ///< median length, full-size image, as calibrated before
  double reprojection_after_px = 0.0;

  [[nodiscard]] const CalibratedColumn* find(const std::string& name) const;
};

/// Estimates the columns of `calibration_columns`, from `start` (zeros: as stated), and improves
/// poses and points of `data`. Priors limit the columns that the drive does not show
/// (`prior_sigma`). Deterministic. Throws InvalidOption for an unknown name in `held`; Interrupted.
[[nodiscard]] EstimatedCalibration calibrate(CalibrationData& data,
                                             const Eigen::VectorXd& start,
                                             const CalibrationOptions& options = {},
                                             const Progress& progress = {});

/// The same to first order: one step from `start`, without a change of poses and points. This is
/// the evidence of an adjusted map about its calibration. Throws InvalidOption.
[[nodiscard]] EstimatedCalibration first_step(const CalibrationData& data,
                                              const Eigen::VectorXd& start,
                                              const CalibrationOptions& options = {});

/// The calibration as effects for a model file. Columns of size 0 are left out, and columns that
/// are not observable unless a calibration needs them (`is_needed`).
[[nodiscard]] EffectSizes to_effects(const EstimatedCalibration& calibration);

/// Values of the columns for effects that are known already; others than the columns are ignored.
[[nodiscard]] Eigen::VectorXd column_values(const std::vector<CalibrationColumn>& columns,
                                            const EffectSizes& effects);

}  // namespace roadbook
