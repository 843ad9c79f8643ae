#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnosis/inference/cause_problem.hpp"
#include "diagnosis/inference/joined_rows.hpp"

namespace roadbook {

/// One drive of several.
struct SessionProblem {
  std::string name;  ///< as reports call it; unique
  const CauseProblem* problem = nullptr;
};

/// Several drives of one vehicle as one problem. Each drive has its own unknowns and noise. An
/// effect belongs to the vehicle (one size, measured by all drives that show it) or to one drive
/// ("wheels0.radius in tuesday"); the evidence decides. Places belong to one drive; generic effects
/// belong to all.
/// Rows of the drives follow each other in time, so that each block belongs to one drive. A refit
/// visits the drives in turn, each with the information of the others about the sizes
/// (`fit_beside`).
class SessionsProblem final : public CauseProblem {
 public:
  /// The problems are kept by pointer; two at least, of the same kind of data.
  explicit SessionsProblem(std::vector<SessionProblem> sessions);

  [[nodiscard]] std::vector<ChannelName> channels() const override;
  [[nodiscard]] std::size_t rows() const override;
  [[nodiscard]] CauseModel nominal() const override;
  /// With the large effects of any of the drives.
  [[nodiscard]] CauseModel start() const override;
  /// The strictest level of the drives; 0 if one of them has none.
  [[nodiscard]] double level_of_names() const override;
  /// Where any of the drives' problems needs it.
  [[nodiscard]] bool intervals_of_blocks() const override;
  [[nodiscard]] std::vector<std::size_t> channels_of_reference() const override;
  [[nodiscard]] bool gains_need_refit() const override;
  [[nodiscard]] std::vector<Candidate> candidates(const CauseModel& model) const override;
  [[nodiscard]] Projection project(const CauseModel& model,
                                   std::vector<Candidate> candidates) const override;
  void fit(CauseModel& model, int iterations) const override;
  [[nodiscard]] std::vector<Candidate> refinements(const CauseModel& model,
                                                   const Candidate& place) const override;
  [[nodiscard]] std::vector<Candidate> variations(const CauseModel& model,
                                                  const Candidate& name) const override;
  [[nodiscard]] std::vector<NoiseCause> noise_causes(const CauseModel& model) const override;
  [[nodiscard]] std::string note(const Accepted& cause) const override;
  /// The manoeuvre that would separate the effect in the first drive that has it. To separate an
  /// effect of one drive from one of all drives, a further drive.
  [[nodiscard]] std::string separating(const CauseModel& model,
                                       std::size_t a,
                                       const std::vector<Candidate>& alternatives,
                                       double threshold) const override;
  /// In the first drive that the cause is of.
  [[nodiscard]] EvidencePlot evidence(const CauseModel& nominal,
                                      const CauseModel& extended,
                                      const Candidate& cause) const override;

  /// The model of one drive.
  [[nodiscard]] CauseModel of(const CauseModel& model, std::size_t session) const;

 private:
  /// The candidate as session `s` calls it; nothing where it is not of that session.
  [[nodiscard]] std::optional<Candidate> in(std::size_t s, const Candidate& candidate) const;
  /// Of all accepted sizes those that session `s` has, in its order.
  [[nodiscard]] std::vector<Eigen::Index> sizes_in(std::size_t s, const CauseModel& model) const;

  /// Sides of a candidate's columns in all drives; nothing where no drive can show it.
  [[nodiscard]] std::optional<std::vector<SharedSide>> columns_of(
      const Candidate& candidate, const std::vector<Projection>& own) const;
  [[nodiscard]] std::vector<Projection> each_projected(
      const CauseModel& model, const std::vector<Candidate>& candidates) const;

  std::vector<SessionProblem> sessions_;
  std::vector<std::vector<Candidate>> listed_;  ///< of each session, places left out
};

}  // namespace roadbook
