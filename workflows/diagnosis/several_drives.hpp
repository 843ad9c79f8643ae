#pragma once

#include "diagnosis/diagnose.hpp"
#include "workflows/diagnosis/diagnosis_run.hpp"

namespace roadbook {

/// Runs `run_diagnosis` on several drives or plain logs of one vehicle. It diagnoses the motion of
/// all together (`diagnose_sessions`), and the readings of each kind of other sensor together
/// (`diagnose_readings`). A drive without recorded motion takes no part in the diagnosis of motion.
/// Throws BadInput, also for a drive that is given twice, because its data would count twice.
[[nodiscard]] DiagnosisRun diagnose_several(const DiagnosisRequest& request,
                                            const DiagnosisOptions& options,
                                            Messages& messages);

}  // namespace roadbook
