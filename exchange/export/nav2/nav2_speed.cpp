#include "exchange/export/nav2/nav2_speed.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "base/parallel.hpp"

namespace roadbook {
namespace {

constexpr double kFinest_m = 0.125;  // between points that are asked
constexpr double kChunk_m = 20.0;    // of a lane, worked at at once
constexpr double kSlice_m = 0.5;     // of a chunk: its tube is nearly straight

// What a lane's query says at a point.
struct Asked {
  bool inside = false;
  double s_m = 0.0;
  double speed = 0.0;
  Eigen::Vector2d gradient = Eigen::Vector2d::Zero();  ///< over the plane [1/s]
};

Asked ask(const LaneStrips::Strip& strip, const LaneQuery& query, const Eigen::Vector2d& p) {
  const PathProjection at = strip.frame.project(p);
  if (!at.inside()) return {};
  const auto answer = query.at(at.s_m, at.e_m);
  if (!answer) return {};
  const PathPoint foot = strip.frame.curve().at(at.s_m);
  // At a distance from a bend's centre line, a step along s is longer or shorter.
  const double stretch = std::max(1.0 - foot.curvature * at.e_m, 0.05);
  const Eigen::Vector2d& g = answer->speed.gradient;
  return {true, at.s_m, answer->speed.value, g.x() / stretch * foot.tangent + g.y() * foot.left()};
}

// Lowest of a profile between two places; around the seam of a ring where they lie on both sides.
double least_of_profile(const LaneProfile& profile, double length_m, double from_m, double to_m) {
  if (profile.closed && to_m - from_m > 0.5 * length_m)
    return std::min(least_of_profile(profile, INFINITY, 0.0, from_m),
                    least_of_profile(profile, INFINITY, to_m, length_m));
  double least = std::min(profile.speed_at(from_m), profile.speed_at(to_m));
  for (double k = std::ceil(from_m / profile.step_m); k * profile.step_m < to_m; k += 1.0)
    least = std::min(least, profile.speed_at(k * profile.step_m));
  return least;
}

// Lower bound of the lane's speed over a cell from what was asked at its corners; infinite where
// the lane is not there. Between points h apart a function falls below the lower of them by at most
// a quarter of h times the change of its slope.
double bound_of(const std::array<const Asked*, 4>& corners,
                const LaneProfile& profile,
                double length_m,
                double side_m) {
  double least = INFINITY;
  double from_m = INFINITY;
  double to_m = -INFINITY;
  double change = 0.0;
  double steepest = 0.0;
  int inside = 0;
  for (const Asked* corner : corners) {
    if (!corner->inside) continue;
    ++inside;
    least = std::min(least, corner->speed);
    from_m = std::min(from_m, corner->s_m);
    to_m = std::max(to_m, corner->s_m);
    steepest = std::max(steepest, corner->gradient.norm());
    for (const Asked* other : corners)
      if (other->inside) change = std::max(change, (corner->gradient - other->gradient).norm());
  }
  if (inside == 0) return INFINITY;
  if (inside < 4) {  // the rest of the cell's tube lies beyond the corners
    least -= steepest * side_m;
    from_m = std::max(0.0, from_m - side_m);
    to_m = std::min(length_m, to_m + side_m);
  }
  return std::min(least - 0.25 * side_m * change,
                  least_of_profile(profile, length_m, from_m, to_m));
}

class SpeedCells {
 public:
  SpeedCells(const LaneQueries& queries, const MaskGrid& grid, int num_threads)
      : queries_(queries),
        grid_(grid),
        num_threads_(num_threads),
        parts_(static_cast<int>(std::ceil(grid.place().resolution_m / kFinest_m - 1e-9))),
        side_m_(grid.place().resolution_m / parts_),
        speeds_(grid.cells().size(), INFINITY) {}

  std::vector<float> take() {
    for (const LaneProfile& profile : queries_.speeds().profiles)
      if (const LaneStrips::Strip* strip = queries_.strips().find(profile.lane))
        for (double s = 0.0; s < strip->length_m(); s += kChunk_m)
          add_chunk(*strip, profile, s, std::min(s + kChunk_m, strip->length_m()));
    fill_the_rest();
    return std::move(speeds_);
  }

