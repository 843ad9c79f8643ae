#pragma once

#include <cstddef>
#include <string>

namespace roadbook {

/// Summary of one stream of a drive, as `roadbook check` prints it.
struct StreamSummary {
  std::string name;  ///< "cam0", "wheels0", ...
  std::size_t rows = 0;
  double rate_hz = 0.0;  ///< median
  std::size_t gaps = 0;  ///< intervals longer than 2.5 times the median
};

}  // namespace roadbook
