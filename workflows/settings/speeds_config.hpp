#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "speedmap/presence/presence_grid.hpp"
#include "speedmap/presence/visit_evidence.hpp"
#include "speedmap/speeds/lane_speeds.hpp"

namespace roadbook {

/// What `roadbook speeds` can be told by `--config` (docs/guide/speeds.md).
struct SpeedsConfig {
  PresenceOptions presence;
  SightOptions sight;
  LaneSpeedOptions speed;
  std::map<std::uint64_t, double> limits;  ///< [m/s] by lane; others: speed.max_speed
  double visit_half_life_days = 90.0;      ///< what a visit tells of people; 0: never fades
  double friction_half_life_days = 2.0;    ///< after that the friction map is called stale

  /// What the file does not name stays as in `defaults`. Throws BadInput.
  static SpeedsConfig load(const std::filesystem::path& file, const SpeedsConfig& defaults);
  /// The same from text; `name` stands for the file.
  static SpeedsConfig parse(const std::string& text,
                            const std::string& name,
                            const SpeedsConfig& defaults);
  /// All of it, defaults included, so that `parse` gives the same again.
  [[nodiscard]] std::string text() const;
  /// Throws InvalidOption.
  void check() const;
  [[nodiscard]] double limit_of(std::uint64_t lane) const;
};

}  // namespace roadbook
