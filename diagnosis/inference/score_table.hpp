#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/inference/cause_problem.hpp"

namespace roadbook {

/// Score test of one candidate, given the accepted causes. The fit does not include the candidate.
struct Score {
  double statistic = 0.0;  ///< T, chi-squared with `freedom` under the null
  int freedom = 1;
  double p = 1.0;         ///< of one test
  double evidence = 0.0;  ///< [nats] log Bayes factor less the candidate's penalties
  Eigen::VectorXd size;   ///< expected change
  Eigen::MatrixXd information;
};

// Innovations of one pass with all accepted and all candidate columns, and their products.
class ScoreTable {
 public:
  /// `projection`: of the problem at this model.
  ScoreTable(const CauseModel& model, Projection projection);

  [[nodiscard]] const std::vector<Candidate>& candidates() const { return all_.candidates; }
  [[nodiscard]] const Innovations& innovations() const { return all_.innovations; }

  /// Score of candidate c, given all accepted causes.
  [[nodiscard]] Score score(std::size_t c) const;
  /// Score with all accepted effects in the model except `without` (index), whose part is put back
  /// into the residual.
  [[nodiscard]] Score score_without(std::size_t c, std::size_t without) const;
  /// The same without several of them.
  [[nodiscard]] Score score_without(std::size_t c, const std::vector<std::size_t>& without) const;
  /// Share of accepted cause a's first column, squared, that candidate c's columns make up; 1 where
  /// the cause is a special case of the candidate.
  [[nodiscard]] double made_up(std::size_t c, std::size_t a) const;
  /// T with the scatter that 1 s blocks have once the candidate is fitted, in place of the model's
  /// own noise: small where residuals are correlated. Of groups, along their own best direction.
  [[nodiscard]] double robust_statistic(std::size_t c) const;
  /// Standard error of accepted cause `a`'s first size by the scatter of 1 s blocks over that of
  /// independent rows: more than 1 where rows scatter more, or go together, where the cause shows.
  [[nodiscard]] double block_scatter(std::size_t a) const;
  /// Log likelihood that accepted cause `a` adds to the model of the other accepted causes.
  [[nodiscard]] double loss_without(std::size_t a) const;
  /// Log likelihood that several accepted causes together add to the model of the others.
  [[nodiscard]] double loss_without(const std::vector<std::size_t>& causes) const;
  /// Index of the first accepted column and the number of columns of accepted cause a.
  [[nodiscard]] std::pair<std::size_t, std::size_t> accepted_range(std::size_t a) const;
  [[nodiscard]] std::size_t accepted_columns() const { return all_.accepted; }
  /// Number of candidates for the correction of p-values: all places together count as one
  /// candidate (they have an additional penalty), each generic effect as one.
  [[nodiscard]] double tests() const;
  /// Names among the candidates.
  [[nodiscard]] double names() const;

 private:
  void multiply();
  /// Of accepted causes, among the accepted ones.
  [[nodiscard]] std::vector<Eigen::Index> columns_of(const std::vector<std::size_t>& causes) const;
  [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> own_pairs() const;
  [[nodiscard]] Score score_of(std::size_t c,
                               const std::vector<Eigen::Index>& nuisance,
                               const Eigen::VectorXd& residual) const;

  Projection all_;
  std::vector<std::pair<std::size_t, std::size_t>> ranges_;
  Eigen::VectorXd sizes_;             ///< of all accepted
  Eigen::MatrixXd base_;              ///< products of residual and accepted columns
  Eigen::MatrixXd cross_;             ///< with all sides
  std::vector<Eigen::MatrixXd> own_;  ///< of each candidate's columns
};

/// log B of a Gaussian effect with prior N(0, tau^2 I).
[[nodiscard]] double log_evidence(const Eigen::VectorXd& score,
                                  const Eigen::MatrixXd& information,
                                  double tau);
/// Upper tail of the chi-squared distribution.
[[nodiscard]] double chi_squared_tail(double statistic, int freedom);

}  // namespace roadbook
