#include "mapping/occupancy/cell_rules.hpp"

#include <cmath>

namespace roadbook {

double naive_update(double cell, double reading) {
  if (cell == 0.0 || reading == 0.0) return 0.0;
  return cell == 1.0 || reading == 1.0 ? 1.0 : 0.5;
}

double log_odds(double p) { return std::log(p) - std::log1p(-p); }

double probability_of(double log_odds) {
  // Without loss of digits at either end.
  return log_odds < 0.0 ? std::exp(log_odds) / (1.0 + std::exp(log_odds))
                        : 1.0 / (1.0 + std::exp(-log_odds));
}

double bayes_update(double p, double inverse, double prior) {
  const double occupied = inverse * p / prior;
  const double free = (1.0 - inverse) * (1.0 - p) / (1.0 - prior);
  return occupied / (occupied + free);
}

double ratio_update(double ratio, double inverse, double prior) {
  return inverse / (1.0 - inverse) * ratio * (1.0 - prior) / prior;
}

double log_odds_update(double l, double inverse, double prior) {
  return log_odds(inverse) + l - log_odds(prior);
}

}  // namespace roadbook
