#include "diagnosis/inference/cause_evidence.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <optional>

#include "diagnosis/inference/checks.hpp"
#include "diagnosis/inference/plausible_size.hpp"
#include "diagnosis/inference/shortlist.hpp"

namespace roadbook {
namespace {

// Covariance of all sizes in the model's last fit.
Eigen::MatrixXd covariance_of(const CauseModel& model) {
  Eigen::MatrixXd F = model.information;
  F.diagonal() *= 1.0 + 1e-10;
  return F.ldlt().solve(Eigen::MatrixXd::Identity(F.rows(), F.cols()));
}

// Information of one cause's sizes, with the other sizes free.
Eigen::MatrixXd information_beside(const Eigen::MatrixXd& covariance,
                                   Eigen::Index first,
                                   Eigen::Index count) {
  return covariance.block(first, first, count, count)
      .ldlt()
      .solve(Eigen::MatrixXd::Identity(count, count));
}

Eigen::MatrixXd information_of_last(const CauseModel& model) {
  const Eigen::MatrixXd covariance = covariance_of(model);
  const Eigen::Index n = model.accepted.back().size.size();
  return information_beside(covariance, covariance.rows() - n, n);
}

// Square of the gain over its standard error: the statistic if blocks, not rows, are independent.
double believed_statistic(const HeldOutGain& gain) {
  constexpr double kQuantile = 2.262;  // of Student's t, 9 degrees of freedom
  const double sigma = (gain.high - gain.low) / (2.0 * kQuantile);
  const double z = gain.total / std::max(sigma, 1e-9);
  return std::max(z * z, 1.0);
}

}  // namespace

double last_statistic(const CauseModel& model) {
  const Eigen::VectorXd& size = model.accepted.back().size;
  return size.dot(information_of_last(model) * size);
}

double refitted_evidence(const CauseModel& model, double penalty) {
  const Accepted& last = model.accepted.back();
  const Eigen::MatrixXd information = information_of_last(model);
  return log_evidence(information * last.size, information, last.candidate.tau) - penalty;
}

double evidence_of(const CauseModel& model, const ScoreTable& table, std::size_t a) {
  return evidence_of(model, table, std::vector<std::size_t>{a});
}

double evidence_of(const CauseModel& model,
                   const ScoreTable& table,
                   const std::vector<std::size_t>& causes) {
  std::vector<Eigen::Index> columns;
  std::vector<double> sizes, tau;
  double penalty = 0.0;
  for (const std::size_t a : causes) {
    const Accepted& cause = model.accepted[a];
    penalty += cause.candidate.penalty + std::log(table.tests());
    for (Eigen::Index i = 0; i < cause.size.size(); ++i) {
      columns.push_back(static_cast<Eigen::Index>(table.accepted_range(a).first) + i);
      sizes.push_back(cause.size[i] / cause.candidate.tau);
      tau.push_back(cause.candidate.tau);
    }
  }
  // In units of the plausible sizes, so that one prior is that of all.
  const auto n = static_cast<Eigen::Index>(tau.size());
  const Eigen::VectorXd unit = Eigen::Map<const Eigen::VectorXd>(tau.data(), n);
  const Eigen::VectorXd size = Eigen::Map<const Eigen::VectorXd>(sizes.data(), n);
  const Eigen::MatrixXd beside =
      covariance_of(model)(columns, columns).ldlt().solve(Eigen::MatrixXd::Identity(n, n));
  const Eigen::MatrixXd information = unit.asDiagonal() * beside * unit.asDiagonal();
  return log_evidence(information * size, information, 1.0) - penalty;
}

double corrected_p_value(const CauseModel& model, const ScoreTable& table, std::size_t a) {
  const auto freedom = static_cast<int>(model.accepted[a].size.size());
  return std::min(1.0, chi_squared_tail(2.0 * table.loss_without(a), freedom) * table.tests());
}

bool is_white(const ScoreTable& table, const std::vector<ChannelName>& channels) {
  const auto checks = check_innovations(table.innovations(), channels);
  return std::none_of(checks.begin(), checks.end(), [](const ChannelCheck& c) {
    return c.whiteness_p < 1e-6 && c.scale > kBelieved;
  });
}

double prior_cost(const CauseModel& model) {
  double sum = 0.0;
  for (const Accepted& a : model.accepted)
    sum += 0.5 * a.size.squaredNorm() / (a.candidate.tau * a.candidate.tau);
  return sum;
}

bool is_accepted(const CauseModel& model, const Candidate& candidate) {
  return std::any_of(model.accepted.begin(), model.accepted.end(), [&](const Accepted& a) {
    return a.candidate.name == candidate.name && candidate.kind != CandidateKind::kPlace;
  });
}

AcceptedEffect judge_effect(const CauseModel& model,
                            const ScoreTable& table,
                            std::size_t a,
                            double confounded_loss,
                            bool white) {
  AcceptedEffect v;
  v.cause = model.accepted[a];
  const std::size_t first = table.accepted_range(a).first;
  const auto at = static_cast<Eigen::Index>(first);
  v.sigma = std::sqrt(covariance_of(model)(at, at));
  const double own = table.loss_without(a);
  v.statistic = 2.0 * own;
  v.p = corrected_p_value(model, table, a);
  v.evidence = evidence_of(model, table, a);
  v.gain = gain_of_accepted(table, model, a);
  if (!white) confounded_loss *= std::max(1.0, v.statistic / believed_statistic(v.gain));
  for (std::size_t c = 0; c < table.candidates().size(); ++c) {
    const Candidate& candidate = table.candidates()[c];
    if (candidate.kind != CandidateKind::kNamed || is_accepted(model, candidate)) continue;
    const Score s = table.score_without(c, a);
    // A size far beyond the plausible is no alternative, an impossible one even less.
    if (s.size.size() != 1 || std::abs(s.size[0]) > kFarBeyondPlausible * candidate.tau ||
        !is_possible(candidate, s.size[0]))
      continue;
    if (own - 0.5 * s.statistic >= confounded_loss) continue;
    v.inseparable.push_back(candidate.name);
    v.instead.push_back(s.size[0]);
  }
  return v;
}

void add_refitted(const CauseProblem& problem,
                  const CauseModel& model,
                  const ScoreTable& table,
                  std::size_t a,
                  double confounded_loss,
                  AcceptedEffect& verdict) {
  const double own = table.loss_without(a);
  for (std::size_t c = 0; c < table.candidates().size(); ++c) {
    const Candidate& other = table.candidates()[c];
    if (other.kind != CandidateKind::kNamed || is_accepted(model, other)) continue;
    const Score s = table.score_without(c, a);
    if (s.size.size() != 1 || std::abs(s.size[0]) > kFarBeyondPlausible * other.tau) continue;
    const double loss = own - 0.5 * s.statistic;
    if (loss < confounded_loss || loss > 0.1 * own) continue;
    CauseModel refit = model;
    drop(refit, a);
    accept(refit, other);
    problem.fit(refit, 3);
    if (model.log_likelihood - refit.log_likelihood >= confounded_loss) continue;
    verdict.inseparable.push_back(other.name);
    verdict.instead.push_back(refit.accepted.back().size[0]);
  }
}

CauseModel with_other_name(const CauseProblem& problem,
                           const CauseModel& model,
                           const ScoreTable& table,
                           std::size_t a,
                           const std::string& name) {
  const Candidate* other = named(table.candidates(), name);
  if (other == nullptr) return model;
  CauseModel renamed = model;
  drop(renamed, a);
  accept(renamed, *other);
  problem.fit(renamed, 4);
  return renamed;
}

void note_impossible(const ScoreTable& table,
                     double min_evidence,
                     std::vector<Impossible>& impossible) {
  const auto n = impossible_candidate(table);
  if (!n || n->score.evidence < min_evidence) return;
  const Candidate& c = table.candidates()[n->candidate];
  const bool known = std::any_of(impossible.begin(), impossible.end(),
                                 [&](const Impossible& i) { return i.candidate.name == c.name; });
  if (!known) impossible.push_back({c, n->score.size[0]});
}

namespace {

// Whether an effect of twice its plausible size would be named, given its information.
bool would_be_named(const Candidate& candidate, const Score& score) {
  constexpr double kNamed = 5.0;  // [sigma] where half of the causes are named
  return 2.0 * candidate.tau * std::sqrt(score.information(0, 0)) >= kNamed;
}

std::optional<std::size_t> hidden_by(const CauseModel& model,
                                     const ScoreTable& table,
                                     std::size_t candidate) {
  for (std::size_t a = 0; a < model.accepted.size(); ++a)
    if (would_be_named(table.candidates()[candidate], table.score_without(candidate, a))) return a;
  return std::nullopt;
}

// Candidates that the drive does not show in addition to the model.
std::vector<std::size_t> unseen(const CauseModel& model, const ScoreTable& table) {
  std::vector<std::size_t> all;
  for (std::size_t c = 0; c < table.candidates().size(); ++c) {
    const Candidate& candidate = table.candidates()[c];
    if (candidate.kind == CandidateKind::kNamed && !is_accepted(model, candidate) &&
        !would_be_named(candidate, table.score(c)))
      all.push_back(c);
  }
  return all;
}

}  // namespace

std::vector<std::string> not_observable(const CauseModel& model, const ScoreTable& table) {
  std::vector<std::string> names;
  for (const std::size_t c : unseen(model, table))
    if (!hidden_by(model, table, c)) names.push_back(table.candidates()[c].name);
  return names;
}

std::vector<HiddenEffect> hidden_effects(const CauseModel& model, const ScoreTable& table) {
  std::vector<HiddenEffect> hidden;
  for (const std::size_t c : unseen(model, table)) {
    const auto a = hidden_by(model, table, c);
    if (!a) continue;
    const Candidate& by = model.accepted[*a].candidate;
    hidden.push_back({table.candidates()[c].name, by.kind == CandidateKind::kGrammar
                                                      ? by.hook + " depends on " + by.covariate
                                                      : by.name});
  }
  return hidden;
}

}  // namespace roadbook
