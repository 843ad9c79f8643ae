#pragma once

#include <string>
#include <vector>

#include "diagnosis/streams/observations.hpp"
#include "diagnosis/streams/streams.hpp"
#include "diagnosis/streams/trajectory.hpp"

namespace roadbook {

// Faults of a recording that would be mistaken for effects of sensors: streams of different clocks,
// wrong units of stamps, stuck readings.

/// Throws BadInput if the streams cannot belong to one drive: a stream has less than `min_common_s`
/// [s] in common with the poses, or its usual interval is one that no sensor has (a wrong unit of
/// time). `name`: the drive, for messages.
void check_stamps(const MotionStreams& streams, const std::string& name, double min_common_s);

/// Throws BadInput if a stream matches the motion of the poses at a lag beyond the range of a
/// latency. `obs` and `motion` belong to the poses.
void check_offsets(const Observations& obs, const Trajectory& motion, const std::string& name);

/// Removes stuck readings, which would look like effects: wheels that stop while the poses move,
/// for good or for a time; steering and gyro readings that never change while the turning does.
/// Returns one line of text for each removal.
[[nodiscard]] std::vector<std::string> drop_stuck(MotionStreams& streams);

}  // namespace roadbook
