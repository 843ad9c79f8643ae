#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>

#include "speedmap/presence/presence_grid.hpp"
#include "speedmap/presence/visit_evidence.hpp"
#include "speedmap/speeds/lane_speeds.hpp"

namespace roadbook {

/// The settings of `roadbook speeds`, read from `--config` (docs/guide/speeds.md).
struct SpeedsConfig {
  PresenceOptions presence;
  SightOptions sight;
  LaneSpeedOptions speed;
  std::map<std::uint64_t, double> limits;  ///< [m/s] by lane; others: speed.max_speed
  double visit_half_life_days = 90.0;      ///< half-life of a visit's evidence about people; 0: no
                                           ///< decay
  double friction_half_life_days = 2.0;    ///< after this time the friction map counts as stale

  /// Reads the settings from a file. Settings that the file lacks keep their value in `defaults`.
  /// Throws BadInput.
  static SpeedsConfig load(const std::filesystem::path& file, const SpeedsConfig& defaults);
  /// Reads the settings from text. `name` is the file name for messages.
  static SpeedsConfig parse(const std::string& text,
                            const std::string& name,
                            const SpeedsConfig& defaults);
  /// Returns all settings, including defaults, as text that `parse` reads back unchanged.
  [[nodiscard]] std::string text() const;
  /// Throws InvalidOption.
  void check() const;
  [[nodiscard]] double limit_of(std::uint64_t lane) const;
};

}  // namespace roadbook
