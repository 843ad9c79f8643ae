#pragma once

#include <span>
#include <string>

#include "diagnosis/inference/findings.hpp"
#include "diagnosis/options.hpp"
#include "diagnosis/streams/streams.hpp"

namespace roadbook {

/// The streams of one drive, from which a tilt is to be removed.
struct TiltedDrive {
  std::string name;  ///< unique; empty if it is the only drive
  MotionStreams* streams = nullptr;
};

/// Rotates all readings of the IMU to the stated axes. `gyro` becomes their levelled z axis.
/// Nothing changes where the streams have no IMU of three axes or the tilt is 0.
void remove_tilt(double roll_rad, double pitch_rad, MotionStreams& streams);

/// Finds the tilt of the IMU (`imu0.tilt_roll`, `imu0.tilt_pitch`) of one or several drives and
/// removes it from their streams, so that motion is diagnosed with a level gyro: its z axis reads
/// too small by the cosine of the tilt. Known sizes (`options.known`) are removed first; the result
/// is the difference from them, its extended model has the whole sizes. Empty where no drive has an
/// IMU of three axes, or where all axes but one are constant. One drive that shows a tilt speaks
/// for the vehicle. The road is no fault of a sensor: lack of fit is not reported.
[[nodiscard]] Diagnosis diagnose_tilt(std::span<const TiltedDrive> drives,
                                      const DiagnosisOptions& options);

}  // namespace roadbook
