#pragma once

#include "sim/scenario/scenario_spec.hpp"
#include "sim/scenario/yaml_reader.hpp"

namespace roadbook {

// Parts of a place that look the same: storeys one above another, bays side by side
// (docs/reference/simulation.md). The functions throw BadInput with file, line and field.

[[nodiscard]] StoreySpec read_storeys(const YamlReader& in);
/// Requires that a ceiling lies between each floor and the next.
void require_ceiling(const YamlReader& in, const Scenario& scenario);

[[nodiscard]] BaySpec read_bays(const YamlReader& in, const GroundSpec& ground);
/// Adds to the scenario, for each further bay, copies of the rows, walls and blocks that have their
/// middle in the first bay.
void fill_bays(Scenario& scenario);

}  // namespace roadbook
