#pragma once

#include <optional>
#include <string>

#include "drive/drive.hpp"

namespace roadbook {

/// What to say of a drive that records steering but whose wheels0/sensor.yaml states no wheelbase:
/// that a usual car's was taken, and which effects depend on it. None where it is stated, or where
/// nothing of it is asked.
[[nodiscard]] std::optional<std::string> unstated_wheelbase(const Drive& drive);

}  // namespace roadbook
