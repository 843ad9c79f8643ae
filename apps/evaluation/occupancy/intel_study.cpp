#include "apps/evaluation/occupancy/intel_study.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "apps/evaluation/occupancy/grid_rules.hpp"
#include "apps/evaluation/occupancy/occupancy_pictures.hpp"
#include "base/cell_grid.hpp"
#include "base/error.hpp"
#include "base/median.hpp"
#include "base/text.hpp"
#include "drive/csv.hpp"

namespace roadbook {
namespace {

constexpr double kIntelMax_m = 81.83;
constexpr std::size_t kIntelBeams = 180;

// Scans at the poses in columns `x`, x + 1 and x + 2.
std::vector<RangeScan> read_scans(const std::filesystem::path& table, std::size_t x) {
  constexpr std::size_t kFirstBeam = 7;
  std::vector<RangeScan> scans;
  ProblemList problems;
  LineReader lines(table);
  while (const auto line = lines.next()) {
    if (lines.line() == 1) continue;
    const auto fields = split(*line);
    std::vector<double> numbers;
    for (const auto field : fields)
      if (const auto number = parse_double(field)) numbers.push_back(*number);
    if (numbers.size() != kFirstBeam + kIntelBeams)
      throw BadInput({Severity::kError, table.string(), lines.line(), "columns",
                      std::to_string(numbers.size()) + " numbers",
                      "187: time, two poses, 180 ranges (intel_scans.csv)"});
    RangeScan scan;
    scan.t_ns = std::llround(1e9 * (numbers[0] - 976000000.0));
    scan.origin = {numbers[x], numbers[x + 1]};
    for (std::uint32_t b = 0; b < kIntelBeams; ++b) {
      const double a = numbers[x + 2] + (b - 90.0) * std::numbers::pi / 180.0;
      scan.beams.push_back({b, Eigen::Vector2d(std::cos(a), std::sin(a)).cast<float>(),
                            std::min(numbers[kFirstBeam + b], kIntelMax_m)});
    }
    scans.push_back(std::move(scan));
  }
  if (scans.empty())
    throw BadInput({Severity::kError, table.string(), 0, "scans", "none", "intel_scans.csv"});
  return scans;
}

double wall_thickness_m(const std::vector<RangeScan>& scans) {
  constexpr double kCell_m = 0.5;
  constexpr double kNear_m = 15.0;
  struct Ends {
    double count = 0.0;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  };
  std::map<GridCell<2>, Ends> cells;
  for (const RangeScan& scan : scans)
    for (const ScanBeam& b : scan.beams) {
      if (b.read_m > kNear_m) continue;
      const Eigen::Vector2d end = scan.origin + b.read_m * b.along.cast<double>();
      Ends& cell = cells[cell_at<2>(end, kCell_m)];
      cell.count += 1.0;
      cell.sum += end;
      cell.squares += end * end.transpose();
    }
  std::vector<double> widths;
  for (const auto& [where, cell] : cells) {
    if (cell.count < 40.0) continue;
    const Eigen::Vector2d mean = cell.sum / cell.count;
    const Eigen::Matrix2d C = cell.squares / cell.count - mean * mean.transpose();
    const Eigen::Vector2d v = Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(C).eigenvalues();
    // A wall runs through the cell: the ends are spread along it as far as it is long.
    if (v[1] > 0.1 * kCell_m * 0.1 * kCell_m && v[0] >= 0.0)
      widths.push_back(std::sqrt(12.0 * v[0]));
  }
  return widths.empty() ? 0.0 : median(widths);
}

RangeMixture hand_set() {
  // AMCL: z_hit, z_short, z_max, z_rand = 0.5, 0.05, 0.05, 0.5 with a sum of 1.1, normalised;
  // sigma_hit 0.2, lambda_short 0.1.
  RangeMixture m = mixture_of({0.05 / 1.1, 0.05 / 1.1, 0.5 / 1.1, 0.1}, 0.2);
  return m;
}

std::size_t occupied_cells(const RuledGrid& ruled) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < ruled.grid.seen.size(); ++i)
    count += ruled.grid.seen[i] > 0 &&
                     ruled.grid.probability(i, ruled.prior_log_odds) > kOccupiedProbability
                 ? 1U
                 : 0U;
  return count;
}

}  // namespace

IntelStudy study_intel(const std::filesystem::path& table, const std::filesystem::path& out) {
  const auto corrected = read_scans(table, 4);
  const auto raw = read_scans(table, 1);
  IntelStudy study;
  study.scans = corrected.size();
  std::vector<BeamSample> even, odd;
  const std::vector<BeamSample> all = expected_samples(corrected, kIntelMax_m);
  std::size_t scan = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (i > 0 && all[i].t_s != all[i - 1].t_s) ++scan;
    (scan % 2 == 0 ? even : odd).push_back(all[i]);
  }
  study.samples = all.size();
  RangeFitOptions options;
  options.parts = {true, true, true, false};
  options.starts = 5;
  options.to_the_maximum = true;
  options.block_s = 5.0;
  study.fitted = fit_range_mixture(all, kIntelMax_m, options);
  const RangeMixture half = fit_range_mixture(even, kIntelMax_m, options);
  RangeMixture naive = mixture_of({}, half.sigma_m);
  study.fitted_nats = mean_log_density(odd, kIntelMax_m, half);
  study.hand_set_nats = mean_log_density(odd, kIntelMax_m, hand_set());
  study.naive_nats = mean_log_density(odd, kIntelMax_m, naive);
  study.thickness_corrected_m = wall_thickness_m(corrected);
  study.thickness_raw_m = wall_thickness_m(raw);
  const RuleOptions rule{.max_m = kIntelMax_m};
  const RuledGrid by_corrected = grid_by_rule(corrected, GridRule::kTempered, rule);
  const RuledGrid by_raw = grid_by_rule(raw, GridRule::kTempered, rule);
  study.occupied_corrected = occupied_cells(by_corrected);
  study.occupied_raw = occupied_cells(by_raw);
  write_grid_pictures(out / "intel.png", {{"corrected poses", by_corrected}, {"odometry", by_raw}},
                      2);
  return study;
}

}  // namespace roadbook
