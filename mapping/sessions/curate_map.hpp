#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mapping/map.hpp"

namespace roadbook {

struct CurateOptions {
  int per_place = 60;               ///< landmarks that a place keeps
  std::optional<std::size_t> most;  ///< landmarks of the map; the places then keep fewer

  /// Throws InvalidOption.
  void check() const;
};

/// What a curation keeps.
struct Curation {
  std::vector<char> keeps;      ///< of each landmark
  std::size_t kept = 0;         ///< number of them
  int per_place = 0;            ///< landmarks that a place keeps where it has them
  std::size_t places = 0;       ///< from which landmarks were seen
  std::size_t full_places = 0;  ///< of them, those with at least `per_place` landmarks afterwards
};

/// Chooses the landmarks that localisation needs. A place is a metre of the way in
/// one direction, 1.5 m to both sides, and a camera; a landmark belongs to all places from which it
/// was seen. Landmarks are taken one
/// after another, each time the one with the largest product of its weight (`landmark_weights`),
/// the share of passing sessions that saw it, and the number of its places that have fewer than
/// `per_place` yet [greedy algorithm for set multicover]. Deterministic.
[[nodiscard]] Curation curation_of(const Map& map, const CurateOptions& options);

/// The map without the landmarks that `curation` drops, their observations and what sessions saw
/// of them. Poses stay as they are.
[[nodiscard]] Map curated_map(const Map& map, const Curation& curation);

struct CurateSummary {
  std::size_t landmarks_before = 0;
  std::size_t observations_before = 0;
  std::size_t observations = 0;
  std::uintmax_t bytes_before = 0;  ///< of the file
  std::uintmax_t bytes = 0;
  Curation curation;
  std::string digest;  ///< of the map, unchanged after a dry run
};

/// Curates the map file `map`, or only computes the summary (`dry_run`). Layers and tables stay.
/// Throws BadInput, StorageError; the map then is unchanged.
CurateSummary curate_map(const std::filesystem::path& map,
                         const CurateOptions& options,
                         bool dry_run);

}  // namespace roadbook
