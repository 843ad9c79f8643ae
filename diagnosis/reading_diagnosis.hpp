#pragma once

#include "diagnosis/detector/person_detections.hpp"
#include "diagnosis/friction/friction_readings.hpp"
#include "diagnosis/inference/findings.hpp"
#include "diagnosis/range/beacon_problem.hpp"
#include "diagnosis/range/range_readings.hpp"
#include "diagnosis/readings.hpp"

namespace roadbook {

/// `known`: a latency of the poses (`cam.latency`) is allowed for; people are seen in images, whose
/// clock is the poses' own.
[[nodiscard]] DriveReadings drive_readings(const Drive& drive,
                                           const std::vector<PoseSample>& poses,
                                           const EffectSizes& known = {});
/// `known`: already part of the model (`--model`); what differs from it is said.
[[nodiscard]] Diagnosis diagnose_readings(const DriveReadings& readings,
                                          const SearchOptions& search = {},
                                          const LibraryOptions& library = {},
                                          const EffectSizes& known = {});

/// The readings of one drive of several.
struct SessionReadings {
  std::string name;  ///< unique; empty where it is the only one
  const DriveReadings* readings = nullptr;
};
/// Of several drives with the same sensors each kind is one problem (`SessionsProblem`). Of a range
/// scanner shares are common to all drives where no drive's own ones are surely others; else, and
/// where scanners differ, each drive says its own.
[[nodiscard]] Diagnosis diagnose_readings(const std::vector<SessionReadings>& drives,
                                          const SearchOptions& search = {},
                                          const LibraryOptions& library = {},
                                          const EffectSizes& known = {});

}  // namespace roadbook
