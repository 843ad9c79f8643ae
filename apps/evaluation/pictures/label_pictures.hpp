#pragma once

#include <vector>

#include "apps/evaluate.hpp"
#include "apps/evaluation/pictures/annotated_car_parks.hpp"
#include "semantics/detector/label_oracle.hpp"

namespace roadbook {

/// What one car park has taught about another.
struct LotTransfer {
  std::size_t learnt = 0;          ///< index of the lot whose marks played the labeller
  std::size_t judged = 0;          ///< index of the lot that was searched
  std::vector<BoxScore> rounds;    ///< after each round
  std::vector<OrientedBox> found;  ///< after the last one
};

/// Learns on lot `learnt` in rounds; after each, what it has been taught so far searches all lots
/// `judged`, of which it has seen nothing. `own`: the rounds themselves; `taught`: all they taught.
[[nodiscard]] std::vector<LotTransfer> play_transfer(const std::vector<AnnotatedCarPark>& lots,
                                                     std::size_t learnt,
                                                     const std::vector<std::size_t>& judged,
                                                     const OracleOptions& options,
                                                     OracleResult& own,
                                                     BoxExamples* taught = nullptr);

/// `evaluate labels --data FOLDER`: the detector on real pictures (read_annotated_car_parks).
/// Writes `pictures.svg`, `result.json` and, for the eye, `found_N.png`: what was found (green),
/// missed (red) and found where nothing is marked (blue) by what the lot before has taught. Each
/// lot, or the first `repeats`, teaches, and is judged on the two after it.
void evaluate_label_pictures(Console& console, const EvaluateCommand& command);

}  // namespace roadbook
