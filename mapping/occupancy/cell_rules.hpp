#pragma once

namespace roadbook {

// The rules by which a reading changes one cell. Source: document 001, "Naive approach" and
// "Probabilistic grid mapping".

/// Naive rule: states and readings are free (0), unknown (0.5) or occupied (1). A free cell stays
/// free. It is wrong for any sensor with errors, and serves as a demonstration.
[[nodiscard]] double naive_update(double cell, double reading);

/// Log odds of a probability.
[[nodiscard]] double log_odds(double p);
/// Probability of log odds.
[[nodiscard]] double probability_of(double log_odds);

/// Binary Bayes filter. `p`: probability that the cell is occupied; `inverse`: by the inverse
/// sensor model for the reading; `prior`: before any reading. All in (0, 1).
[[nodiscard]] double bayes_update(double p, double inverse, double prior);
/// The same filter for the ratio p / (1 - p).
[[nodiscard]] double ratio_update(double ratio, double inverse, double prior);
/// The same filter for log odds: l + log odds(inverse) - log odds(prior).
[[nodiscard]] double log_odds_update(double l, double inverse, double prior);

}  // namespace roadbook