 private:
  // Cells in the tube of a part of a lane, as marks in a separate grid.
  MaskGrid tube_cells(const LaneStrips::Strip& strip, double from_m, double to_m) const {
    const int slices = static_cast<int>(std::ceil((to_m - from_m) / kSlice_m));
    const double half = strip.half_width_m + side_m_;
    std::vector<PathPoint> points;
    Eigen::AlignedBox2d box;
    for (int i = 0; i <= slices; ++i) {
      points.push_back(strip.frame.curve().at(from_m + (to_m - from_m) * i / slices));
      for (const double e : {-half, half})
        box.extend(points.back().position + e * points.back().left());
    }
    MaskGrid cells(box.min(), box.max(), side_m_);
    for (std::size_t i = 0; i + 1 < points.size(); ++i) {
      const auto corner = [&](const PathPoint& p, double e) -> Eigen::Vector2d {
        return p.position + e * p.left();
      };
      cells.mark({corner(points[i], -half), corner(points[i + 1], -half),
                  corner(points[i + 1], half), corner(points[i], half)},
                 1);
    }
    return cells;
  }

  void add_chunk(const LaneStrips::Strip& strip,
                 const LaneProfile& profile,
                 double from_m,
                 double to_m) {
    const MaskGrid cells = tube_cells(strip, from_m, to_m);
    const RasterPlace& place = cells.place();
    const LaneQuery& query = queries_.of(profile.lane);
    const auto width = static_cast<std::size_t>(place.columns) + 1;
    std::vector<Asked> asked(width * (static_cast<std::size_t>(place.rows) + 1));
    parallel_for_small(asked.size(), num_threads_, [&](std::size_t at) {
      const int column = static_cast<int>(at % width);
      const int row = static_cast<int>(at / width);
      bool needed = false;
      for (const auto& [c, r] :
           {std::pair{column - 1, row - 1}, {column, row - 1}, {column - 1, row}, {column, row}})
        needed = needed || (cells.holds(c, r) && cells.cells()[cells.index(c, r)] != 0);
      if (needed)
        asked[at] =
            ask(strip, query, {place.west_m + column * side_m_, place.north_m - row * side_m_});
    });
    for (int row = 0; row < place.rows; ++row)
      for (int column = 0; column < place.columns; ++column) {
        if (cells.cells()[cells.index(column, row)] == 0) continue;
        const std::size_t at =
            static_cast<std::size_t>(row) * width + static_cast<std::size_t>(column);
        lower(cells.centre(column, row),
              bound_of({&asked[at], &asked[at + 1], &asked[at + width], &asked[at + width + 1]},
                       profile, strip.length_m(), side_m_));
      }
  }

  void lower(const Eigen::Vector2d& p, double speed) {
    const int column = grid_.column_of(p.x());
    const int row = grid_.row_of(p.y());
    if (!grid_.holds(column, row)) return;
    float& cell = speeds_[grid_.index(column, row)];
    cell = std::min(cell, static_cast<float>(speed));
  }

  // Of cells in no tube. One beside a tube may have a corner of it, which no point asked has met.
  void fill_the_rest() {
    const SpeedMap& map = queries_.speeds();
    const std::vector<float> lanes = speeds_;
    std::vector<float> places(speeds_.size(), INFINITY);
    for (const SpeedCell& cell : map.cells) lower_square(cell, map.cell_m, places);
    const RasterPlace& place = grid_.place();
    for (int row = 0; row < place.rows; ++row)
      for (int column = 0; column < place.columns; ++column) {
        const std::size_t at = grid_.index(column, row);
        if (std::isfinite(lanes[at])) continue;
        float speed =
            std::isfinite(places[at]) ? places[at] : static_cast<float>(map.options.min_speed);
        for (int r = row - 1; r <= row + 1; ++r)
          for (int c = column - 1; c <= column + 1; ++c)
            if (grid_.holds(c, r)) speed = std::min(speed, lanes[grid_.index(c, r)]);
        speeds_[at] = speed;
      }
  }

  void lower_square(const SpeedCell& cell, double side_m, std::vector<float>& places) const {
    const double half = 0.5 * side_m - 1e-9;
    const int left = grid_.column_of(cell.centre.x() - half);
    const int right = grid_.column_of(cell.centre.x() + half);
    const int top = grid_.row_of(cell.centre.y() + half);
    const int bottom = grid_.row_of(cell.centre.y() - half);
    for (int row = top; row <= bottom; ++row)
      for (int column = left; column <= right; ++column)
        if (grid_.holds(column, row)) {
          float& speed = places[grid_.index(column, row)];
          speed = std::min(speed, static_cast<float>(cell.speed));
        }
  }

  const LaneQueries& queries_;
  const MaskGrid& grid_;
  int num_threads_;
  int parts_;  ///< of a cell's side, that points asked lie close enough
  double side_m_;
  std::vector<float> speeds_;
};

}  // namespace

std::vector<float> cell_speeds(const LaneQueries& queries, const MaskGrid& grid, int num_threads) {
  return SpeedCells(queries, grid, num_threads).take();
}

}  // namespace roadbook
