#include "mapping/pipeline/stage_clock.hpp"

#include <sys/resource.h>

namespace roadbook {

double peak_rss_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace roadbook
