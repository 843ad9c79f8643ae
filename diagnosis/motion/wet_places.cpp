#include "diagnosis/motion/wet_places.hpp"

#include <algorithm>
#include <cmath>

#include "base/cell_grid.hpp"
#include "diagnosis/streams/motion_effects.hpp"

namespace roadbook {
namespace {

constexpr double kBetweenPlaces_m = 2.0;

Candidate wet_place(const MotionState& at) {
  Candidate place;
  place.kind = CandidateKind::kPlace;
  place.name = kWetPatch;
  place.unit = declaration_of(kWetPatch).unit;
  place.tau = declaration_of(kWetPatch).plausible;
  place.place_x = at.x;
  place.place_y = at.y;
  place.place_heading = at.heading;
  place.place_radius = kPuddleRadius_m;
  return place;
}

// Both ends of the disc a quarter or half of a metre further in or out.
std::vector<Candidate> slightly_moved(const Candidate& place) {
  constexpr double kStep = 0.25;  // [m]
  constexpr int kDiscSteps = 2;
  std::vector<Candidate> moved;
  for (int begin = -kDiscSteps; begin <= kDiscSteps; ++begin)
    for (int end = -kDiscSteps; end <= kDiscSteps; ++end) {
      const double along = 0.5 * kStep * (begin + end);
      Candidate c = place;
      c.place_x += along * std::cos(place.place_heading);
      c.place_y += along * std::sin(place.place_heading);
      c.place_radius += 0.5 * kStep * (end - begin);
      if (c.place_radius > kStep) moved.push_back(c);
    }
  return moved;
}

}  // namespace

std::vector<Candidate> wet_places(const Trajectory& trajectory) {
  const Trajectory smooth = smoothed(trajectory);
  std::vector<Candidate> places;
  CellGrid<std::size_t> known(kBetweenPlaces_m);
  double last = -1e9;
  for (std::size_t j = 0; j < smooth.knots(); ++j) {
    const MotionState s = smooth.after(std::min(j, smooth.knots() - 2), 0.0);
    if (s.distance_m - last < kBetweenPlaces_m) continue;
    last = s.distance_m;
    bool near = false;
    known.visit_near({s.x, s.y}, [&](std::size_t i) {
      near = near ||
             std::hypot(places[i].place_x - s.x, places[i].place_y - s.y) < 0.7 * kBetweenPlaces_m;
    });
    if (near) continue;
    known.insert({s.x, s.y}, places.size());
    places.push_back(wet_place(s));
  }
  for (Candidate& p : places) p.penalty = std::log(static_cast<double>(places.size()));
  return places;
}

std::vector<Candidate> places_near(const Observations& obs,
                                   const MotionPoint& point,
                                   const Candidate& place) {
  std::vector<Candidate> near = slightly_moved(place);
  const auto first = static_cast<std::ptrdiff_t>(near.size());
  for (const PoseSample& p : obs.poses) {
    const double away = std::hypot(p.x - place.place_x, p.y - place.place_y);
    const bool tried = std::any_of(near.begin() + first, near.end(), [&](const Candidate& c) {
      return std::hypot(c.place_x - p.x, c.place_y - p.y) < 0.25 * kBetweenPlaces_m;
    });
    if (away > 1.5 * kBetweenPlaces_m || tried) continue;
    const MotionState s = point.trajectory.at(p.t_s);
    for (const double radius : {1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0}) {
      Candidate c = place;
      c.place_x = s.x;
      c.place_y = s.y;
      c.place_heading = s.heading;
      c.place_radius = radius;
      near.push_back(c);
    }
  }
  return near;
}

}  // namespace roadbook
