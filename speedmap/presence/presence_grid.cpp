#include "speedmap/presence/presence_grid.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/geometry/outline.hpp"
#include "base/require_option.hpp"

namespace roadbook {
namespace {

constexpr signed char kNone = -1;

}  // namespace

void PresenceOptions::check() const {
  require_option(cell_m >= 0.05 && cell_m <= 10.0, "cell_m", cell_m, "0.05 to 10");
  require_option(beside_m >= 0.0 && beside_m <= 100.0, "beside_m", beside_m, "0 to 100");
  require_option(reach_m >= 0.0 && reach_m <= 100.0, "reach_m", reach_m, "0 to 100");
  require_option(visit_sigma > 0.0 && visit_sigma <= 100.0, "visit_sigma", visit_sigma,
                 "above 0, to 100");
  for (const PlacePrior& prior : priors) {
    require_option(prior.presence >= 0.0 && prior.presence <= 1.0, "priors.presence",
                   prior.presence, "0 to 1");
    require_option(prior.sigma > 0.0 && prior.sigma <= 100.0, "priors.sigma", prior.sigma,
                   "above 0, to 100");
  }
}

PresenceGrid::PresenceGrid(const std::vector<GridLane>& lanes,
                           const std::vector<Outline>& spaces,
                           const std::vector<Outline>& crossings,
                           const PresenceOptions& options)
    : options_(options) {
  options_.check();
  std::vector<Outline> outlines = spaces;
  outlines.insert(outlines.end(), crossings.begin(), crossings.end());
  span(lanes, outlines);
  std::vector<signed char> classes(
      static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), kNone);
  for (const GridLane& lane : lanes) paint_lane(lane, classes);
  for (const Outline& space : spaces) paint_outline(space, PlaceClass::kSpace, classes);
  for (const Outline& crossing : crossings) paint_outline(crossing, PlaceClass::kCrossing, classes);
  collect(classes);
}

void PresenceGrid::span(const std::vector<GridLane>& lanes, const std::vector<Outline>& outlines) {
  Eigen::Vector2d low = Eigen::Vector2d::Constant(INFINITY);
  Eigen::Vector2d high = -low;
  const auto take = [&](const Eigen::Vector2d& p, double margin) {
    if (!p.allFinite()) throw InvalidOption("grid", "a point that is not finite", "metres");
    low = low.cwiseMin((p.array() - margin).matrix());
    high = high.cwiseMax((p.array() + margin).matrix());
  };
  for (const GridLane& lane : lanes)
    for (const Eigen::Vector2d& p : lane.centre)
      take(p, std::max(options_.beside_m, 0.5 * lane.width_m));
  for (const Outline& outline : outlines)
    for (const Eigen::Vector2d& p : outline) take(p, 0.0);
  if (!(low.x() <= high.x())) throw InvalidOption("grid", "no lane and no outline", "some");
  // Cells lie on a lattice of the map frame, wherever the lanes end.
  low_ = (low / options_.cell_m).array().floor().matrix() * options_.cell_m;
  const Eigen::Vector2d cells = ((high - low_) / options_.cell_m).array().floor() + 1.0;
  if (!(cells.prod() <= std::exp2(27.0)))
    throw InvalidOption("grid", std::to_string(cells.prod()) + " cells", "at most 2^27");
  columns_ = static_cast<int>(cells.x());
  rows_ = static_cast<int>(cells.y());
}

void PresenceGrid::paint_lane(const GridLane& lane, std::vector<signed char>& classes) const {
  const double reach = std::max(options_.beside_m, 0.5 * lane.width_m);
  for (std::size_t i = 0; i + 1 < lane.centre.size(); ++i) {
    const Eigen::Vector2d& a = lane.centre[i];
    const Eigen::Vector2d& b = lane.centre[i + 1];
    const Eigen::Vector2d low = (a.cwiseMin(b) - low_).array() - reach;
    const Eigen::Vector2d high = (a.cwiseMax(b) - low_).array() + reach;
    const int c0 = std::max(0, static_cast<int>(low.x() / options_.cell_m));
    const int c1 = std::min(columns_ - 1, static_cast<int>(high.x() / options_.cell_m));
    const int r0 = std::max(0, static_cast<int>(low.y() / options_.cell_m));
    const int r1 = std::min(rows_ - 1, static_cast<int>(high.y() / options_.cell_m));
    for (int row = r0; row <= r1; ++row)
      for (int column = c0; column <= c1; ++column) {
        const Eigen::Vector2d centre =
            low_ + options_.cell_m * Eigen::Vector2d(column + 0.5, row + 0.5);
        const double d = distance_to_segment(centre, a, b);
        signed char& now =
            classes[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                    static_cast<std::size_t>(column)];
        if (d <= 0.5 * lane.width_m)
          now = static_cast<signed char>(PlaceClass::kLane);
        else if (d <= reach && now == kNone)
          now = static_cast<signed char>(PlaceClass::kOther);
      }
  }
}

