#pragma once

#include <optional>
#include <string>

#include "drive/drive.hpp"

namespace roadbook {

/// Warning for a drive that records steering but states no wheelbase in wheels0/sensor.yaml: which
/// default is used, and which effects depend on it. No value if the wheelbase is stated or not
/// needed.
[[nodiscard]] std::optional<std::string> unstated_wheelbase(const Drive& drive);

}  // namespace roadbook
