#pragma once

#include <optional>
#include <string_view>

#include "sensors/effects.hpp"

namespace roadbook {

/// Declaration of the effect that is called `name` ("cam2.focal", "imu0.outliers"); none: there is
/// no such effect.
[[nodiscard]] std::optional<EffectInfo> declared_effect(std::string_view name);

}  // namespace roadbook
