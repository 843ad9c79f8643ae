#include "mapping/occupancy/build_patches.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "base/parallel.hpp"
#include "base/require_option.hpp"
#include "mapping/occupancy/cell_rules.hpp"
#include "mapping/occupancy/known_surfaces.hpp"
#include "mapping/occupancy/patch_grid.hpp"

namespace roadbook {
namespace {

constexpr float kCertain = 12.0F;  // log odds of a cell that the naive rule is sure of

// Ranges [first, last) of scans that belong to one patch.
std::vector<std::pair<std::size_t, std::size_t>> groups_of(std::span<const RangeScan> scans,
                                                           double patch_m) {
  constexpr double kGap_m = 2.0;
  std::vector<std::pair<std::size_t, std::size_t>> groups;
  double driven = 0.0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const double step = i > 0 ? (scans[i].origin - scans[i - 1].origin).norm() : 0.0;
    driven += step;
    if (groups.empty() || driven >= patch_m || step > kGap_m) {
      groups.emplace_back(i, i);
      driven = 0.0;
    }
    groups.back().second = i + 1;
  }
  return groups;
}

CellShape shape_of(std::span<const RangeScan> scans,
                   const InverseRangeModel& inverse,
                   const BuildPatchesOptions& options) {
  Eigen::Vector2d least = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d most = -least;
  const auto hold = [&](const Eigen::Vector2d& p, double margin) {
    least = least.cwiseMin(p.array().matrix() - Eigen::Vector2d::Constant(margin));
    most = most.cwiseMax(p.array().matrix() + Eigen::Vector2d::Constant(margin));
  };
  for (const RangeScan& scan : scans) {
    hold(scan.origin, options.cell_m);
    for (const ScanBeam& b : scan.beams) {
      const double reach = std::min(b.read_m, inverse.max_m()) + 2.0 * options.cell_m;
      hold(scan.origin + reach * b.along.cast<double>(),
           reach * std::sin(std::min(0.5 * options.cone_rad, 1.57)) + options.cell_m);
    }
  }
  return CellShape::over(least, most, options.cell_m);
}

// The ratio form of the Bayes filter on one beam.
std::size_t add_ratio(PatchGrid& grid,
                      std::vector<double>& ratios,
                      const Eigen::Vector2d& origin,
                      const Eigen::Vector2d& along,
                      double read_m,
                      double limit_m,
                      const InverseRangeModel& inverse) {
  const double chord = grid.cell_m / along.cwiseAbs().maxCoeff();
  const auto row = row_until(inverse, read_m, limit_m, chord);
  const BeamSteps steps(grid, origin, along, inverse.step_m(), row.size());
  const double prior = inverse.prior();
  for (int k = 0; k < steps.count; ++k) {
    const std::size_t i = steps.cell(k);
    const float change = row[static_cast<std::size_t>((steps.entry + k * steps.entry_slope) >> 16)];
    const double p = probability_of(inverse.prior_log_odds() + static_cast<double>(change));
    ratios[i] = ratio_update(ratios[i], p, prior);
    grid.cells[i].change = static_cast<float>(std::log(ratios[i]) - inverse.prior_log_odds());
    grid.cells[i].seen += 1.0F;
  }
  if (limit_m >= read_m) count_hit(grid, origin, along, read_m, inverse.max_m());
  return static_cast<std::size_t>(steps.count);
}

// One reading of a wide beam of full angle `cone_rad`, for which `inverse` was made: every cell of
// the sector is changed once.
std::size_t add_cone(PatchGrid& grid,
                     const Eigen::Vector2d& origin,
                     const Eigen::Vector2d& along,
                     double cone_rad,
                     double read_m,
                     const InverseRangeModel& inverse,
                     const KnownSurfaces* known) {
  std::optional<ConeLimits> limits;
  if (known != nullptr) limits.emplace(*known, grid, origin, along, cone_rad, read_m);
  const auto row = inverse.changes(read_m, grid.cell_m);
  std::size_t changed = 0;
  for_each_cone_cell(grid, origin, along, cone_rad, inverse.step_m(), row.size(),
                     [&](std::size_t index, std::size_t entry) {
                       if (limits && !limits->holds(grid.middle(index))) return;
                       grid.cells[index].change += row[entry];
                       grid.cells[index].seen += 1.0F;
                       ++changed;
                     });
  if (known == nullptr || known->limit_m(origin, along, read_m) >= read_m)
    count_hit(grid, origin, along, read_m, inverse.max_m());
  return changed;
}

std::size_t add_one(PatchGrid& grid,
                    std::vector<double>& ratios,
                    const Eigen::Vector2d& origin,
                    const ScanBeam& b,
                    const KnownSurfaces* known,
                    const InverseRangeModel& inverse,
                    const BuildPatchesOptions& options) {
  const Eigen::Vector2d along = b.along.cast<double>().normalized();
  const double read = std::min(b.read_m, inverse.max_m());
  if (options.update == OccupancyUpdate::kNaive)
    return add_naive(grid, origin, along, read, inverse.max_m(), kCertain);
  if (options.cone_rad > 0.0)
    return add_cone(grid, origin, along, options.cone_rad, read, inverse, known);
  const double limit = known != nullptr ? known->limit_m(origin, along, read) : INFINITY;
  if (options.update == OccupancyUpdate::kBayes)
    return add_ratio(grid, ratios, origin, along, read, limit, inverse);
  return add_beam(grid, origin, along, read, limit, inverse);
}

std::size_t add_scans(PatchGrid& grid,
                      std::span<const RangeScan> scans,
                      const KnownSurfaces* known,
                      const InverseRangeModel& inverse,
                      const BuildPatchesOptions& options) {
  std::vector<double> ratios;
  if (options.update == OccupancyUpdate::kBayes)
    ratios.assign(grid.size(), inverse.prior() / (1.0 - inverse.prior()));
  std::size_t updates = 0;
  for (const RangeScan& scan : scans)
    for (const ScanBeam& b : scan.beams)
      updates += add_one(grid, ratios, scan.origin, b, known, inverse, options);
  return updates;
}

// Two passes: the first finds the surfaces, the second keeps what beams say in front of them.
std::size_t fill_grid(PatchGrid& grid,
                      std::span<const RangeScan> scans,
                      const InverseRangeModel& inverse,
                      const BuildPatchesOptions& options) {
  if (options.update == OccupancyUpdate::kNaive)
    return add_scans(grid, scans, nullptr, inverse, options);
  PatchGrid first(grid);
  std::size_t updates = add_scans(first, scans, nullptr, inverse, options);
  const KnownSurfaces known(first, inverse.prior_log_odds(), options.cone_rad);
  return updates + add_scans(grid, scans, &known, inverse, options);
}

}  // namespace

