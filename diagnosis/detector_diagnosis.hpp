#pragma once

#include "diagnosis/findings.hpp"
#include "diagnosis/sightings.hpp"

namespace roadbook {

/// detector.range and detector.foot_point, without truth: the sightings of one person from several
/// places must agree, and who is found before and after must be found between.
[[nodiscard]] Diagnosis diagnose_detector(const SightingReadings& readings,
                                          const SearchOptions& search = {},
                                          const LibraryOptions& library = {});

}  // namespace roadbook
