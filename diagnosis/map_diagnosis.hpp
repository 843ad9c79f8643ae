#pragma once

#include "diagnosis/diagnose.hpp"
#include "diagnosis/views/view_data.hpp"
#include "drive/drive.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// What the simulation gets wrong in a drive, seen through its session in a map: first the views of
/// landmarks through the full bundle adjustment (`ViewProblem`), then wheels, steering and gyro
/// against poses. Those are the drive's reference poses; without any, the poses that the views give
/// once their causes are taken out, and what the views judge of wheels and cameras is left to them.
/// The drive is taken as recorded: do not `correct` it; `options.known` are the known effects.
///
/// What either cannot be asked stands in the notes.
[[nodiscard]] Diagnosis diagnose_through_map(const Map& map,
                                             int session,
                                             const Drive& drive,
                                             const DiagnosisOptions& options = {},
                                             const ViewDataOptions& view_options = {});

}  // namespace roadbook