void PresenceGrid::paint_outline(const Outline& outline,
                                 PlaceClass place,
                                 std::vector<signed char>& classes) const {
  if (outline.size() < 3) return;
  Eigen::Vector2d low = outline.front();
  Eigen::Vector2d high = low;
  for (const Eigen::Vector2d& p : outline) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const int c0 = std::max(0, static_cast<int>((low.x() - low_.x()) / options_.cell_m));
  const int c1 = std::min(columns_ - 1, static_cast<int>((high.x() - low_.x()) / options_.cell_m));
  const int r0 = std::max(0, static_cast<int>((low.y() - low_.y()) / options_.cell_m));
  const int r1 = std::min(rows_ - 1, static_cast<int>((high.y() - low_.y()) / options_.cell_m));
  for (int row = r0; row <= r1; ++row)
    for (int column = c0; column <= c1; ++column)
      if (is_inside(outline, low_ + options_.cell_m * Eigen::Vector2d(column + 0.5, row + 0.5)))
        classes[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                static_cast<std::size_t>(column)] = static_cast<signed char>(place);
}

void PresenceGrid::collect(const std::vector<signed char>& classes) {
  node_of_.assign(classes.size(), -1);
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      const std::size_t cell = static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                               static_cast<std::size_t>(column);
      if (classes[cell] == kNone) continue;
      node_of_[cell] = static_cast<int>(centres_.size());
      centres_.push_back(low_ + options_.cell_m * Eigen::Vector2d(column + 0.5, row + 0.5));
      classes_.push_back(static_cast<PlaceClass>(classes[cell]));
    }
  if (centres_.empty()) throw InvalidOption("grid", "no cell", "at least one");
}

PresenceGraph PresenceGrid::graph() const {
  PresenceGraph graph;
  const double area = options_.cell_m * options_.cell_m;
  double sigma2 = 0.0;  // neighbours pull by the mean prior's variance
  for (const PlaceClass place : classes_) {
    const PlacePrior& prior = options_.priors[static_cast<std::size_t>(place)];
    const double weight = options_.literal ? 1.0 : area / (prior.sigma * prior.sigma);
    graph.nodes.push_back({prior.presence, weight});
    sigma2 += prior.sigma * prior.sigma / static_cast<double>(classes_.size());
  }
  // Of the integral of |reach grad x|^2 / sigma^2 over the ground, a square cell's edge has
  // reach^2 / sigma^2 whatever its size. Printed: 1, and every edge counted from both its ends.
  const double pull = options_.literal ? 2.0 : options_.reach_m * options_.reach_m / sigma2;
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column) {
      const int a = node(column, row);
      if (a < 0) continue;
      for (const int b : {node(column + 1, row), node(column, row + 1)})
        if (b >= 0) graph.edges.push_back({a, b, pull});
    }
  return graph;
}

int PresenceGrid::node(int column, int row) const {
  if (column < 0 || row < 0 || column >= columns_ || row >= rows_) return -1;
  return node_of_[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_) +
                  static_cast<std::size_t>(column)];
}

std::optional<int> PresenceGrid::node_at(const Eigen::Vector2d& p) const {
  const Eigen::Vector2d cell = (p - low_) / options_.cell_m;
  if (!(cell.x() >= 0.0 && cell.y() >= 0.0 && cell.x() < columns_ && cell.y() < rows_))
    return std::nullopt;
  const int found = node(static_cast<int>(cell.x()), static_cast<int>(cell.y()));
  return found < 0 ? std::nullopt : std::optional(found);
}

void PresenceGrid::nodes_near(const Eigen::Vector2d& p,
                              double radius_m,
                              std::vector<int>& nodes) const {
  nodes.clear();
  if (!p.allFinite()) return;
  const auto clamped = [](double value, int most) {
    return static_cast<int>(std::clamp(std::floor(value), 0.0, static_cast<double>(most)));
  };
  const Eigen::Vector2d at = (p - low_) / options_.cell_m;
  const double reach = radius_m / options_.cell_m;
  const int c1 = clamped(at.x() + reach, columns_ - 1);
  const int r1 = clamped(at.y() + reach, rows_ - 1);
  for (int row = clamped(at.y() - reach, rows_ - 1); row <= r1; ++row)
    for (int column = clamped(at.x() - reach, columns_ - 1); column <= c1; ++column) {
      const int found = node(column, row);
      if (found >= 0 &&
          (centres_[static_cast<std::size_t>(found)] - p).squaredNorm() <= radius_m * radius_m)
        nodes.push_back(found);
    }
}

}  // namespace roadbook
