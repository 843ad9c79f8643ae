#include "semantics/detector/question_choice.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace roadbook {
namespace {

constexpr double kLeastPrecision = 1e-9;

// Gain of a question about each hypothesis, as defined in the header.
Eigen::VectorXd gains(const Eigen::MatrixXd& covariance, const Eigen::VectorXd& precision) {
  const Eigen::VectorXd told =
      covariance.array().square().matrix() * precision.array().square().matrix();
  return precision.array() * told.array() /
         (covariance.diagonal().array() + precision.array().inverse());
}

// The best free hypothesis on one side of probability one half; -1 if no hypothesis is left.
Eigen::Index best_of(const Eigen::VectorXd& gain,
                     const Eigen::VectorXd& probability,
                     const std::vector<bool>& taken,
                     bool positive) {
  Eigen::Index best = -1;
  for (Eigen::Index i = 0; i < gain.size(); ++i)
    if (!taken[static_cast<std::size_t>(i)] && (probability[i] >= 0.5) == positive &&
        (best < 0 || gain[i] > gain[best]))
      best = i;
  return best;
}

}  // namespace

std::vector<std::size_t> most_telling(Eigen::MatrixXd covariance,
                                      const Eigen::VectorXd& probability,
                                      std::size_t count) {
  ROADBOOK_ASSERT(covariance.rows() == probability.size() &&
                  covariance.cols() == probability.size());
  const Eigen::VectorXd precision =
      (probability.array() * (1.0 - probability.array())).max(kLeastPrecision);
  std::vector<std::size_t> chosen;
  std::vector<bool> taken(static_cast<std::size_t>(probability.size()), false);
  while (chosen.size() < std::min(count, taken.size())) {
    const Eigen::VectorXd gain = gains(covariance, precision);
    const bool positive = chosen.size() % 2 == 0;
    Eigen::Index best = best_of(gain, probability, taken, positive);
    if (best < 0) best = best_of(gain, probability, taken, !positive);
    chosen.push_back(static_cast<std::size_t>(best));
    taken[chosen.back()] = true;
    const Eigen::VectorXd told = covariance.col(best);
    covariance -= told * told.transpose() / (told[best] + 1.0 / precision[best]);
  }
  return chosen;
}

}  // namespace roadbook
