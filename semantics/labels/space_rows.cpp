#include "semantics/labels/space_rows.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <limits>
#include <numbers>

#include "base/require_option.hpp"

namespace roadbook {
namespace {

/// A labelled space at its place in the map.
struct PlacedSpace {
  const Label* label = nullptr;
  int keyframe = 0;
  OrientedBox box;
  Eigen::Vector2d along;              ///< unit vector along the length
  Eigen::Vector2d across;             ///< unit vector to the left of `along`
  double sigma_m = 0.0;               ///< drawing and paint, each coordinate
  double sigma_rad = 0.0;             ///< drawing
  std::array<int, 2> beside{-1, -1};  ///< nearest neighbours across: right, left
};

// The middle is the mean of two ends; each end has sqrt(2) times the middle's standard deviation.
// The heading is the difference of the two ends over the length.
double heading_sigma(const Label& label) { return 2.0 * label.sigma_m / label.length_m; }

std::vector<PlacedSpace> placed_spaces(const Map& map,
                                       const std::vector<Label>& labels,
                                       const SpaceRowOptions& options) {
  std::vector<PlacedSpace> spaces;
  for (const Label& label : labels) {
    if (label.state != LabelState::kActive || label.shape != LabelShape::kBox ||
        label.kind != "parking_space" || !(label.sigma_m > 0.0))
      continue;
    const auto keyframe = keyframe_of(map, label.anchor);
    if (!keyframe) continue;
    PlacedSpace space;
    space.label = &label;
    space.keyframe = *keyframe;
    space.box = *box_in_map(map, label);
    space.along = {std::cos(space.box.heading), std::sin(space.box.heading)};
    space.across = {-space.along.y(), space.along.x()};
    space.sigma_m = std::hypot(label.sigma_m, options.paint.paint_sigma_m);
    space.sigma_rad = heading_sigma(label);
    spaces.push_back(space);
  }
  return spaces;
}

// Of a space's length: from one space of a slanted row to the next, along the spaces.
constexpr double kMostAhead = 0.6;

// Whether b may be at most `max_step` spaces from a in a row: equal depth, equal direction, at its
// side.
bool side_by_side(const PlacedSpace& a, const PlacedSpace& b, const SpaceRowOptions& options) {
  const double turn = std::asin(std::min(1.0, std::abs(a.along.dot(b.across))));
  if (turn > options.max_turn_rad + options.max_sigmas * std::hypot(a.sigma_rad, b.sigma_rad))
    return false;
  const Eigen::Vector2d apart = b.box.centre - a.box.centre;
  const double aside = std::abs(apart.dot(a.across));
  // Slanted rows advance as far ahead as to the side. The row behind lies one length ahead.
  return aside > 0.6 * a.box.width_m && aside < (options.max_step + 0.5) * a.box.width_m &&
         std::abs(apart.dot(a.along)) < kMostAhead * a.box.length_m * aside / a.box.width_m;
}

void find_neighbours(std::vector<PlacedSpace>& spaces, const SpaceRowOptions& options) {
  std::vector<int> order(spaces.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = static_cast<int>(i);
  const auto space = [&](int i) -> PlacedSpace& { return spaces[static_cast<std::size_t>(i)]; };
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return space(a).box.centre.x() < space(b).box.centre.x(); });
  double reach = 0.0;  // of two spaces side by side
  for (const PlacedSpace& s : spaces)
    reach = std::max(
        reach, (options.max_step + 0.5) * std::hypot(s.box.width_m, kMostAhead * s.box.length_m));
  const auto distance = [&](int i, int j) {
    return j < 0 ? std::numeric_limits<double>::max()
                 : (space(i).box.centre - space(j).box.centre).norm();
  };
  const auto consider = [&](int i, int j) {
    PlacedSpace& a = space(i);
    if (!side_by_side(a, space(j), options)) return;
    const bool left = (space(j).box.centre - a.box.centre).dot(a.across) > 0.0;
    int& nearest = a.beside[left ? 1 : 0];
    if (distance(i, j) < distance(i, nearest)) nearest = j;
  };
  for (std::size_t k = 0; k < order.size(); ++k)
    for (std::size_t l = k + 1; l < order.size(); ++l) {
      if (space(order[l]).box.centre.x() - space(order[k]).box.centre.x() > reach) break;
      consider(order[k], order[l]);
      consider(order[l], order[k]);
    }
}

using Chain = std::vector<const PlacedSpace*>;

// Chains of spaces that are each other's nearest neighbours, from end to end. A ring of spaces has
// no end and gives no chain.
std::vector<Chain> chains(const std::vector<PlacedSpace>& spaces) {
  const auto space = [&](int i) -> const PlacedSpace& {
    return spaces[static_cast<std::size_t>(i)];
  };
  const auto linked = [&](int i, int side) {
    const int j = space(i).beside[static_cast<std::size_t>(side)];
    return j >= 0 && (space(j).beside[0] == i || space(j).beside[1] == i) ? j : -1;
  };
  std::vector<std::uint8_t> seen(spaces.size(), 0);
  std::vector<Chain> all;
  for (int i = 0; i < static_cast<int>(spaces.size()); ++i) {
    if (seen[static_cast<std::size_t>(i)] != 0 || (linked(i, 0) >= 0 && linked(i, 1) >= 0))
      continue;
    Chain chain;
    for (int here = i; here >= 0;) {
      seen[static_cast<std::size_t>(here)] = 1;
      chain.push_back(&space(here));
      const auto fresh = [&](int j) { return j >= 0 && seen[static_cast<std::size_t>(j)] == 0; };
      const int right = linked(here, 0);
      const int left = linked(here, 1);
      here = fresh(right) ? right : fresh(left) ? left : -1;
    }
    all.push_back(std::move(chain));
  }
  return all;
}

double usual_step_m(const Chain& chain) {
  std::vector<double> steps;
  for (std::size_t i = 1; i < chain.size(); ++i)
    steps.push_back((chain[i]->box.centre - chain[i - 1]->box.centre).norm());
  const auto middle = steps.begin() + static_cast<std::ptrdiff_t>((steps.size() - 1) / 2);
  std::nth_element(steps.begin(), middle, steps.end());
  return *middle;
}

/// A space in a row under construction.
struct Member {
  const PlacedSpace* space;
  int steps;
};

// The next place that the last few members predict, and its standard deviation in each coordinate.
// The prediction is a line fitted over the steps.
struct Lead {
  Eigen::Vector2d place;
  double sigma_m;
};
Lead lead_of(const std::vector<Member>& row, int steps) {
  constexpr std::size_t kLast = 6;
  const auto first = row.end() - static_cast<std::ptrdiff_t>(std::min(kLast, row.size()));
  const auto n = static_cast<double>(row.end() - first);
  double mean = 0.0;
  double variance = 0.0;
  Eigen::Vector2d middle = Eigen::Vector2d::Zero();
  for (auto m = first; m != row.end(); ++m) {
    mean += m->steps / n;
    middle += m->space->box.centre / n;
    variance += m->space->sigma_m * m->space->sigma_m / n;
  }
  double spread = 0.0;
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();
  for (auto m = first; m != row.end(); ++m) {
    spread += (m->steps - mean) * (m->steps - mean);
    slope += (m->steps - mean) * (m->space->box.centre - middle);
  }
  const double from_mean = steps - mean;
  return {middle + from_mean / spread * slope,
          std::sqrt(variance * (1.0 / n + from_mean * from_mean / spread))};
}

// Number of steps from the row's last member to the space; 0 if the space does not lie at the
// predicted place.
int steps_to(const std::vector<Member>& row,
             const PlacedSpace& next,
             double step_m,
             const SpaceRowOptions& options) {
  const Member& last = row.back();
  const double apart = (next.box.centre - last.space->box.centre).norm();
  const int steps = static_cast<int>(std::lround(apart / step_m));
  if (steps < 1 || steps > options.max_step) return 0;
  if (row.size() == 1)  // the direction of the row is not known yet
    return std::abs(apart - steps * step_m) <=
                   options.max_sigmas * std::hypot(last.space->sigma_m, next.sigma_m)
               ? steps
               : 0;
  const Lead lead = lead_of(row, last.steps + steps);
  // Two coordinates: 3 sigma of one coordinate has the same tail probability as 3.4 sigma of a
  // distance.
  constexpr double kPlanar = 1.15;
  return (next.box.centre - lead.place).norm() <=
                 kPlanar * options.max_sigmas * std::hypot(lead.sigma_m, next.sigma_m)
             ? steps
             : 0;
}

// Splits a chain into successive rows. A row may pass over a few spaces that lie elsewhere.
std::vector<std::vector<Member>> stretches(const Chain& chain, const SpaceRowOptions& options) {
  const double step_m = usual_step_m(chain);
  std::vector<std::vector<Member>> rows;
  std::deque<const PlacedSpace*> left(chain.begin(), chain.end());
  while (!left.empty()) {
    std::vector<Member> row{{left.front(), 0}};
    std::size_t used = 1;
    for (std::size_t i = 1;
         i < left.size() && i < used + static_cast<std::size_t>(options.max_step); ++i) {
      const int steps = steps_to(row, *left[i], step_m, options);
      if (steps == 0) continue;
      row.push_back({left[i], row.back().steps + steps});
      used = i + 1;
    }
    left.erase(left.begin(), left.begin() + static_cast<std::ptrdiff_t>(used));
    if (row.size() >= options.min_spaces) rows.push_back(std::move(row));
  }
  return rows;
}

// Turns a label by half a turn if it was drawn in the direction opposite to the first label.
RowSpace row_space(const Map& map, const Member& member, const Eigen::Vector2d& along) {
  const Label& label = *member.space->label;
  RowSpace space;
  space.steps = member.steps;
  Eigen::Isometry3d T = label.T_vehicle_label;
  if (member.space->along.dot(along) < 0.0)
    T.rotate(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitZ()));
  space.views.push_back({member.space->keyframe, T, label.sigma_m, member.space->sigma_rad});
  const Eigen::Isometry3d T_map_space = map.T_map_vehicle(member.space->keyframe) * T;
  for (const LabelSighting& sighting : label.sightings) {
    const auto keyframe = keyframe_of(map, sighting.anchor);
    if (!keyframe) continue;
    Eigen::Isometry3d T_seen = map.T_map_vehicle(*keyframe).inverse() * T_map_space;
    T_seen.translation() = sighting.middle_vehicle;
    space.views.push_back({*keyframe, T_seen, sighting.sigma_m, 0.0});
  }
  return space;
}

}  // namespace

