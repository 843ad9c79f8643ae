#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace roadbook {

// Which of many things to ask a person about, so that the answers teach a Gaussian process
// classifier most about all of them.
//
// What is least sure is not what teaches most. A thing that looks like nothing else is as unsure as
// they come, and tells of nothing but itself. What counts is by how much an answer makes all the
// others surer (Cohn, Ghahramani and Jordan 1996, "Active learning with statistical models"): with
// C the covariance of f between them and w = p (1 - p) the precision of an answer under Laplace's
// approximation (Rasmussen and Williams 2006, section 3.4), asking about i takes
// C_ij^2 / (C_ii + 1 / w_i) from the variance of each f_j, and so about w_j^2 times that from the
// variance of its probability; weighed by w_i, as an answer that is known beforehand teaches
// nothing. The answers of a round come together: C is updated by each choice before the next, so
// that things that are alike are asked about once.
//
// Half of the questions are about what would be taken for a positive, half about what would not:
// there are both kinds of error. Left alone the gain asks about negatives for the most part, which
// are more, and a classifier that hears little but "no" forgets what a positive looks like.

/// Indices of at most `count` of the n things, the most useful first, of probabilities above and
/// below one half in turn. `covariance`: of f between them (n x n); `probability`: of each.
[[nodiscard]] std::vector<std::size_t> most_telling(Eigen::MatrixXd covariance,
                                                    const Eigen::VectorXd& probability,
                                                    std::size_t count);

}  // namespace roadbook
