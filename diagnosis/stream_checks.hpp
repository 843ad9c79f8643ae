#pragma once

#include <string>
#include <vector>

#include "diagnosis/options.hpp"
#include "diagnosis/streams/streams.hpp"

namespace roadbook {

/// Throws BadInput, with the sample, if values are not finite, stamps do not increase, or streams
/// are missing or too short. `name`: of the drive, for messages.
void check_streams(const MotionStreams& streams,
                   const std::string& name,
                   const DiagnosisOptions& options);

/// Throws BadInput if the driven length [m] is below `options.min_length_m`.
void check_length(double length_m, const std::string& name, const DiagnosisOptions& options);
/// Throws BadInput if the duration [s] is below `options.min_duration_s`.
void check_duration(double duration_s, const std::string& name, const DiagnosisOptions& options);

/// Describes streams that are missing or have gaps.
[[nodiscard]] std::vector<std::string> stream_notes(const MotionStreams& streams,
                                                    const DiagnosisOptions& options);

/// One line for each dimension of the vehicle in which two calibrations differ by more than 1 %:
/// the result depends on which one is right. `whose`: "of the map" and "of the drive".
[[nodiscard]] std::vector<std::string> contradictions(const WheelModel& a,
                                                      const std::string& whose_a,
                                                      const WheelModel& b,
                                                      const std::string& whose_b);

}  // namespace roadbook
