#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/progress.hpp"
#include "mapping/pipeline/map_options.hpp"

namespace roadbook {

// A map that lives: visits extend it one after another, and what this costs and yields beside a map
// built from all recordings at once.

struct SessionStudyOptions {
  std::string place = "zurich";  ///< built-in scenario
  std::string size = "full";     ///< full, small
  double image_scale = 1.0;
  int visits = 7;        ///< sessions of the map, and one more that is only localised
  int order_visits = 4;  ///< number of visits whose orders are built
  int orders = 24;       ///< at most
  std::uint64_t seed = 1;
  int num_threads = 0;
};

/// Error of a session against its truth.
struct SessionError {
  std::optional<double> alone_m;   ///< median, after its own best alignment
  std::optional<double> offset_m;  ///< of its mean place, against all sessions
};

/// The map after a visit.
struct SessionStep {
  int visit = 0;
  double cpu_s = 0.0;        ///< of the extension (visit 0: of the build), all threads
  double alone_cpu_s = 0.0;  ///< of a map of this visit alone
  double peak_rss_mb = 0.0;
  std::optional<double> localised_share;
  std::size_t landmarks = 0;
  std::size_t map_frames = 0;
  std::size_t bytes = 0;
  std::optional<double> together_m;      ///< median error of all sessions after one alignment
  std::vector<SessionError> sessions;    ///< of each session so far
  std::optional<double> held_out_m;      ///< median error of the last visit, localised in this map
  std::optional<double> held_out_share;  ///< of its frames within 0.1 m
};

/// Visits added with one kind of adjustment.
struct SessionChain {
  std::string adjust;  ///< "near", "all", "none", or "batch": built from all recordings each time
  std::vector<SessionStep> steps;
};

/// A visit localised in an outdated map: a share of its landmarks has the descriptors of other
/// landmarks.
struct OutdatedStep {
  double share = 0.0;
  double localised = 0.0;  ///< share of the frames
  double right = 0.0;      ///< share of the frames, within 0.3 m
  double wrong = 0.0;      ///< share of the frames, farther away
  std::optional<double> median_m;
};

struct SessionStudy {
  std::vector<SessionChain> chains;
  int orders = 0;
  std::optional<double> orders_worst_m;  ///< largest difference of a pose, after one SE(3)
  std::optional<double> orders_median_m;
  std::vector<OutdatedStep> outdated;
};

/// Simulates what `folder` does not hold yet, and maps. Throws the exceptions of `simulate`,
/// `map_drives` and `localise_in_map`.
[[nodiscard]] SessionStudy session_study(const std::filesystem::path& folder,
                                         const SessionStudyOptions& options,
                                         const Progress& progress = {});

}  // namespace roadbook
