#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace roadbook {

/// One bin of a covariate: means of the innovations, in standard deviations.
struct EvidenceBin {
  double x = 0.0;
  double before = 0.0;
  double after = 0.0;
  double sigma = 0.0;  ///< of both means, if the model is right
  std::size_t rows = 0;
};

/// For the eye: residuals of the fit in the channel that a cause moves most, against the covariate
/// that the effect declares, with the nominal and with the extended model. The test itself uses the
/// columns, not these bins.
struct EvidencePlot {
  std::string channel;    ///< "imu0 yaw_rate"
  std::string covariate;  ///< "time [s]"
  std::vector<EvidenceBin> bins;
  /// One standard deviation of the bins, in `unit`; without a unit the bins have none.
  double deviation = 1.0;
  std::string unit;
  /// Of a term of the grammar: the covariate, ascending, and the smooth function found, in
  /// `curve_unit`; empty where the covariate is no single number.
  std::vector<std::pair<double, double>> curve;
  std::string curve_unit;
};

/// Covariate and residual of one row.
using EvidenceValue = std::pair<double, double>;

/// Bins of equally many rows: each mean is as certain as the others.
[[nodiscard]] std::vector<EvidenceBin> evidence_bins(std::vector<EvidenceValue> before,
                                                     std::vector<EvidenceValue> after);

}  // namespace roadbook
