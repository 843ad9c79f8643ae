#pragma once

#include <filesystem>
#include <optional>

#include "base/error.hpp"
#include "mapping/map.hpp"

namespace roadbook {

/// Warns if the session's factor on the wheels' distance says that the stated radii are wrong: by
/// 1 % and 4 standard errors or more. `prior_sigma`: of the factor in the adjustment, whose pull
/// towards 1 is undone. `drive`: folder, for the warning. Empty without wheels or their standard
/// error.
[[nodiscard]] std::optional<Problem> doubt_of_wheel_scale(const Session& session,
                                                          double prior_sigma,
                                                          const std::filesystem::path& drive);

}  // namespace roadbook
