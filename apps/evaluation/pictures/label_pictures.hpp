#pragma once

#include <vector>

#include "apps/evaluate.hpp"
#include "apps/evaluation/pictures/annotated_car_parks.hpp"
#include "semantics/detector/label_oracle.hpp"

namespace roadbook {

/// The result on one lot after learning on another lot.
struct LotTransfer {
  std::size_t learnt = 0;          ///< index of the lot whose annotations answer the questions
  std::size_t judged = 0;          ///< index of the lot that was searched
  std::vector<BoxScore> rounds;    ///< after each round
  std::vector<OrientedBox> found;  ///< after the last one
};

/// Learns on lot `learnt` in rounds. After each round, the learnt detector searches all lots
/// `judged`, which are held out. `own` receives the rounds, `taught` all examples.
[[nodiscard]] std::vector<LotTransfer> play_transfer(const std::vector<AnnotatedCarPark>& lots,
                                                     std::size_t learnt,
                                                     const std::vector<std::size_t>& judged,
                                                     const OracleOptions& options,
                                                     OracleResult& own,
                                                     BoxExamples* taught = nullptr);

/// Runs `evaluate labels --data FOLDER`: the detector on real pictures (read_annotated_car_parks).
/// Each lot, or only the first `repeats`, is a training lot. The detector is evaluated on the two
/// lots after it. Writes `pictures.svg`, `result.json` and the pictures `found_N.png`. These show
/// correct detections (green), missed objects (red) and detections without annotation (blue), with
/// the examples of the previous lot.
void evaluate_label_pictures(Console& console, const EvaluateCommand& command);

}  // namespace roadbook
