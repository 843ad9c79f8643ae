#pragma once

#include <filesystem>

#include "mapping/store/map_file.hpp"
#include "semantics/overhead/ground_model.hpp"
#include "semantics/people/person_learner.hpp"
#include "workflows/people/detections.hpp"

namespace roadbook {

// The data that `roadbook detect` stores in the map.

/// Table `person_examples`: judged windows, as features. Table `person_answers`: the answers about
/// hypotheses of searches, in the images of `person_instants` (digest of the drive and stamp).
/// Empty if the map has no such table.
///
/// Throws BadInput for examples of another window.
[[nodiscard]] PersonExamples read_person_examples(const MapLayers& layers);
void write_person_examples(MapUpdate& update, const PersonExamples& examples);

/// Writes layer `people` for GIS programs: all detected people at their place in the current map,
/// with the feet on its ground. The covariance includes the sighting and the vehicle pose. The
/// program itself reads the tables of `write_sightings`, which are relative to the vehicle.
void write_people_layer(MapUpdate& update,
                        const Map& map,
                        const GroundModel& ground,
                        const std::vector<SessionSightings>& sightings);

}  // namespace roadbook
