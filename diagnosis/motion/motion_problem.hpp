#pragma once

#include "diagnosis/inference/cause_problem.hpp"
#include "diagnosis/motion/motion_model.hpp"

namespace roadbook {

/// The trajectory and effects behind a model of a `MotionProblem`.
[[nodiscard]] MotionModel motion_model(const CauseModel& model);

/// A drive's streams of planar motion as a problem for the search; the trajectory is the nuisance
/// parameter.
class MotionProblem final : public CauseProblem {
 public:
  /// `known`: sizes of effects that are part of the model already. Fits the nominal model.
  explicit MotionProblem(Observations obs,
                         const EffectSizes& known = {},
                         LibraryOptions library = {});
  /// About a model that is fitted already.
  MotionProblem(Observations obs, MotionModel nominal, LibraryOptions library);

  [[nodiscard]] std::vector<ChannelName> channels() const override;
  [[nodiscard]] std::size_t rows() const override { return obs_.offsets().back(); }
  [[nodiscard]] CauseModel nominal() const override;
  /// With large effects if the nominal model is nowhere near the data.
  [[nodiscard]] CauseModel start() const override;
  /// Not where poses share their errors, or readings of the gyro do.
  [[nodiscard]] double level_of_names() const override { return level_of_names_; }
  [[nodiscard]] std::vector<Candidate> candidates(const CauseModel& model) const override;
  [[nodiscard]] Projection project(const CauseModel& model,
                                   std::vector<Candidate> candidates) const override;
  void fit(CauseModel& model, int iterations) const override;
  void fit_beside(CauseModel& model, int iterations, const SizePrior& others) const override;
  /// Discs of several radii near a place.
  [[nodiscard]] std::vector<Candidate> refinements(const CauseModel& model,
                                                   const Candidate& place) const override;
  /// Its column times speed, yaw rate, acceleration, curvature, heading and time.
  [[nodiscard]] std::vector<Candidate> variations(const CauseModel& model,
                                                  const Candidate& name) const override;
  [[nodiscard]] std::vector<NoiseCause> noise_causes(const CauseModel& model) const override;
  [[nodiscard]] std::string note(const Accepted& cause) const override;
  /// The shortest of `manoeuvres()` that does.
  [[nodiscard]] std::string separating(const CauseModel& model,
                                       std::size_t a,
                                       const std::vector<Candidate>& alternatives,
                                       double threshold) const override;
  [[nodiscard]] EvidencePlot evidence(const CauseModel& nominal,
                                      const CauseModel& extended,
                                      const Candidate& cause) const override;

  /// Poses, unless they are a map's, whose errors the nominal model allows for.
  [[nodiscard]] std::vector<std::size_t> channels_of_reference() const override;
  /// Clocks shift readings along a trajectory that is not straight.
  [[nodiscard]] bool gains_need_refit() const override { return true; }

  [[nodiscard]] const Observations& observations() const { return obs_; }

 private:
  Observations obs_;
  LibraryOptions library_;
  EffectSizes known_;
  MotionModel nominal_;
  MotionModel start_;
  double level_of_names_ = 0.0;
};

}  // namespace roadbook
