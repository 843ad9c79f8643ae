#include "workflows/network_coverage.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/format.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kNamed = 5;

std::string place_text(const Eigen::Vector3d& place) {
  return "(" + fixed(place.x(), 1) + ", " + fixed(place.y(), 1) + ", " + fixed(place.z(), 1) + ")";
}

}  // namespace

std::vector<Problem> coverage_warnings(const RoadNetwork& network,
                                       const std::string& file,
                                       double min_coverage) {
  std::vector<Problem> problems;
  if (network.uncovered.empty()) return problems;
  const auto add = [&](const std::string& got, const std::string& want) {
    problems.push_back({Severity::kWarning, file, 0, "coverage", got, want});
  };
  double all_m = 0.0;
  for (const UncoveredStretch& stretch : network.uncovered) all_m += stretch.driven_m;
  add(fixed(network.coverage, 4) + " (" + fixed(all_m, 0) + " m driven in " +
          std::to_string(network.uncovered.size()) + " stretches are farther than " +
          fixed(network.reach_m, 1) + " m from every lane)",
      "at least " + fixed(min_coverage, 2));
  for (std::size_t i = 0; i < std::min(kNamed, network.uncovered.size()); ++i) {
    const UncoveredStretch& stretch = network.uncovered[i];
    add("no lane from " + place_text(stretch.from) + " to " + place_text(stretch.to) +
            " [m, map frame], where " + fixed(stretch.driven_m, 0) + " m were driven in " +
            std::to_string(stretch.parts) + (stretch.parts == 1 ? " part" : " parts") +
            " of passes",
        "a lane; a smaller --min-passes or another --reach-m may give one");
  }
  return problems;
}

nlohmann::ordered_json uncovered_json(const RoadNetwork& network) {
  auto all = nlohmann::ordered_json::array();
  const auto point = [](const Eigen::Vector3d& p) {
    return nlohmann::ordered_json::array({p.x(), p.y(), p.z()});
  };
  for (const UncoveredStretch& stretch : network.uncovered)
    all.push_back({{"from", point(stretch.from)},
                   {"to", point(stretch.to)},
                   {"driven_m", stretch.driven_m},
                   {"passes", stretch.parts}});
  return all;
}

}  // namespace roadbook
