#include "sim/simulate_options.hpp"

#include "base/error.hpp"

namespace roadbook {

void SimulateOptions::check() const {
  check_effects(effects);
  if (!(max_duration_s >= 0.0))
    throw InvalidOption("max_duration_s", std::to_string(max_duration_s), "0 or more");
  if (num_threads < 0) throw InvalidOption("num_threads", std::to_string(num_threads), "0 or more");
  for (const auto& [camera, t] : camera_dies_s)
    if (camera != "cam0" && camera != "cam1" && camera != "cam2" && camera != "cam3")
      throw InvalidOption("camera_dies_s", camera + " at " + std::to_string(t) + " s",
                          "cam0 to cam3");
}

}  // namespace roadbook
