#pragma once

#include <string>
#include <vector>

#include "diagnosis/inference/cause_problem.hpp"

namespace roadbook {

/// A range to a beacon of known place, read at a reference pose.
struct BeaconRange {
  double t_s = 0.0;
  int beacon = 0;
  double read_m = 0.0;
  double expected_m = 0.0;
  double x = 0.0, y = 0.0, heading = 0.0;
  double bearing = 0.0;  ///< of the beacon, from the vehicle's x axis to the left [rad]
};

struct BeaconReadings {
  std::vector<BeaconRange> samples;
  std::vector<std::string> notes;
};
/// Fewer than 50 are none, with a note.
[[nodiscard]] BeaconReadings beacon_readings(std::vector<BeaconRange> samples);

/// Ranges to beacons: range0.bias, range0.scale, and as a grammar the dependence of the error on
/// range, time, bearing, heading and beacon. Poses and beacons are taken as known. Errors of one
/// beacon's readings go on from one to the next (multipath): they are whitened as such, and
/// readings far off weigh little.
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
    std::vector<double> weight;  ///< of each reading, 1 / standard deviation
  };
  [[nodiscard]] Eigen::MatrixXd columns(const Candidate& candidate) const;
  [[nodiscard]] Innovations whitened(const Eigen::MatrixXd& sides) const;
  void estimate_noise();

  BeaconReadings readings_;
  LibraryOptions library_;
  std::vector<int> beacons_;         ///< that occur, ascending
  std::vector<std::size_t> before_;  ///< the reading of the same beacon before; own: none near
  Noise noise_;
};

}  // namespace roadbook
