#include <cmath>

#include "diagnosis/friction/friction_innovations.hpp"
#include "diagnosis/friction/friction_places.hpp"
#include "diagnosis/friction/friction_problem.hpp"

namespace roadbook {

using Eigen::Index;

FrictionMean FrictionProblem::mean_columns(const std::vector<Candidate>& beside) const {
  const auto n = static_cast<Index>(readings_.samples.size());
  const auto k = static_cast<Index>(classes_.labels.size());
  FrictionMean mean = FrictionMean::Zero(n, k + static_cast<Index>(beside.size()));
  for (Index i = 0; i < n; ++i)
    mean(i, static_cast<Index>(classes_.of[static_cast<std::size_t>(i)])) = 1.0;
  for (std::size_t c = 0; c < beside.size(); ++c)
    mean.col(k + static_cast<Index>(c)) =
        beside[c].tau * friction_columns(readings_, classes_, beside[c]).col(0);
  return mean;
}

FrictionNoise FrictionProblem::noise_beside(const std::vector<Candidate>& discs,
                                            bool places) const {
  const FrictionMean mean = mean_columns(friction_effects(readings_));
  const auto count = static_cast<Index>(discs.size());
  FrictionMean split(mean.rows(), count + mean.cols());
  for (Index d = 0; d < count; ++d)
    split.col(d) = friction_columns(readings_, classes_, discs[static_cast<std::size_t>(d)]);
  split.rightCols(mean.cols()) = mean;
  const auto flat = count + static_cast<Index>(classes_.labels.size());
  FrictionNoise noise = friction_noise(readings_.samples, *bases_, split, flat, places);
  // Readings on another surface look like outliers until it has its own mean.
  if (discs.empty() && !places) noise.outlier_part.assign(readings_.samples.size(), 0.0);
  return noise;
}

// Whitened residuals of the mean and all discs except `without`.
Eigen::VectorXd FrictionProblem::residuals_beside(const std::vector<Candidate>& discs,
                                                  const FrictionNoise& noise,
                                                  std::size_t without) const {
  const FrictionMean mean = mean_columns(friction_effects(readings_));
  FrictionMean residual(mean.rows(), 1);
  for (Index i = 0; i < mean.rows(); ++i)
    residual(i, 0) = readings_.samples[static_cast<std::size_t>(i)].friction -
                     mean.row(i).dot(noise.mean.tail(mean.cols()));
  for (std::size_t d = 0; d < discs.size(); ++d)
    if (d != without)
      residual.col(0) -= noise.mean[static_cast<Index>(d)] *
                         friction_columns(readings_, classes_, discs[d]).col(0);
  const Innovations e = friction_innovations(readings_, classes_, cells_, noise, residual);
  return Eigen::Map<const Eigen::VectorXd>(e.values.data(), mean.rows());
}

// Adds the most significant disc, if there is one. Then each disc is refined with the others in the
// model, because a disc found alone also covers parts of others.
bool FrictionProblem::add_disc(std::vector<Candidate>& discs) const {
  const FrictionNoise noise = noise_beside(discs, false);
  const Eigen::VectorXd left = residuals_beside(discs, noise, discs.size());
  for (const Candidate& place : resurfaced_places(readings_, classes_, cells_, left, 2)) {
    if (touches_disc(discs, place)) continue;
    discs.push_back(place);
    for (std::size_t d = discs.size(); d-- > 0;) {
      const FrictionNoise now = noise_beside(discs, false);
      discs[d] = moved_surface(readings_, classes_, residuals_beside(discs, now, d), discs[d]);
    }
    return true;
  }
  return false;
}

FrictionNoise FrictionProblem::nominal_noise() const {
  FrictionNoise best = noise_beside({}, true);
  if (!looks_for_surfaces() || left_out("friction0.extra_class")) return best;
  // Other surfaces look like a spatial bias or outliers until they have their own means. Discs are
  // added as long as the penalised likelihood grows.
  constexpr std::size_t kMostDiscs = 3;
  const bool with_places = best.place_sd > 0.0;
  double most = best.log_likelihood;
  double price = 0.0;
  for (std::vector<Candidate> discs; discs.size() < kMostDiscs && add_disc(discs);) {
    price += discs.back().penalty + 0.5 * std::log(static_cast<double>(readings_.samples.size()));
    FrictionNoise split = noise_beside(discs, with_places);
    if (split.log_likelihood - price > most) {
      most = split.log_likelihood - price;
      best = std::move(split);
    } else if (!with_places) {
      break;  // further discs would change nothing without a spatial bias
    }
  }
  return best;
}

}  // namespace roadbook
