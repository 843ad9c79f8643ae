#include "speedmap/presence/visit_evidence.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "base/error.hpp"
#include "base/require_option.hpp"

namespace roadbook {
namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

void check_person(const SeenPerson& person) {
  const auto refuse = [](const char* field, double got, const char* want) {
    throw BadInput(Problem{Severity::kError, "", 0, field, std::to_string(got), want});
  };
  if (!person.position.allFinite()) refuse("person.position", NAN, "a finite place");
  if (!(person.sigma_m >= 0.0 && std::isfinite(person.sigma_m)))
    refuse("person.sigma", person.sigma_m, "0 m or more");
  if (!(person.probability >= 0.0 && person.probability <= 1.0))
    refuse("person.probability", person.probability, "0 to 1");
}

// Whether the place is within the reach that the frame states; true where it states none.
bool reaches(const VisitFrame& frame, const Eigen::Vector2d& place) {
  if (frame.reach_m.empty()) return true;
  const Eigen::Vector2d to = place - frame.position;
  const double turn = (std::atan2(to.y(), to.x()) - frame.heading) / (2.0 * std::numbers::pi);
  const auto sectors = static_cast<double>(frame.reach_m.size());
  const auto sector = static_cast<std::size_t>((turn - std::floor(turn)) * sectors);
  return to.norm() <= frame.reach_m[std::min(sector, frame.reach_m.size() - 1)];
}

}  // namespace

void SightOptions::check() const {
  require_option(range_m > 0.0 && range_m <= 1000.0, "range_m", range_m, "above 0, to 1000");
  require_option(person_m > 0.0 && person_m <= 10.0, "person_m", person_m, "above 0, to 10");
  require_option(look_s > 0.0 && look_s <= 1e6, "look_s", look_s, "above 0, to 1e6");
}

void add_sides(const Outline& outline, std::vector<SightBlocker>& blockers) {
  for (std::size_t i = 0; i < outline.size(); ++i)
    blockers.push_back({outline[i], outline[(i + 1) % outline.size()]});
}

bool in_sight(const Eigen::Vector2d& from,
              const Eigen::Vector2d& to,
              const std::vector<SightBlocker>& blockers) {
  const Eigen::Vector2d way = to - from;
  for (const SightBlocker& blocker : blockers) {
    const Eigen::Vector2d side = blocker.b - blocker.a;
    const double area = cross(way, side);
    if (area == 0.0) continue;  // alongside: hides nothing
    const Eigen::Vector2d offset = blocker.a - from;
    const double u = cross(offset, side) / area;
    const double v = cross(offset, way) / area;
    if (u > 0.0 && u < 1.0 && v >= 0.0 && v <= 1.0) return false;
  }
  return true;
}

VisitEvidence gather_evidence(const PresenceGrid& grid,
                              const std::vector<VisitFrame>& frames,
                              const std::vector<SightBlocker>& blockers,
                              const SightOptions& options) {
  options.check();
  VisitEvidence evidence;
  evidence.seen_s.assign(grid.size(), 0.0);
  evidence.person_s.assign(grid.size(), 0.0);
  std::vector<int> nodes;
  std::vector<SightBlocker> near;
  for (const VisitFrame& frame : frames) {
    near.clear();
    for (const SightBlocker& blocker : blockers)
      if (std::min((blocker.a - frame.position).norm(), (blocker.b - frame.position).norm()) <
          options.range_m + (blocker.b - blocker.a).norm())
        near.push_back(blocker);
    const double farthest = frame.reach_m.empty()
                                ? options.range_m
                                : *std::max_element(frame.reach_m.begin(), frame.reach_m.end());
    if (farthest > 0.0)
      grid.nodes_near(frame.position, farthest, nodes);
    else
      nodes.clear();
    for (const int node : nodes) {
      const Eigen::Vector2d& place = grid.centres()[static_cast<std::size_t>(node)];
      if (reaches(frame, place) && in_sight(frame.position, place, near))
        evidence.seen_s[static_cast<std::size_t>(node)] += frame.duration_s;
    }
    for (const SeenPerson& person : frame.people) {
      check_person(person);
      ++(grid.node_at(person.position) ? evidence.people : evidence.people_off_map);
      // One person takes one person's ground, however large the ground on which they may stand.
      const double reach_m = std::hypot(options.person_m, person.sigma_m);
      const double share = options.person_m * options.person_m / (reach_m * reach_m);
      grid.nodes_near(person.position, reach_m, nodes);
      for (const int node : nodes)
        evidence.person_s[static_cast<std::size_t>(node)] +=
            frame.duration_s * person.probability * share;
    }
  }
  return evidence;
}

std::vector<PresenceObservation> observations_of(const PresenceGrid& grid,
                                                 const VisitEvidence& evidence,
                                                 const std::vector<VisitFrame>& frames,
                                                 const SightOptions& options,
                                                 double weight) {
  std::vector<PresenceObservation> observations;
  const PresenceOptions& map = grid.options();
  if (map.literal) {
    for (const VisitFrame& frame : frames)
      for (const SeenPerson& person : frame.people)
        if (const auto node = grid.node_at(person.position))
          observations.push_back({*node, 1.0, 1.0});
    return observations;
  }
  const double full = weight * map.cell_m * map.cell_m / (map.visit_sigma * map.visit_sigma);
  for (std::size_t i = 0; i < grid.size(); ++i) {
    const double someone = -std::expm1(-evidence.person_s[i] / options.look_s);
    const double nobody = -(1.0 - someone) * std::expm1(-evidence.seen_s[i] / options.look_s);
    if (someone > 0.0) observations.push_back({static_cast<int>(i), 1.0, full * someone});
    if (nobody > 0.0) observations.push_back({static_cast<int>(i), 0.0, full * nobody});
  }
  return observations;
}

}  // namespace roadbook
