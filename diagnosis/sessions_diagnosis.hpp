#pragma once

#include <span>
#include <string>
#include <vector>

#include "diagnosis/diagnose.hpp"
#include "diagnosis/sessions_problem.hpp"

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

/// What drives say of one kind of data: together where there are several, each measured alike. Of a
/// single one what it finds counts as the vehicle's. Nothing of none.
[[nodiscard]] Diagnosis diagnose_together(const std::vector<SessionProblem>& drives,
                                          const SearchOptions& options);

/// Marks everything found as of one drive of several; notes and flags begin with its name.
void mark_session(const std::string& session, Diagnosis& diagnosis);

}  // namespace roadbook
