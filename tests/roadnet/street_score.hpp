#pragma once

#include <Eigen/Core>
#include <vector>

namespace roadbook::test {

// How a road network found from tracks compares with a street map: the geometric measure of the
// field (Liu, Biagioni, Eriksson, Wang, Forman and Zhu, KDD 2012: both networks are sampled and the
// samples matched by distance and direction), on the streets that were driven. Which streets were
// driven is found by matching the tracks to the street map with a hidden Markov model (Newson and
// Krumm 2009). Nothing here uses the code under test.

struct Street {
  int a = 0;  ///< place at its beginning
  int b = 0;
  double length_m = 0.0;
};

struct StreetMap {
  std::vector<Eigen::Vector2d> places;
  std::vector<Street> streets;               ///< straight
  std::vector<std::vector<int>> streets_at;  ///< of each place

  int add_place(const Eigen::Vector2d& at);
  int add_street(int a, int b);
};

/// One track: positions [m] in driving order.
using Track = std::vector<Eigen::Vector2d>;

/// Number of tracks for every street and every 5 m along it.
using DrivenTimes = std::vector<std::vector<int>>;

/// All zero.
[[nodiscard]] DrivenTimes not_driven(const StreetMap& map);

/// Matches full-rate tracks to the map: states are places on streets within 60 m, the standard
/// deviation of a position is 15 m, a way that differs from the straight distance by 20 m is e
/// times less probable. A track counts once a street.
[[nodiscard]] DrivenTimes driven_times(const StreetMap& map, const std::vector<Track>& tracks);

struct StreetScore {
  double precision = 0.0;         ///< share of the network's length that is a street
  double precision_driven = 0.0;  ///< share of it that is a street driven at all
  double recall = 0.0;            ///< share of the streets driven often enough that is found
  double found_km = 0.0;
  double wanted_km = 0.0;
};

/// Samples every 5 m; two samples match within `near_m` and 30 degrees of direction, in either
/// sense. Wanted are the streets that at least `times` tracks went by.
[[nodiscard]] StreetScore score_streets(const std::vector<Track>& network,
                                        const StreetMap& map,
                                        const DrivenTimes& driven,
                                        int times,
                                        double near_m);

}  // namespace roadbook::test
