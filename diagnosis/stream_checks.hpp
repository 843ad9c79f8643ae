#pragma once

#include <string>
#include <vector>

#include "diagnosis/diagnose.hpp"

namespace roadbook {

/// Throws BadInput naming the sample where streams are not finite, do not ascend, or are too few.
void check_streams(const MotionStreams& streams,
                   const std::string& name,
                   const DiagnosisOptions& options);

/// Throws BadInput where too little was driven.
void check_length(double length_m, const std::string& name, const DiagnosisOptions& options);

/// What is missing or has gaps, in words.
[[nodiscard]] std::vector<std::string> stream_notes(const MotionStreams& streams,
                                                    const DiagnosisOptions& options);

}  // namespace roadbook
