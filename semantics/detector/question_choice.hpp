#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace roadbook {

// Chooses the hypotheses to ask a person about, so that the answers reduce the uncertainty about
// all hypotheses most.
//
// Uncertainty sampling is not enough: an outlier is uncertain, and its answer says nothing about
// other hypotheses. The choice maximises the expected variance reduction (Cohn, Ghahramani and
// Jordan 1996, "Active learning with statistical models"). Let C be the posterior covariance of f
// between the hypotheses and w = p (1 - p) the precision of an answer under Laplace's approximation
// (Rasmussen and Williams 2006, section 3.4). An answer about i reduces the variance of f_j by
// C_ij^2 / (C_ii + 1 / w_i), and the variance of its probability by w_j^2 times that. The sum over
// j is weighted by w_i, because an answer that is known in advance adds nothing. C is updated after
// each choice, so similar hypotheses are asked about once.
//
// Questions alternate between probabilities above and below one half. The gain alone would ask
// mostly about the many negatives, and a classifier trained on few positives loses recall.

/// Indices of at most `count` of n hypotheses, most useful first, alternating between probabilities
/// of at least one half and below. `covariance`: of f, n x n; `probability`: of each hypothesis.
[[nodiscard]] std::vector<std::size_t> most_telling(Eigen::MatrixXd covariance,
                                                    const Eigen::VectorXd& probability,
                                                    std::size_t count);

}  // namespace roadbook
