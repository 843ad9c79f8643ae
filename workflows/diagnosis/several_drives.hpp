#pragma once

#include "diagnosis/diagnose.hpp"
#include "workflows/diagnosis/diagnosis_run.hpp"

namespace roadbook {

/// `run_diagnosis` of several drives of one vehicle: motion together (`diagnose_sessions`), and
/// what other sensors read of each kind together (`diagnose_readings`). A drive of which no motion
/// is recorded is left out of what they share. Throws BadInput, also for a drive that is there
/// twice: its data would count twice.
[[nodiscard]] DiagnosisRun diagnose_several(const DiagnosisRequest& request,
                                            const DiagnosisOptions& options,
                                            Messages& messages);

}  // namespace roadbook
