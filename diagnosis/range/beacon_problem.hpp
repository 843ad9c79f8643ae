#pragma once

#include <string>
#include <vector>

#include "diagnosis/inference/cause_problem.hpp"

namespace roadbook {

/// A range to a beacon at a known position, measured at a reference pose.
struct BeaconRange {
  double t_s = 0.0;
  int beacon = 0;
  double read_m = 0.0;
  double expected_m = 0.0;
  double x = 0.0, y = 0.0, heading = 0.0;
  double bearing = 0.0;  ///< of the beacon from the vehicle's x axis, positive to the left [rad]
};

struct BeaconReadings {
  std::vector<BeaconRange> samples;
  std::vector<std::string> notes;
};
/// Collects the samples; fewer than 50 give an empty result with a note.
[[nodiscard]] BeaconReadings beacon_readings(std::vector<BeaconRange> samples);

/// Ranges to beacons as a problem for the search of effects range0.bias and range0.scale, and of
/// generic effects of range, time, bearing, heading and beacon. Poses and beacons are taken as
/// known. Errors of a beacon's readings are autocorrelated (multipath) and are whitened
/// accordingly; outliers have little weight.
class BeaconProblem final : public CauseProblem {
 public:
  explicit BeaconProblem(BeaconReadings readings, LibraryOptions library = {});

  [[nodiscard]] std::vector<ChannelName> channels() const override;
  [[nodiscard]] std::size_t rows() const override { return readings_.samples.size(); }
  [[nodiscard]] CauseModel nominal() const override;
  [[nodiscard]] std::vector<Candidate> candidates(const CauseModel& model) const override;
  [[nodiscard]] Projection project(const CauseModel& model,
                                   std::vector<Candidate> candidates) const override;
  void fit(CauseModel& model, int iterations) const override;
  void fit_beside(CauseModel& model, int iterations, const SizePrior& others) const override;
  /// range0.outliers and range0.correlation.
  [[nodiscard]] std::vector<NoiseCause> noise_causes(const CauseModel& model) const override;
  [[nodiscard]] RowCovariate covariate(const CauseModel& model,
                                       const Candidate& cause,
                                       const Innovations& innovations) const override;

 private:
  struct Noise {
    double sigma_m = 1.0;
    double correlation = 0.0;
    double pairs = 0.0;
    double outliers = 0.0, outliers_sigma = 0.0, outliers_z = 0.0;
    std::vector<double> weight;  ///< 1 / standard deviation of each reading
  };
  [[nodiscard]] Eigen::MatrixXd columns(const Candidate& candidate) const;
  [[nodiscard]] Innovations whitened(const Eigen::MatrixXd& sides) const;
  void estimate_noise();

  BeaconReadings readings_;
  LibraryOptions library_;
  std::vector<int> beacons_;  ///< beacons that occur, ascending
  std::vector<std::size_t>
      before_;  ///< index of the previous reading of the same beacon; its own index: none is near
  Noise noise_;
};

}  // namespace roadbook
