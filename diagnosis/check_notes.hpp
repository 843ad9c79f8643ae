#pragma once

#include <string>
#include <vector>

#include "diagnosis/checks.hpp"

namespace roadbook {

/// What a reader of the omnibus checks has to know of them: which channels have none though they
/// were read, and why poses that are better than diagnosis believes scatter by less than 1. `left`:
/// the innovations that `checks` are of.
[[nodiscard]] std::vector<std::string> check_notes(const std::vector<ChannelName>& channels,
                                                   const Innovations& left,
                                                   const std::vector<ChannelCheck>& checks);

}  // namespace roadbook
