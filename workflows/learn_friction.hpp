#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/messages.hpp"
#include "speedmap/property_map/friction_map.hpp"
#include "workflows/friction_update.hpp"
#include "workflows/settings/friction_config.hpp"

namespace roadbook {

/// The arguments of `learn_friction`.
struct FrictionRequest {
  std::filesystem::path drive;  ///< a drive of the map, with class images and readings
  std::filesystem::path map;
  std::filesystem::path config;  ///< YAML; empty: the configuration of the map
  std::filesystem::path slice;   ///< .json or .h; empty: none
  std::string lane;              ///< of the slice; empty: the first
  std::string property = "friction";
  double from_m = 0.0;
  std::optional<double> to_m;  ///< empty: the end of the lane
  bool replace = false;        ///< start a new friction map
};

struct FrictionResult {
  FrictionMap friction;
  FrictionConfig config;
  FrictionSummary summary;
  bool speeds_older = false;  ///< the map's speeds were made with an older friction map
};

/// Updates the friction map along the lanes of a map with a drive. Writes a slice if the user
/// requested one. Throws BadInput, InvalidOption, Refused (no class images, or no reading on seen
/// ground), StorageError. The map then stays unchanged.
[[nodiscard]] FrictionResult learn_friction(const FrictionRequest& request, Messages& messages);

}  // namespace roadbook
