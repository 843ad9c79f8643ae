#pragma once

#include <string>
#include <utility>
#include <vector>

#include "diagnosis/brightness/brightness_causes.hpp"
#include "diagnosis/brightness/brightness_samples.hpp"
#include "diagnosis/inference/cause_problem.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

/// Brightness of landmarks: how bright each is, and how the mean of a patch changes with distance
/// (which takes in more of the surroundings), is what is unknown beside the causes
/// `camN.vignetting` and `camN.exposure`. Exposure is against the other cameras: that of all alike
/// is never seen.
class BrightnessProblem final : public CauseProblem {
 public:
  BrightnessProblem(std::vector<BrightnessSample> samples,
                    std::vector<std::string> cameras,
                    EffectSizes known = {},
                    LibraryOptions library = {});

  /// Whether there are samples enough to say anything.
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
  /// A known step is taken to lie where the drive shows one best.
  void place_known_steps(const EffectSizes& known);
  [[nodiscard]] Candidate candidate(std::size_t cause) const;
  [[nodiscard]] Sizes sizes_of(const CauseModel& model) const;
  [[nodiscard]] bool acts_on(const BrightnessCause& cause, const BrightnessSample& sample) const;
  /// Residual and columns of causes (by number), landmarks and distance projected out.
  [[nodiscard]] Eigen::MatrixXd sides(const Sizes& sizes,
                                      const std::vector<std::size_t>& causes) const;
  [[nodiscard]] Eigen::MatrixXd whitened(Eigen::MatrixXd sides) const;
  void take_out_outliers();
  std::vector<BrightnessSample> samples_;
  std::vector<std::string> cameras_;
  Sizes known_;
  LibraryOptions library_;
  std::vector<BrightnessCause> causes_;
  double sigma_ = 1.0;  ///< of a sample's log grey level
};

}  // namespace roadbook
