#pragma once

#include <string>
#include <vector>

#include "diagnosis/detector/person_detections.hpp"
#include "diagnosis/inference/findings.hpp"

namespace roadbook {

/// The detections of one drive.
struct DriveSightings {
  std::string name;  ///< unique; empty if it is the only drive
  const SightingReadings* readings = nullptr;
};

/// Estimates detector.foot_point and detector.range without ground truth. Detections of one person
/// from several places must agree in position, and a person detected before and after an image must
/// be detected in it. All drives with enough people are one problem. A known detector.range is part
/// of the nominal model; known foot positions must already be subtracted (`without_known`).
[[nodiscard]] Diagnosis diagnose_detector(const std::vector<DriveSightings>& drives,
                                          const SearchOptions& search = {},
                                          const LibraryOptions& library = {},
                                          const EffectSizes& known = {});

}  // namespace roadbook
