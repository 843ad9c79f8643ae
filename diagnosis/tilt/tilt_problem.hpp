#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "diagnosis/inference/cause_problem.hpp"
#include "diagnosis/tilt/tilt_windows.hpp"

namespace roadbook {

// Tilt of an IMU against its stated mounting, from all of its axes, as a problem for the search.
//
// In a turn, the x and y axes of a tilted gyro read a part of the turn, and its accelerometer reads
// a part of gravity. Both are first order in the tilt. The z axis alone reads the cosine of the
// tilt, which has no sign and looks like a scale. Turn rate and readings come from the same sensor,
// so no delay and no scale of the gyro enters.
//
// Unknowns that are projected out: biases of both axes of gyro and accelerometer, roll of the body
// by lateral acceleration, pitch of the body by acceleration, and one bank of all bends if the
// reference does not know it. The attitude of the road is that of the reference, or level. Errors
// of this model last: they are noise of an autoregressive process, fitted with the tilt free.
class TiltProblem final : public CauseProblem {
 public:
  /// `windows` as of `tilt_windows`. `bank_is_known`: by the reference.
  TiltProblem(std::vector<TiltWindow> windows,
              TiltAxes axes,
              bool bank_is_known,
              LibraryOptions library = {});

  /// Whether there are enough windows and axes for a search.
  [[nodiscard]] bool usable() const;
  /// Mean roll and pitch [rad] that gravity shows; no value without an accelerometer. A bias of the
  /// accelerometer looks the same.
  [[nodiscard]] std::optional<Eigen::Vector2d> tilt_by_gravity() const;
  [[nodiscard]] std::vector<ChannelName> channels() const override;
  [[nodiscard]] std::size_t rows() const override;
  [[nodiscard]] CauseModel nominal() const override;
  [[nodiscard]] std::vector<Candidate> candidates(const CauseModel& model) const override;
  [[nodiscard]] Projection project(const CauseModel& model,
                                   std::vector<Candidate> candidates) const override;
  void fit(CauseModel& model, int iterations) const override;
  void fit_beside(CauseModel& model, int iterations, const SizePrior& others) const override;
  [[nodiscard]] bool intervals_of_blocks() const override { return true; }
  [[nodiscard]] RowCovariate covariate(const CauseModel& model,
                                       const Candidate& cause,
                                       const Innovations& innovations) const override;

 private:
  static constexpr std::size_t kChannels = 4;
  static constexpr std::size_t kUnknowns = 3;  ///< of each channel
  // Residuals of all channels and their change by roll and pitch, at a tilt.
  struct Rows {
    std::array<Eigen::MatrixXd, kChannels> sides;     ///< residual, roll, pitch: one row a window
    std::array<Eigen::MatrixXd, kChannels> unknowns;  ///< bias, attitude by acceleration, bank
  };
  struct Noise {
    std::vector<double> weight;  ///< 1 / standard deviation of each window
    Eigen::VectorXd memory;      ///< coefficients of the windows before, the last one first
    double fresh = 1.0;          ///< standard deviation of the error of this prediction
  };
  [[nodiscard]] Rows rows_at(double roll, double pitch) const;
  [[nodiscard]] Innovations whitened(const Rows& rows) const;
  void estimate_noise();

  std::vector<TiltWindow> windows_;
  bool bank_is_known_ = false;
  LibraryOptions library_;
  std::vector<std::size_t> used_;  ///< channels that are measured
  std::array<Noise, kChannels> noise_;
};

}  // namespace roadbook
