#pragma once

#include "diagnosis/detector/person_detections.hpp"
#include "diagnosis/friction/friction_readings.hpp"
#include "diagnosis/inference/findings.hpp"
#include "diagnosis/range/beacon_problem.hpp"
#include "diagnosis/range/range_readings.hpp"
#include "diagnosis/readings.hpp"

namespace roadbook {

/// Readings of a drive's friction, range and detector sensors at the reference poses `poses`.
/// `known`: stamps are corrected for a known latency of the poses (`cam.latency`). Detections of
/// people come from images, which share the clock of the poses, and are not corrected.
[[nodiscard]] DriveReadings drive_readings(const Drive& drive,
                                           const std::vector<PoseSample>& poses,
                                           const EffectSizes& known = {});
/// Diagnosis of the readings of one drive. `known`: effects of the nominal model (`--model`); only
/// significant differences from them are reported.
[[nodiscard]] Diagnosis diagnose_readings(const DriveReadings& readings,
                                          const SearchOptions& search = {},
                                          const LibraryOptions& library = {},
                                          const EffectSizes& known = {});

/// The readings of one drive of several.
struct SessionReadings {
  std::string name;  ///< unique; empty if it is the only drive
  const DriveReadings* readings = nullptr;
};
/// The same for several drives with the same sensors. Each kind of reading is one problem of all
/// drives (`SessionsProblem`). Shares of a range scanner are common to all drives, unless the
/// shares of the drives differ significantly or the scanners differ; then each drive reports its
/// own.
[[nodiscard]] Diagnosis diagnose_readings(const std::vector<SessionReadings>& drives,
                                          const SearchOptions& search = {},
                                          const LibraryOptions& library = {},
                                          const EffectSizes& known = {});

}  // namespace roadbook
