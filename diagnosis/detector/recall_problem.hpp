#pragma once

#include <string>
#include <vector>

#include "diagnosis/detector/detector_grammar.hpp"
#include "diagnosis/detector/person_tracks.hpp"
#include "diagnosis/inference/cause_problem.hpp"

namespace roadbook {

/// Recall of a pedestrian detector as a problem for the search of effects: logistic regression with
/// a free intercept.
///
/// A trial is a frame in which a pedestrian must have been present: detected within the three
/// frames before and the three after, on visible ground, with nobody else near. Whether a frame is
/// a trial does not depend on its outcome. A pedestrian that is never detected gives no trials:
/// recall itself is not observable, but its change with range, bearing and other covariates is.
class RecallProblem final : public CauseProblem {
 public:
  /// `known`: size of detector.range in the nominal model.
  RecallProblem(const SightingReadings& readings,
                const std::vector<PersonTrack>& tracks,
                LibraryOptions library = {},
                double known = 0.0);

  [[nodiscard]] bool usable() const { return message_.empty(); }
  [[nodiscard]] const std::string& message() const { return message_; }
  /// Share of trials in which the pedestrian was detected.
  [[nodiscard]] double found_share() const;

  [[nodiscard]] std::vector<ChannelName> channels() const override;
  [[nodiscard]] std::size_t rows() const override { return found_.size(); }
  [[nodiscard]] double level_of_names() const override { return 0.002; }
  [[nodiscard]] CauseModel nominal() const override;
  [[nodiscard]] std::vector<Candidate> candidates(const CauseModel& model) const override;
  [[nodiscard]] Projection project(const CauseModel& model,
                                   std::vector<Candidate> candidates) const override;
  void fit(CauseModel& model, int iterations) const override;
  void fit_beside(CauseModel& model, int iterations, const SizePrior& others) const override;
  [[nodiscard]] RowCovariate covariate(const CauseModel& model,
                                       const Candidate& cause,
                                       const Innovations& innovations) const override;

 private:
  struct State;
  void collect(const SightingReadings& readings,
               const std::vector<PersonTrack>& tracks,
               std::size_t person);
  [[nodiscard]] double over_dispersion() const;
  [[nodiscard]] Eigen::MatrixXd columns(const Candidate& candidate) const;
  // Log odds of the model, with intercept.
  [[nodiscard]] Eigen::VectorXd log_odds(const CauseModel& model) const;

  // Contribution of the known range effect to the log odds.
  [[nodiscard]] Eigen::VectorXd known_part() const;

  LibraryOptions library_;
  double known_ = 0.0;
  std::string message_;
  std::vector<bool> found_;
  std::vector<DetectionContext> moments_;
  std::vector<std::size_t> person_;
  double dispersion_ = 1.0;  ///< variance over that of independent trials
};

}  // namespace roadbook
