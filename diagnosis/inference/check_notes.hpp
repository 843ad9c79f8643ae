#pragma once

#include <string>
#include <vector>

#include "diagnosis/inference/checks.hpp"

namespace roadbook {

/// Notes for a reader of the omnibus checks: channels with readings but without checks, and the
/// reason why the scale of accurate poses is below 1. `left`: the innovations that were checked.
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
