#include "diagnosis/friction/friction_noise_model.hpp"

#include <cmath>

#include "base/median.hpp"

namespace roadbook {

ReadingNoise reading_noise(const std::vector<FrictionSample>& samples, const FrictionNoise& noise) {
  ReadingNoise own;
  std::vector<double> sigmas, steps;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    sigmas.push_back(samples[i].sigma);
    if (i > 0) steps.push_back(samples[i].t_s - samples[i - 1].t_s);
  }
  const double gap = 2.5 * (steps.empty() ? 1.0 : median(steps));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const double part = noise.outlier_part.empty() ? 0.0 : noise.outlier_part[i];
    own.sigma.push_back(noise.scale * samples[i].sigma / std::sqrt(1.0 - part + 0.01 * part));
    own.goes_on.push_back(i > 0 && samples[i].t_s - samples[i - 1].t_s <= gap);
  }
  return own;
}

}  // namespace roadbook
