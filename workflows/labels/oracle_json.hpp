#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "semantics/detector/label_oracle.hpp"

namespace roadbook {

/// The rounds in the form that `--json` prints: `drawn`, `put_right`, `clicks`, `precision`,
/// `recall`.
[[nodiscard]] inline nlohmann::ordered_json oracle_rounds_json(
    const std::vector<OracleRound>& rounds) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const OracleRound& r : rounds)
    list.push_back({{"drawn", r.drawn},
                    {"put_right", r.put_right},
                    {"clicks", r.clicks},
                    {"found", r.found},
                    {"precision", r.precision},
                    {"recall", r.recall},
                    {"f1", r.f1},
                    {"seconds", r.seconds},
                    {"classifier", r.classifier}});
  return list;
}

}  // namespace roadbook
