#include "mapping/pipeline/map_options.hpp"

#include "base/error.hpp"

namespace roadbook {

void MapOptions::check() const {
  tracking.check();
  graph.check();
  bundle.bundle.check();
  row_options.check();
  if (min_views < 2) throw InvalidOption("min_views", std::to_string(min_views), ">= 2");
  if (min_keyframes < 2)
    throw InvalidOption("min_keyframes", std::to_string(min_keyframes), ">= 2");
}

}  // namespace roadbook
