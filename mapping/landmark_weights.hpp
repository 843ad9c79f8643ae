#pragma once

#include <vector>

#include "mapping/map.hpp"

namespace roadbook {

/// Landmarks of less weight are not searched when a drive is localised.
inline constexpr double kLeastWeight = 0.1;

/// Probability that each landmark is still there and can be seen, from what the sessions that came
/// after it saw (`Map::landmark_sessions`); 1 where none came.
///
/// A landmark is there or gone: a hidden Markov model with two states, solved by the forward sum
/// over all paths [Rabiner, Proceedings of the IEEE 77 (1989), equations 19 to 21]. It goes between
/// two sessions with probability 0.1 and comes back, as a parked car does, with 0.03. While it is
/// there, a session sees it with the landmark's own chance, 0.65 to 0.95: what is seen more seldom
/// is of no use. A session in which it lay in few images tells less. Deterministic.
[[nodiscard]] std::vector<double> landmark_weights(const Map& map);

}  // namespace roadbook
