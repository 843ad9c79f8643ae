#include "diagnosis/friction/friction_innovations.hpp"

#include <cmath>

#include "diagnosis/numerics/sequential_projection.hpp"

namespace roadbook {

using Eigen::Index;

Innovations friction_innovations(const FrictionReadings& readings,
                                 const SurfaceClasses& classes,
                                 const PlaceCells& cells,
                                 const FrictionNoise& noise,
                                 const FrictionMean& sides) {
  const auto classes_count = static_cast<Index>(classes.labels.size());
  const Index terms = noise.place_terms.cols();
  constexpr double kClassPrior = 4.0;  // prior variance of a class mean; friction is of order 1
  Eigen::VectorXd prior = Eigen::VectorXd::Ones(classes_count + terms);
  prior.head(classes_count).setConstant(kClassPrior);
  SequentialProjection projection(prior, sides.cols());
  const ReadingNoise own = reading_noise(readings.samples, noise);
  const double fresh = std::sqrt(1.0 - noise.correlation * noise.correlation);
  Innovations result;
  result.sides = static_cast<std::size_t>(sides.cols());
  result.values.reserve(readings.samples.size() * result.sides);
  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(prior.size()), last_unknowns = unknowns;
  Eigen::RowVectorXd row(sides.cols()), last_row = row;
  for (std::size_t i = 0; i < readings.samples.size(); ++i) {
    const double weight = 1.0 / own.sigma[i];
    Eigen::VectorXd at = Eigen::VectorXd::Zero(prior.size());
    at[static_cast<Index>(classes.of[i])] = weight;
    if (terms > 0) at.tail(terms) = weight * noise.place_terms.row(static_cast<Index>(cells.of[i]));
    const Eigen::RowVectorXd now = weight * sides.row(static_cast<Index>(i));
    const bool goes_on = own.goes_on[i] && noise.correlation != 0.0;
    unknowns = goes_on ? ((at - noise.correlation * last_unknowns) / fresh).eval() : at;
    row = goes_on ? ((now - noise.correlation * last_row) / fresh).eval() : now;
    last_unknowns = at;
    last_row = now;
    const double variance = projection.next(unknowns, row);
    result.of.push_back({i, 0, readings.samples[i].t_s, variance});
    result.values.insert(result.values.end(), row.data(), row.data() + row.size());
  }
  return result;
}

}  // namespace roadbook
