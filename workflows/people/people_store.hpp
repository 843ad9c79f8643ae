#pragma once

#include <filesystem>

#include "mapping/store/map_file.hpp"
#include "semantics/overhead/ground_model.hpp"
#include "semantics/people/person_learner.hpp"
#include "workflows/people/detections.hpp"

namespace roadbook {

// What `roadbook detect` leaves in the map.

/// Table `person_examples`: judged windows, as features. Table `person_answers`: the answers about
/// hypotheses of searches, in the images of `person_instants` (digest of the drive and stamp).
/// Empty if the map has no such table.
///
/// Throws BadInput for examples of another window.
[[nodiscard]] PersonExamples read_person_examples(const MapLayers& layers);
void write_person_examples(MapUpdate& update, const PersonExamples& examples);

/// Layer `people`: everybody found, where the map has them today, feet on its ground, for GIS
/// programs; the covariance has the sighting's and the vehicle pose's. What roadbook reads are the
/// tables of `write_sightings`, relative to the vehicle.
void write_people_layer(MapUpdate& update,
                        const Map& map,
                        const GroundModel& ground,
                        const std::vector<SessionSightings>& sightings);

}  // namespace roadbook
