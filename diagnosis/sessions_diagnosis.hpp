#pragma once

#include <span>
#include <string>

#include "diagnosis/diagnose.hpp"

namespace roadbook {

/// The streams of one drive of several.
struct SessionStreams {
  std::string name;  ///< unique
  MotionStreams streams;
  std::string source{};  ///< what messages call it; empty: by its name
};

/// Several drives of one vehicle together (`SessionsProblem`): what is common to all with one size,
/// and what is of one drive alone. One drive is diagnosed as ever. Throws BadInput where a drive
/// cannot be diagnosed.
[[nodiscard]] Diagnosis diagnose_sessions(std::span<const SessionStreams> drives,
                                          const DiagnosisOptions& options = {});

/// Marks everything found as of one drive of several; notes and flags begin with its name.
void mark_session(const std::string& session, Diagnosis& diagnosis);

}  // namespace roadbook
