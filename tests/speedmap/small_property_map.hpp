#pragma once

#include "speedmap/property_map/property_map.hpp"

namespace roadbook::test {

/// 20 m of road, 6 m wide, a knot every metre.
inline Knots small_knots(bool closed = false) {
  KnotGridOptions grid;
  grid.length_m = 20.0;
  grid.closed = closed;
  grid.e_min_m = -3.0;
  grid.e_max_m = 3.0;
  return Knots::grid(grid);
}

/// Gravel, asphalt, wet.
inline PropertyMapPrior small_prior() {
  PropertyMapPrior prior;
  prior.classes = {"gravel", "asphalt", "wet"};
  prior.counts = {1.0, 5.0, 1.0};
  PropertyPrior friction;
  friction.classes = {{0.6, 1.0, 2.0, 0.01}, {0.9, 1.0, 2.0, 0.01}, {0.4, 1.0, 2.0, 0.01}};
  prior.properties.push_back(friction);
  return prior;
}

inline PropertyMap small_map(const PropertyMapOptions& options, bool closed = false) {
  return {small_knots(closed), small_prior(), options};
}

}  // namespace roadbook::test
