#pragma once

#include <string>
#include <utility>
#include <vector>

#include "diagnosis/brightness/brightness_causes.hpp"
#include "diagnosis/brightness/brightness_samples.hpp"
#include "diagnosis/inference/cause_problem.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

/// Brightness of landmarks as a problem for the search of effects `camN.vignetting` and
/// `camN.exposure`. Nuisance parameters: the brightness of each landmark, and the change of a
/// patch's mean with distance, because a farther patch covers more of the surroundings. Exposure is
/// relative to the other cameras; a common exposure of all is not observable.
class BrightnessProblem final : public CauseProblem {
 public:
  BrightnessProblem(std::vector<BrightnessSample> samples,
                    std::vector<std::string> cameras,
                    EffectSizes known = {},
                    LibraryOptions library = {});

  /// True if there are enough samples.
  [[nodiscard]] bool usable() const;

  [[nodiscard]] std::vector<ChannelName> channels() const override;
  [[nodiscard]] std::size_t rows() const override { return samples_.size(); }
  [[nodiscard]] CauseModel nominal() const override;
  [[nodiscard]] std::vector<Candidate> candidates(const CauseModel& model) const override;
  [[nodiscard]] Projection project(const CauseModel& model,
                                   std::vector<Candidate> candidates) const override;
  void fit(CauseModel& model, int iterations) const override;
  [[nodiscard]] std::string note(const Accepted& cause) const override;
  [[nodiscard]] RowCovariate covariate(const CauseModel& model,
                                       const Candidate& cause,
                                       const Innovations& innovations) const override;

 private:
  /// Sizes by cause.
  using Sizes = std::vector<std::pair<std::size_t, double>>;
  /// Places a known step at the time that fits the drive best.
  void place_known_steps(const EffectSizes& known);
  [[nodiscard]] Candidate candidate(std::size_t cause) const;
  [[nodiscard]] Sizes sizes_of(const CauseModel& model) const;
  [[nodiscard]] bool acts_on(const BrightnessCause& cause, const BrightnessSample& sample) const;
  /// Residual and columns of candidates (by index), with landmarks and distance projected out.
  [[nodiscard]] Eigen::MatrixXd sides(const Sizes& sizes,
                                      const std::vector<std::size_t>& causes) const;
  [[nodiscard]] Eigen::MatrixXd whitened(Eigen::MatrixXd sides) const;
  void take_out_outliers();
  std::vector<BrightnessSample> samples_;
  std::vector<std::string> cameras_;
  Sizes known_;
  LibraryOptions library_;
  std::vector<BrightnessCause> causes_;
  double sigma_ = 1.0;  ///< standard deviation of a sample's log grey level
};

}  // namespace roadbook
