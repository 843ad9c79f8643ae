#pragma once

#include <string>
#include <vector>

#include "diagnosis/detector/person_detections.hpp"
#include "diagnosis/inference/findings.hpp"

namespace roadbook {

/// What a detector said in one drive of several.
struct DriveSightings {
  std::string name;  ///< unique; empty where it is the only one
  const SightingReadings* readings = nullptr;
};

/// detector.range and detector.foot_point, without truth: the sightings of one person from several
/// places must agree, and who is found before and after must be found between. Drives that saw
/// enough people are one problem. Of `known` detector.range is part of the nominal model; feet are
/// taken as they stand.
[[nodiscard]] Diagnosis diagnose_detector(const std::vector<DriveSightings>& drives,
                                          const SearchOptions& search = {},
                                          const LibraryOptions& library = {},
                                          const EffectSizes& known = {});

}  // namespace roadbook
