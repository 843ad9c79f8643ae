#pragma once

#include "diagnosis/detector/person_detections.hpp"
#include "diagnosis/friction/friction_readings.hpp"
#include "diagnosis/range/beacon_problem.hpp"
#include "diagnosis/range/range_readings.hpp"

namespace roadbook {

/// Readings of a drive's friction, range and beacon sensors, and detections of people. Each may be
/// empty.
struct DriveReadings {
  FrictionReadings friction;
  RangeReadings ranges;
  BeaconReadings beacons;
  SightingReadings people;
  [[nodiscard]] bool empty() const {
    return friction.samples.empty() && ranges.samples.empty() && friction.notes.empty() &&
           ranges.notes.empty() && beacons.samples.empty() && beacons.notes.empty() &&
           people.looks.empty();
  }
};

}  // namespace roadbook
