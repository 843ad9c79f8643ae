#pragma once

#include <string>
#include <vector>

#include "diagnosis/detector/detector_grammar.hpp"
#include "diagnosis/detector/person_tracks.hpp"
#include "diagnosis/inference/cause_problem.hpp"

namespace roadbook {

/// Whether a detector finds somebody of whom other looks say that they are there: logistic
/// regression, the nominal log odds unknown.
///
/// A look at a person counts where that person was found within the three looks before and the
/// three after, whether or not in this one, the ground there was seen and nobody else was near:
/// what decides that it counts does not depend on its outcome. Whom the detector never finds leaves
/// no trace: recall itself is not observable, its change with range, bearing, ... is.
class RecallProblem final : public CauseProblem {
 public:
  /// `known`: size of detector.range that is part of the nominal model.
  RecallProblem(const SightingReadings& readings,
                const std::vector<PersonTrack>& tracks,
                LibraryOptions library = {},
                double known = 0.0);

  [[nodiscard]] bool usable() const { return message_.empty(); }
  [[nodiscard]] const std::string& message() const { return message_; }
  /// Share of the looks that count in which the person was found.
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
  // Log odds of the model, the intercept included.
  [[nodiscard]] Eigen::VectorXd log_odds(const CauseModel& model) const;

  // Of the log odds what the known size makes of the range.
  [[nodiscard]] Eigen::VectorXd known_part() const;

  LibraryOptions library_;
  double known_ = 0.0;
  std::string message_;
  std::vector<bool> found_;
  std::vector<SightMoment> moments_;
  std::vector<std::size_t> person_;
  double dispersion_ = 1.0;  ///< variance over that of independent looks
};

}  // namespace roadbook
