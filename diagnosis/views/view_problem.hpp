#pragma once

#include <memory>
#include <string>
#include <vector>

#include "diagnosis/inference/cause_problem.hpp"
#include "diagnosis/views/view_fit.hpp"

namespace roadbook {

/// The views of a map: poses and landmarks are what is unknown beside the causes.
///
/// Its innovations are compressed: of each 0.8 s of driving a triangular factor of the products of
/// all sides, from which scores, blocks and held-out gains come out as from the rows themselves.
class ViewProblem final : public CauseProblem {
 public:
  /// Fits the nominal model. `known`: sizes of effects that are part of the model already.
  /// `num_threads`: 0: all cores; answers are the same for any number.
  explicit ViewProblem(ViewData data,
                       EffectSizes known = {},
                       LibraryOptions library = {},
                       int num_threads = 1);

  /// Whether the views hold together; `message` says why not. An unusable problem must not be
  /// searched.
  [[nodiscard]] bool usable() const { return fit_.usable; }
  [[nodiscard]] const std::string& message() const { return fit_.message; }
  [[nodiscard]] const ViewFit& fitted() const { return fit_; }
  /// Vehicle poses at the keyframes once these effects are taken out of everything.
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
  /// Of names that the wheels tell.
  [[nodiscard]] std::vector<Candidate> variations(const CauseModel& model,
                                                  const Candidate& name) const override;
  [[nodiscard]] EvidencePlot evidence(const CauseModel& nominal,
                                      const CauseModel& extended,
                                      const Candidate& cause) const override;

 private:
  [[nodiscard]] ViewPoint point_of(const CauseModel& model) const;
  void take_sizes(const CauseModel& model, ViewPoint& point) const;
  [[nodiscard]] CauseModel fitted_nominal() const;
  /// Elementary columns of each side of a candidate.
  [[nodiscard]] Eigen::MatrixXd sums_of(const Candidate& candidate) const;
  [[nodiscard]] Eigen::MatrixXd accepted_sums(const CauseModel& model) const;
  /// Sizes and lines of the model by a step, and the point's; whether that was the whole step.
  bool take_step(const ViewStep& step, CauseModel& model, ViewPoint& point) const;
  /// The system linearised at a model.
  [[nodiscard]] ViewSystem& at(const CauseModel& model) const;
  [[nodiscard]] Projection one_row_a_landmark(const CauseModel& model) const;

  ViewBasis basis_;
  ViewFit fit_;
  EffectSizes known_;
  LibraryOptions library_;
  std::vector<ViewCause> causes_;
  CauseModel nominal_;
  std::unique_ptr<ViewSystem> system_;  ///< memory that linearisations share
  /// Where the system stands with all columns; null where it was moved. A state belongs to one set
  /// of accepted causes.
  mutable std::shared_ptr<const CauseState> stands_at_;
  mutable Eigen::VectorXd stands_sizes_;
};

}  // namespace roadbook
