#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/evaluation/localisation/random_starts.hpp"
#include "base/progress.hpp"
#include "workflows/localisation/localisation_figures.hpp"

namespace roadbook {

// How well later visits are localised in the map of the first one, and found in it without a guess.

struct LocalisationStudyOptions {
  std::vector<std::string> places;  ///< built-in scenarios
  std::string size = "full";        ///< of the places: full, small
  double image_scale = 1.0;
  int visits = 1;            ///< later visits of each place
  std::size_t starts = 500;  ///< random ones a visit, at least 1
  std::uint64_t seed = 1;
  int num_threads = 0;
};

/// A later visit in the map of the first one.
struct VisitFigures {
  std::string place;
  int visit = 0;
  LocalisationFigures drive;
  StartTally starts;
};

/// Frames of one place in the map of another.
struct ForeignFigures {
  std::string place;
  std::string map;
  StartTally starts;
};

struct LocalisationStudy {
  std::vector<VisitFigures> visits;
  std::vector<ForeignFigures> foreign;
};

/// Simulates and maps what `folder` does not hold yet, and localises. A folder of an earlier run
/// with the same options is used again. Throws the exceptions of `simulate`, `map_drives` and
/// `localise_in_map`.
[[nodiscard]] LocalisationStudy localisation_study(const std::filesystem::path& folder,
                                                   const LocalisationStudyOptions& options,
                                                   const Progress& progress = {});

}  // namespace roadbook
