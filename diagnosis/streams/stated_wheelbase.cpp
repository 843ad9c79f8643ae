#include "diagnosis/streams/stated_wheelbase.hpp"

#include <cstdio>

#include "base/yaml.hpp"

namespace roadbook {

std::optional<std::string> unstated_wheelbase(const Drive& drive) {
  if (!drive.wheel_model()) return std::nullopt;
  bool steered = false;
  drive.for_each_wheel_reading(
      [&](const WheelReading& r) { steered |= r.steering_rad.has_value(); });
  if (!steered) return std::nullopt;
  if (YamlMap::load(drive.folder() / "wheels0" / "sensor.yaml").has("wheelbase"))
    return std::nullopt;
  char text[200];
  std::snprintf(text, sizeof text,
                "no wheelbase is stated: %.1f m (a usual car) is assumed; steering0.wheelbase, "
                "steering0.ratio and steering0.understeer depend on it",
                drive.wheel_model()->wheelbase_m);
  return text;
}

}  // namespace roadbook
