#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "speedmap/speeds/speed_map.hpp"
#include "workflows/people/merge_sightings.hpp"
#include "workflows/speeds_update.hpp"

namespace roadbook {

/// The arguments of `make_speeds`.
struct SpeedsRequest {
  std::filesystem::path map;                      ///< with lanes and paths (`roads`)
  std::vector<std::filesystem::path> detections;  ///< tables of people, in the vehicle's frame
  std::vector<std::string> observed;              ///< sessions in which the detector searched for
                                                  ///< people
  bool replace = false;     ///< sessions in the tables lose their earlier detections
  bool truth = false;       ///< people and places from the truth of simulated drives
  bool local = false;       ///< solve only near new rows, to 1e-6
  double days_later = 0.0;  ///< predict the speed map for this later time
  /// The time for which ages count, since 1970; empty: the end of the newest session, or the time
  /// of the newest item of a layer if that is later.
  std::optional<std::int64_t> now_ns{};
  std::filesystem::path config;  ///< YAML; empty: the configuration of the map
};

/// The detections taken from tables and truth, and those that were not used.
struct DetectionsTaken {
  MergeCount tables;
  MergeCount truth;
  std::vector<std::string> empty_tables;
  std::size_t without_session = 0;  ///< outside the time of every session
};

struct SpeedsResult {
  SpeedMap speeds;
  std::vector<VisitSummary> visits;
  DetectionsTaken taken;
  bool config_kept = false;                  ///< the map's own configuration was used
  std::vector<std::uint64_t> limits_lost;    ///< limits of lanes that no longer exist
  std::optional<std::size_t> places_solved;  ///< only with `local`; empty: all places
  std::vector<LayerItem> items;              ///< all of the map; `state` tells which are used
  double presence_max = 0.0;
  std::string digest;  ///< of the map file afterwards
};

/// Computes presence, recommended speeds and the profile of each lane, and stores them in the map.
/// Throws BadInput, InvalidOption, Refused (no lane has a path), StorageError.
[[nodiscard]] SpeedsResult make_speeds(const SpeedsRequest& request);

}  // namespace roadbook
