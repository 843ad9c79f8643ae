#pragma once

#include <memory>
#include <string>
#include <vector>

#include "diagnosis/inference/cause_problem.hpp"
#include "diagnosis/views/view_fit.hpp"

namespace roadbook {

/// The views of a map as a problem for the search of effects. Nuisance parameters are poses and
/// landmarks.
///
/// The innovations are compressed: each 0.8 s of driving gives a triangular factor of the products
/// of all sides. Scores, block statistics and held-out gains from the factors equal those from the
/// rows.
class ViewProblem final : public CauseProblem {
 public:
  /// Fits the nominal model. `known`: sizes of effects that the model already contains.
  /// `num_threads`: 0 for all cores; results do not depend on it.
  explicit ViewProblem(ViewData data,
                       EffectSizes known = {},
                       LibraryOptions library = {},
                       int num_threads = 1);

  /// False if the views cannot be fitted; `message` says why. An unusable problem must not be
  /// searched.
  [[nodiscard]] bool usable() const { return fit_.usable; }
  [[nodiscard]] const std::string& message() const { return fit_.message; }
  [[nodiscard]] const ViewFit& fitted() const { return fit_; }
  /// Vehicle poses at the keyframes (map frame) after a refit with these effects.
  [[nodiscard]] std::vector<TimedPose> poses_with(const EffectSizes& effects) const;

  [[nodiscard]] std::vector<ChannelName> channels() const override;
  [[nodiscard]] std::size_t rows() const override;
  [[nodiscard]] CauseModel nominal() const override;
  [[nodiscard]] std::vector<Candidate> candidates(const CauseModel& model) const override;
  [[nodiscard]] Projection project(const CauseModel& model,
                                   std::vector<Candidate> candidates) const override;
  void fit(CauseModel& model, int iterations) const override;
  void fit_beside(CauseModel& model, int iterations, const SizePrior& others) const override;
  [[nodiscard]] std::vector<NoiseCause> noise_causes(const CauseModel& model) const override;
  [[nodiscard]] std::string note(const Accepted& cause) const override;
  /// Variations of wheel effects only; empty for others.
  [[nodiscard]] std::vector<Candidate> variations(const CauseModel& model,
                                                  const Candidate& name) const override;
  [[nodiscard]] EvidencePlot evidence(const CauseModel& nominal,
                                      const CauseModel& extended,
                                      const Candidate& cause) const override;

 private:
  [[nodiscard]] ViewPoint point_of(const CauseModel& model) const;
  void take_sizes(const CauseModel& model, ViewPoint& point) const;
  [[nodiscard]] CauseModel fitted_nominal() const;
  /// Weights of the elementary columns (rows) for each column of a candidate.
  [[nodiscard]] Eigen::MatrixXd sums_of(const Candidate& candidate) const;
  [[nodiscard]] Eigen::MatrixXd accepted_sums(const CauseModel& model) const;
  /// Applies a step to sizes and lines of the model and to the point. Returns false if a line step
  /// was shortened.
  bool take_step(const ViewStep& step, CauseModel& model, ViewPoint& point) const;
  /// The system, linearised at a model.
  [[nodiscard]] ViewSystem& at(const CauseModel& model) const;
  [[nodiscard]] Projection one_row_a_landmark(const CauseModel& model) const;

  ViewBasis basis_;
  ViewFit fit_;
  EffectSizes known_;
  LibraryOptions library_;
  std::vector<ViewCause> causes_;
  CauseModel nominal_;
  std::unique_ptr<ViewSystem> system_;  ///< buffers, reused by every linearisation
  /// The model state at which the system was last linearised with all columns; null if it was moved
  /// since. A state belongs to one set of accepted effects.
  mutable std::shared_ptr<const CauseState> stands_at_;
  mutable Eigen::VectorXd stands_sizes_;
};

}  // namespace roadbook
