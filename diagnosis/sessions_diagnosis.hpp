#pragma once

#include <span>
#include <string>
#include <vector>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/diagnose_together.hpp"

namespace roadbook {

/// The streams of one drive of several.
struct SessionStreams {
  std::string name;  ///< unique
  MotionStreams streams;
  std::string source{};  ///< what messages call it; empty: by its name
};

/// Diagnosis of several drives of one vehicle together (`SessionsProblem`): effects common to all
/// have one size, effects of one drive are reported with it. One drive is diagnosed as by
/// `diagnose`. Throws BadInput if a drive cannot be diagnosed. A drive may be shorter than the
/// options ask for (1 m and 2 s), if all together are long enough.
[[nodiscard]] Diagnosis diagnose_sessions(std::span<const SessionStreams> drives,
                                          const DiagnosisOptions& options = {});

/// Marks everything found as of one drive of several; notes and flags begin with its name.
void mark_session(const std::string& session, Diagnosis& diagnosis);

}  // namespace roadbook
