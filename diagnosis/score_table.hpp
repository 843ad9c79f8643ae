#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/candidate.hpp"
#include "diagnosis/motion_model.hpp"

namespace roadbook {

/// Score test of one candidate beside the accepted causes, from a fit without it.
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
  /// Runs the pass at the model's point. The accepted causes' columns are the library's front; the
  /// columns are dropped afterwards.
  ScoreTable(const Observations& obs, const MotionModel& model, Library library);

  [[nodiscard]] const Library& library() const { return library_; }
  [[nodiscard]] const Innovations& innovations() const { return innovations_; }

  /// Score of candidate c beside all accepted causes.
  [[nodiscard]] Score score(std::size_t c) const;
  /// Beside all accepted causes but `without` (index), whose part is put back into the residual.
  [[nodiscard]] Score score_without(std::size_t c, std::size_t without) const;
  /// T with the scatter that 1 s blocks have once the candidate is fitted, in place of the model's
  /// own noise: small where residuals are correlated. Of groups, along their own best direction.
  [[nodiscard]] double robust_statistic(std::size_t c) const;
  /// log likelihood that accepted cause `a` adds beside the other accepted ones.
  [[nodiscard]] double loss_without(std::size_t a) const;
  /// Index of the first accepted column and the number of columns of accepted cause a.
  [[nodiscard]] std::pair<std::size_t, std::size_t> accepted_range(std::size_t a) const;
  [[nodiscard]] std::size_t accepted_columns() const { return accepted_; }
  [[nodiscard]] double candidates() const;

 private:
  [[nodiscard]] Score score_of(std::size_t c,
                               const std::vector<Eigen::Index>& nuisance,
                               const Eigen::VectorXd& residual) const;

  Library library_;
  std::size_t accepted_ = 0;
  std::vector<std::pair<std::size_t, std::size_t>> ranges_;
  Eigen::VectorXd sizes_;  ///< of all accepted
  Innovations innovations_;
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
