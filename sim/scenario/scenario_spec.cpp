#include "sim/scenario/scenario_spec.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace roadbook {

namespace {

template <typename T>
const T& named(const std::vector<T>& all, const std::string& name, const std::string& file) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const T& item) { return item.name == name; });
  if (found == all.end())
    throw BadInput(Problem{Severity::kError, file, 0, name, "no such name", "one of the scenario"});
  return *found;
}

}  // namespace

int BaySpec::bay_of(const Eigen::Vector2d& place) const {
  if (place.y() < low.y() || place.y() >= high.y()) return -1;
  const double bay = std::floor((place.x() - low.x()) / step_m());
  return bay >= 0.0 && bay < count ? static_cast<int>(bay) : -1;
}

const LaneSpec& Scenario::lane(const std::string& lane_name) const {
  return named(lanes, lane_name, file);
}

const CrossingSpec& Scenario::crossing(const std::string& crossing_name) const {
  return named(crossings, crossing_name, file);
}

}  // namespace roadbook
