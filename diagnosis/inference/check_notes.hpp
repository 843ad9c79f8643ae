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

/// "autocorrelation in STREAM (CHANNEL)" of every channel that is not white and says more than the
/// least noise believed. Innovations are those of white noise throughout, so that correlation of
/// a stream's noise stays in them when it is named: of streams in `correlated` only what is not
/// white once a first-order process is taken off.
[[nodiscard]] std::vector<std::string> autocorrelations(const std::vector<ChannelName>& channels,
                                                        const Innovations& left,
                                                        const std::vector<ChannelCheck>& checks,
                                                        const std::vector<std::string>& correlated);

}  // namespace roadbook
