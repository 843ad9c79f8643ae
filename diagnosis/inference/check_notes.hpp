#pragma once

#include <string>
#include <vector>

#include "diagnosis/inference/checks.hpp"

namespace roadbook {

/// What a reader of the omnibus checks has to know of them: which channels have none though they
/// were read, and why poses that are better than diagnosis believes scatter by less than 1. `left`:
/// the innovations that `checks` are of.
[[nodiscard]] std::vector<std::string> check_notes(const std::vector<ChannelName>& channels,
                                                   const Innovations& left,
                                                   const std::vector<ChannelCheck>& checks);

/// "autocorrelation in STREAM (CHANNEL)" for each channel that is not white and exceeds the least
/// noise level. Innovations assume white noise, so that an accepted `correlation` effect of a
/// stream stays in them. For streams in `correlated` only the autocorrelation beyond a first-order
/// process counts.
[[nodiscard]] std::vector<std::string> autocorrelations(const std::vector<ChannelName>& channels,
                                                        const Innovations& left,
                                                        const std::vector<ChannelCheck>& checks,
                                                        const std::vector<std::string>& correlated);

}  // namespace roadbook
