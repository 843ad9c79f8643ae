#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "base/progress.hpp"

namespace roadbook {

/// Simulated visits of built-in places, which stay in a folder and are used again by later studies.
struct SimulatedVisits {
  std::filesystem::path folder;
  std::string size = "full";  ///< of the places: full, small
  double image_scale = 1.0;
  std::uint64_t seed = 1;
  int num_threads = 0;

  /// Path of a file or folder of a place. The name holds the options: a folder may serve several
  /// studies.
  [[nodiscard]] std::filesystem::path file(const std::string& place, const std::string& end) const;

  /// The drive of a visit, simulated if the folder does not hold it yet. Throws the exceptions of
  /// `simulate`.
  [[nodiscard]] std::filesystem::path drive(const std::string& place,
                                            int visit,
                                            const Progress& progress = {}) const;
};

}  // namespace roadbook
