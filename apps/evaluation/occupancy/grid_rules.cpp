#include "apps/evaluation/occupancy/grid_rules.hpp"

#include <limits>

#include "mapping/occupancy/build_patches.hpp"
#include "mapping/occupancy/cell_rules.hpp"
#include "mapping/occupancy/patch_grid.hpp"
#include "mapping/occupancy/reading_dependence.hpp"

namespace roadbook {
namespace {

constexpr double kHandHit = 0.55;
constexpr double kHandMiss = 0.49;

CellShape shape_of_study(const std::vector<RangeScan>& scans, const RuleOptions& options) {
  Eigen::Vector2d least = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d most = -least;
  for (const RangeScan& scan : scans)
    for (const ScanBeam& b : scan.beams) {
      const Eigen::Vector2d end =
          scan.origin + std::min(b.read_m, options.max_m) * b.along.cast<double>();
      least = least.cwiseMin(end).cwiseMin(scan.origin);
      most = most.cwiseMax(end).cwiseMax(scan.origin);
    }
  const double margin = options.cone_rad > 0.0 ? 0.5 * options.max_m : 3.0 * options.cell_m;
  return CellShape::over(least - Eigen::Vector2d::Constant(margin),
                         most + Eigen::Vector2d::Constant(margin), options.cell_m);
}

// Two values for all cells of a beam, as occupancy grids in common use have them.
void add_hand_set(PatchGrid& grid, const RangeScan& scan, const ScanBeam& b, double max_m) {
  const Eigen::Vector2d along = b.along.cast<double>().normalized();
  const double read = std::min(b.read_m, max_m);
  const auto entries = static_cast<std::size_t>(read / grid.cell_m + 1.0);
  const BeamSteps steps(grid, scan.origin, along, grid.cell_m, entries);
  const bool open = is_maximum(read, max_m);
  for (int k = 0; k < steps.count; ++k) {
    const bool last = k + 1 == steps.count && !open;
    OccupancyCell& cell = grid.cells[steps.cell(k)];
    cell.change += static_cast<float>(log_odds(last ? kHandHit : kHandMiss));
    cell.seen += 1.0F;
  }
  count_hit(grid, scan.origin, along, read, max_m);
}

// The grid as the verb makes it.
OccupancyGrid grid_of_patches(const std::vector<RangeScan>& scans,
                              const InverseRangeModel& inverse,
                              double temper,
                              const BuildPatchesOptions& build) {
  const std::vector<PatchAnchor> anchors{{"study", 0, {}}};
  const std::vector<std::size_t> anchor_of(scans.size(), 0);
  auto built = build_patches(scans, anchor_of, anchors, "study", inverse, build);
  const auto pose = [](const std::string&, std::int64_t) {
    return std::optional<PlanePose>(PlanePose{});
  };
  return place_patches(built.patches, pose, {{"study", {temper}}});
}

OccupancyGrid hand_set_grid(const std::vector<RangeScan>& scans, const RuleOptions& options) {
  PatchGrid patch(shape_of_study(scans, options));
  for (const RangeScan& scan : scans)
    for (const ScanBeam& b : scan.beams) add_hand_set(patch, scan, b, options.max_m);
  OccupancyGrid grid;
  grid.shape = patch;
  for (std::size_t i = 0; i < patch.size(); ++i) {
    grid.change.push_back(patch.cells[i].change);
    grid.seen.push_back(static_cast<std::uint32_t>(patch.cells[i].seen));
    grid.hits.push_back(patch.hits[i]);
    grid.effective.push_back(patch.cells[i].seen);
  }
  return grid;
}

}  // namespace

const char* to_text(GridRule rule) {
  switch (rule) {
    case GridRule::kNaive:
      return "naive";
    case GridRule::kHandSet:
      return "hand-set";
    case GridRule::kDerived:
      return "derived";
    case GridRule::kTempered:
      return "derived, tempered";
  }
  return "";
}

const std::vector<GridRule>& all_grid_rules() {
  static const std::vector<GridRule> rules{GridRule::kNaive, GridRule::kHandSet, GridRule::kDerived,
                                           GridRule::kTempered};
  return rules;
}

RuledGrid grid_by_rule(const std::vector<RangeScan>& scans,
                       GridRule rule,
                       const RuleOptions& options,
                       const RangeMixture* given) {
  RuledGrid result;
  if (rule == GridRule::kHandSet) {
    result.grid = hand_set_grid(scans, options);
    return result;
  }
  if (given != nullptr)
    result.mixture = *given;
  else if (rule != GridRule::kNaive)
    result.mixture = fit_beams(scans, options.max_m, options.sigma_m).mixture;
  InverseRangeOptions inverse_options;
  inverse_options.cell_m = options.cell_m;
  inverse_options.surfaces_per_m = surfaces_per_m(scans, options.max_m);
  inverse_options.cone_rad = options.cone_rad;
  const InverseRangeModel inverse(result.mixture, options.max_m, inverse_options);
  if (rule == GridRule::kTempered)
    result.temper = std::max(
        0.001, reading_dependence(scans, result.mixture, inverse, options.cell_m, options.cone_rad)
                   .effective_share);
  BuildPatchesOptions build;
  build.cell_m = options.cell_m;
  build.cone_rad = options.cone_rad;
  if (rule == GridRule::kNaive) build.update = OccupancyUpdate::kNaive;
  result.grid = grid_of_patches(scans, inverse, result.temper, build);
  result.prior_log_odds = rule == GridRule::kNaive ? 0.0 : inverse.prior_log_odds();
  return result;
}

}  // namespace roadbook