void SpaceRowOptions::check() const {
  paint.check();
  require_option(min_spaces >= 3, "min_spaces", static_cast<double>(min_spaces), "at least 3");
  require_option(min_share >= 0.0 && min_share <= 1.0, "min_share", min_share, "0 to 1");
  require_option(max_step >= 1, "max_step", max_step, "at least 1");
  require_option(max_sigmas > 0.0, "max_sigmas", max_sigmas, "above 0");
  require_option(max_turn_rad > 0.0, "max_turn_rad", max_turn_rad, "above 0");
}

std::vector<EqualRow> space_rows(const Map& map,
                                 const std::vector<Label>& labels,
                                 const SpaceRowOptions& options) {
  options.check();
  std::vector<PlacedSpace> spaces = placed_spaces(map, labels, options);
  find_neighbours(spaces, options);
  std::vector<EqualRow> rows;
  for (const Chain& chain : chains(spaces)) {
    if (chain.size() < options.min_spaces) continue;
    const auto found = stretches(chain, options);
    std::size_t members = 0;
    for (const auto& row : found) members += row.size();
    if (static_cast<double>(members) < options.min_share * static_cast<double>(chain.size()))
      continue;
    for (const auto& row : found) {
      EqualRow equal;
      for (const Member& member : row)
        equal.spaces.push_back(row_space(map, member, row.front().space->along));
      rows.push_back(std::move(equal));
    }
  }
  return rows;
}

}  // namespace roadbook
