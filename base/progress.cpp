#include "base/progress.hpp"

#include <string>

#include "base/error.hpp"

namespace roadbook {

void report(const Progress& progress, std::string_view stage, std::size_t done, std::size_t total) {
  if (progress && !progress(stage, done, total))
    throw Interrupted("interrupted during " + std::string(stage) +
                      ": what was saved is kept; run the command again");
}

}  // namespace roadbook
