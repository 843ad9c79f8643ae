#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "diagnosis/inference/candidate.hpp"
#include "diagnosis/inference/evidence.hpp"
#include "diagnosis/inference/innovations.hpp"
#include "diagnosis/inference/noise_cause.hpp"

namespace roadbook {

// Interface between the search for effects and the data that it searches.
// The search (`search_causes`) knows no car: it scores candidate columns, asks for full refits, and
// compares evidence. A problem knows its measurements, its unknowns, and how each candidate changes
// the measurements. It projects the unknowns out of all of them. A trajectory with its streams is
// one problem (`MotionProblem`); camera observations in a map and readings at known places are
// others. tests/diagnosis/inference/cause_problem_test.cpp has the smallest one, a linear
// regression.

/// A candidate that is part of the model, with its size (several for terms of the grammar).
struct Accepted {
  Candidate candidate;
  Eigen::VectorXd size;  ///< in addition to the problem's nominal model
};

/// Other parts of a problem's model (trajectory, landmarks, noise), which only the problem reads.
/// Models share them, so they never change once a model holds them.
struct CauseState {
  CauseState() = default;
  CauseState(const CauseState&) = default;
  CauseState& operator=(const CauseState&) = default;
  virtual ~CauseState() = default;
};

/// A problem's nominal model extended by accepted causes.
struct CauseModel {
  std::vector<Accepted> accepted;
  std::shared_ptr<const CauseState> state;
  // Of the last fit:
  Eigen::MatrixXd information;  ///< of all accepted sizes, in order; other unknowns projected out
  double log_likelihood = 0.0;  ///< but for constants; the noise is the nominal model's throughout
};

/// Linearised about a model: innovations whose sides are the residual, the columns of the accepted
/// causes in order, and the columns of candidates. The residual is that of the model *with* its
/// accepted sizes; a column is the change of the readings (not of the residual) by a size of 1,
/// whitened and projected like the residual, so that residual = sum of size * column + noise.
struct Projection {
  std::size_t accepted = 0;  ///< number of the accepted causes' columns
  /// Those that the data can show, their `columns` filled in; several may share a column.
  std::vector<Candidate> candidates;
  Innovations innovations;
};

/// One kind of scalar that is measured, as reports name it: stream "wheels0", channel "distance".
struct ChannelName {
  std::string stream;
  std::string channel;
};

/// For plots: the label of the x axis, and the covariate's value at each of a projection's
/// innovations.
struct RowCovariate {
  std::string axis;  ///< "speed [m/s]"
  std::vector<double> values;
};

/// Prior on all accepted sizes of a model, in order, from other data. `information` is the
/// information of these data; `weighted` is `information` times the sizes that fit these data.
struct SizePrior {
  Eigen::MatrixXd information;
  Eigen::VectorXd weighted;
  [[nodiscard]] bool empty() const { return information.size() == 0; }
  /// Score of sizes `at`.
  [[nodiscard]] Eigen::VectorXd score(const Eigen::VectorXd& at) const {
    return weighted - information * at;
  }
};

/// All accepted sizes in order.
[[nodiscard]] Eigen::VectorXd sizes_of(const CauseModel& model);

// Calls are const and deterministic: the same model gives the same bytes. Poor data raise no
// exception; a projection omits candidates that the data do not show.
class CauseProblem {
 public:
  virtual ~CauseProblem() = default;

  [[nodiscard]] virtual std::vector<ChannelName> channels() const = 0;
  /// Scalars measured.
  [[nodiscard]] virtual std::size_t rows() const = 0;
  /// Fitted without any effect. Its noise must be estimated with the catalogued effects free under
  /// their priors, so that it does not absorb them. It stays the same in later fits.
  [[nodiscard]] virtual CauseModel nominal() const = 0;
  /// Where the search begins: the nominal model, unless that is so far off that it needs causes
  /// before anything can be scored. Those have to stand the tests of the rest at the end.
  [[nodiscard]] virtual CauseModel start() const { return nominal(); }

  /// P-value, corrected for all catalogued effects, at which one is accepted without comparison
  /// with the many generic effects. 0 if this level was not measured on data without an effect.
  [[nodiscard]] virtual double level_of_names() const { return 0.0; }

  /// All candidates for an extension of the model, without columns. Names are unique except those
  /// of places, which are tried one at a time. The same name in two problems means the same effect.
  [[nodiscard]] virtual std::vector<Candidate> candidates(const CauseModel& model) const = 0;
  /// See `Projection`. Columns are built from smoothed predictions rather than from raw readings,
  /// whose noise they would share.
  [[nodiscard]] virtual Projection project(const CauseModel& model,
                                           std::vector<Candidate> candidates) const = 0;
  /// Full non-linear refit of unknowns and accepted sizes, from the model's present values, in at
  /// most `iterations` steps. Sets sizes, state, information and log likelihood.
  virtual void fit(CauseModel& model, int iterations) const = 0;
  /// The same refit, with a prior on the sizes from other drives; information and log likelihood
  /// are those of this problem's own data. Only of problems that several drives can share.
  virtual void fit_beside(CauseModel& model, int iterations, const SizePrior& others) const;

  /// Finer variants of a place, to be tried instead of it.
  [[nodiscard]] virtual std::vector<Candidate> refinements(const CauseModel& model,
                                                           const Candidate& place) const;
  /// Terms by which the size of an accepted name might depend on something, without its mean: what
  /// a right name's size does not. None where the problem has no say.
  [[nodiscard]] virtual std::vector<Candidate> variations(const CauseModel& model,
                                                          const Candidate& name) const;
  /// Causes in the noise of the final model, strongest first.
  [[nodiscard]] virtual std::vector<NoiseCause> noise_causes(const CauseModel& model) const;
  /// What a user should know about a found cause, in addition to its size: "within 3 m of x = ...".
  [[nodiscard]] virtual std::string note(const Accepted& cause) const;
  /// A drive that would separate accepted effect `a` (index) from `alternatives`, with which it is
  /// confounded in this drive, as a sentence; empty if the problem cannot say. `threshold` [nats]:
  /// log likelihood that each alternative must lose in that drive.
  [[nodiscard]] virtual std::string separating(const CauseModel& model,
                                               std::size_t a,
                                               const std::vector<Candidate>& alternatives,
                                               double threshold) const;
  /// What to plot a cause's innovations against; time where the problem says nothing else.
  [[nodiscard]] virtual RowCovariate covariate(const CauseModel& model,
                                               const Candidate& cause,
                                               const Innovations& innovations) const;
  /// By default means of the innovations over bins of `covariate`.
  [[nodiscard]] virtual EvidencePlot evidence(const CauseModel& nominal,
                                              const CauseModel& extended,
                                              const Candidate& cause) const;
  /// Whether intervals take the scatter of one-second blocks where that is wider than what
  /// independent rows of the estimated noise would have.
  [[nodiscard]] virtual bool intervals_of_blocks() const { return false; }
  /// Indices into `channels()` whose errors may last for seconds: those of a reference. None where
  /// the model allows for such errors itself.
  [[nodiscard]] virtual std::vector<std::size_t> channels_of_reference() const { return {}; }
  /// True if the readings are so non-linear in the sizes that a held-out gain needs a refit of the
  /// model without the effect.
  [[nodiscard]] virtual bool gains_need_refit() const { return false; }
};

/// Model with one more cause, of size 0 until it is refitted, or with one fewer.
void accept(CauseModel& model, const Candidate& candidate);
void drop(CauseModel& model, std::size_t a);

}  // namespace roadbook