void BuildPatchesOptions::check() const {
  require_option(cell_m >= 0.01 && cell_m <= 2.0, "cell_m", cell_m, "0.01 to 2");
  require_option(patch_m >= 0.1 && patch_m <= 500.0, "patch_m", patch_m, "0.1 to 500");
  require_option(cone_rad >= 0.0 && cone_rad <= 1.6, "cone_rad", cone_rad, "0 to 1.6");
}

OccupancyPatch cropped_patch(const PatchGrid& grid) {
  int low_c = grid.columns, low_r = grid.rows, high_c = -1, high_r = -1;
  for (int r = 0; r < grid.rows; ++r)
    for (int c = 0; c < grid.columns; ++c) {
      if (grid.cells[grid.index(c, r)].seen == 0.0F) continue;
      low_c = std::min(low_c, c);
      high_c = std::max(high_c, c);
      low_r = std::min(low_r, r);
      high_r = r;
    }
  OccupancyPatch patch;
  patch.cell_m = grid.cell_m;
  if (high_c < 0) return patch;
  patch.columns = high_c - low_c + 1;
  patch.rows = high_r - low_r + 1;
  patch.placed = {grid.low.x() + low_c * grid.cell_m, grid.low.y() + low_r * grid.cell_m, 0.0};
  const auto counted = [](auto n) {
    return static_cast<std::uint16_t>(std::min<std::int64_t>(static_cast<std::int64_t>(n), 65535));
  };
  for (int r = low_r; r <= high_r; ++r)
    for (int c = low_c; c <= high_c; ++c) {
      const std::size_t i = grid.index(c, r);
      const double units = std::round(static_cast<double>(grid.cells[i].change) / kLogOddsUnit);
      patch.log_odds.push_back(static_cast<std::int16_t>(std::clamp(units, -32000.0, 32000.0)));
      patch.seen.push_back(counted(grid.cells[i].seen));
      patch.hits.push_back(counted(grid.hits[i]));
      const Eigen::Vector2d mean =
          grid.ends[i].cast<double>() / std::max(1.0, static_cast<double>(grid.hits[i]));
      patch.ends.push_back(grid.hits[i] > 0 ? packed_end(mean) : 0);
    }
  return patch;
}

void hang_on(const PatchAnchor& anchor, OccupancyPatch& patch) {
  patch.session = anchor.session;
  patch.t_ns = anchor.t_ns;
  patch.vehicle_patch = plane_pose(
      Eigen::Isometry2d(anchor.map_vehicle.isometry().inverse() * patch.placed.isometry()));
}

BuiltPatches build_patches(std::span<const RangeScan> scans,
                           std::span<const std::size_t> anchor_of,
                           const std::vector<PatchAnchor>& anchors,
                           const std::string& drive,
                           const InverseRangeModel& inverse,
                           const BuildPatchesOptions& options) {
  options.check();
  const auto groups = groups_of(scans, options.patch_m);
  std::vector<OccupancyPatch> patches(groups.size());
  std::vector<std::size_t> updates(groups.size(), 0);
  parallel_for(groups.size(), options.num_threads, [&](std::size_t g) {
    const auto [first, last] = groups[g];
    const auto own = scans.subspan(first, last - first);
    PatchGrid grid(shape_of(own, inverse, options));
    updates[g] = fill_grid(grid, own, inverse, options);
    OccupancyPatch& patch = patches[g];
    patch = cropped_patch(grid);
    hang_on(anchors[anchor_of[first + (last - first) / 2]], patch);
    patch.drive = drive;
    patch.begin_ns = own.front().t_ns;
    patch.end_ns = own.back().t_ns;
  });
  BuiltPatches built;
  for (const std::size_t u : updates) built.updates += u;
  for (OccupancyPatch& patch : patches)
    if (patch.columns > 0) built.patches.push_back(std::move(patch));
  return built;
}

}  // namespace roadbook
