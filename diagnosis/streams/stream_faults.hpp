#pragma once

#include <string>
#include <vector>

#include "diagnosis/streams/observations.hpp"
#include "diagnosis/streams/streams.hpp"
#include "diagnosis/streams/trajectory.hpp"

namespace roadbook {

// Faults of the recording that would pass for effects of sensors: clocks that are not one, units
// of stamps, readings that stand still.

/// Throws BadInput where stamps cannot be those of one drive: streams that have less than
/// `min_common_s` in common with the poses, and readings rarer or denser than any sensor's, which
/// is what a wrong unit of time looks like. `name` stands for the drive in messages.
void check_stamps(const MotionStreams& streams, const std::string& name, double min_common_s);

/// Throws BadInput where a stream shows the poses' motion of another time, farther away than a
/// latency is searched for. `obs` and `motion` are of the poses.
void check_offsets(const Observations& obs, const Trajectory& motion, const std::string& name);

/// Takes out wheels that stand still while the poses go on (for good or for a stretch), and
/// steering and gyro whose readings never change while the poses' turning does. Each is said in a
/// line; what is left of the stream would look like effects.
[[nodiscard]] std::vector<std::string> drop_stuck(MotionStreams& streams);

}  // namespace roadbook
