#pragma once

#include "diagnosis/diagnose.hpp"
#include "diagnosis/views/view_data.hpp"
#include "drive/drive.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// Diagnosis of a drive through its session in a map: first the observations of landmarks in the
/// full bundle adjustment (`ViewProblem`), then wheels, steering and gyro against poses. These are
/// the drive's reference poses. Without a reference, they are the poses of the observations after
/// their effects are removed; what the observations determine about wheels and cameras is then left
/// to them. Use the drive as recorded, not corrected; `options.known` are the known effects.
/// The notes list questions that neither can answer.
[[nodiscard]] Diagnosis diagnose_through_map(const Map& map,
                                             int session,
                                             const Drive& drive,
                                             const DiagnosisOptions& options = {},
                                             const ViewDataOptions& view_options = {});

}  // namespace roadbook
