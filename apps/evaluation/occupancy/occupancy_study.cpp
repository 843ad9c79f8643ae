#include "apps/evaluation/occupancy/occupancy_study.hpp"

#include "apps/evaluation/occupancy/occupancy_pictures.hpp"
#include "apps/evaluation/occupancy/simulated_scans.hpp"
#include "base/whole_file.hpp"

namespace roadbook {
namespace {

class CaseTable {
 public:
  CaseTable(const SimulatedScans& drive, const RuleOptions& rules) : drive_(drive), rules_(rules) {}

  OccupancyCase add(const std::string& sensor,
                    const std::string& rule,
                    const RuledGrid& ruled,
                    std::vector<OccupancyCase>& cases) const {
    OccupancyCase one;
    one.sensor = sensor;
    one.rule = rule;
    one.temper = ruled.temper;
    const TrueCells truth = true_cells(ruled.grid.shape, drive_.surfaces);
    one.score = score_occupancy(ruled.grid, ruled.prior_log_odds, truth);
    const OccupancyTrails trails =
        score_trails(ruled.grid, ruled.prior_log_odds, truth, drive_.walked);
    one.crossed = trails.crossed;
    one.trails = trails.called_occupied;
    cases.push_back(one);
    return one;
  }
  // All rules on the same scans, with a picture.
  void compare(const std::string& sensor,
               const std::vector<RangeScan>& scans,
               const std::filesystem::path& out,
               std::vector<OccupancyCase>& cases) const {
    std::vector<NamedGrid> grids;
    for (const GridRule rule : all_grid_rules()) {
      grids.push_back({sensor + ": " + to_text(rule), grid_by_rule(scans, rule, rules_)});
      (void)add(sensor, to_text(rule), grids.back().grid, cases);
    }
    write_grid_pictures(out / (sensor + ".png"), grids, 2);
  }

 private:
  const SimulatedScans& drive_;
  RuleOptions rules_;
};

void study_wide_beams(const SimulatedScans& drive,
                      const OccupancyStudyOptions& options,
                      const std::filesystem::path& out,
                      std::vector<OccupancyCase>& cases) {
  constexpr double kCone_rad = 0.44;  // 25 degrees
  constexpr double kWideMax_m = 5.0;
  constexpr double kWideSigma_m = 0.03;
  const BeamMixture shares{0.03, 0.03, 0.02, 0.5};
  const auto scans = wide_scans(drive, kCone_rad, kWideMax_m, kWideSigma_m, shares, options.seed,
                                options.num_threads);
  const RangeMixture mixture = mixture_of(shares, kWideSigma_m);
  const RuleOptions ray{.max_m = kWideMax_m, .sigma_m = kWideSigma_m};
  RuleOptions cone = ray;
  cone.cone_rad = kCone_rad;
  const CaseTable table(drive, ray);
  std::vector<NamedGrid> grids{
      {"wide beams taken for rays", grid_by_rule(scans, GridRule::kDerived, ray, &mixture)},
      {"wide beams as cones", grid_by_rule(scans, GridRule::kDerived, cone, &mixture)},
      {"wide beams as cones, tempered", grid_by_rule(scans, GridRule::kTempered, cone, &mixture)}};
  for (const NamedGrid& grid : grids) (void)table.add("wide beams", grid.name, grid.grid, cases);
  write_grid_pictures(out / "wide.png", grids, 3);
}

// People cross the lane while the car drives by, with Gaussian noise: what they leave in the
// grid.
void study_people(const SimulatedScansOptions& simulated,
                  const std::filesystem::path& out,
                  const Progress& progress,
                  std::vector<OccupancyCase>& cases) {
  SimulatedScansOptions visit = simulated;
  visit.place = "zurich";
  visit.effects.clear();
  visit.visit = 1;
  const SimulatedScans crossed = simulate_scans(out / "drive_people", visit, progress);
  const RuleOptions rules{.max_m = crossed.max_m};
  const CaseTable table(crossed, rules);
  for (const GridRule rule : {GridRule::kNaive, GridRule::kTempered})
    (void)table.add("people", to_text(rule), grid_by_rule(crossed.scans, rule, rules), cases);
}

}  // namespace

std::vector<OccupancyCase> study_occupancy(const std::filesystem::path& out,
                                           const OccupancyStudyOptions& options,
                                           const Progress& progress) {
  SimulatedScansOptions simulated;
  simulated.place = options.place;
  simulated.size = options.size;
  simulated.seed = options.seed;
  simulated.num_threads = options.num_threads;
  std::vector<OccupancyCase> cases;
  simulated.noise = false;
  const SimulatedScans ideal = simulate_scans(out / "drive_ideal", simulated, progress);
  const RuleOptions rules{.max_m = ideal.max_m};
  CaseTable(ideal, rules).compare("ideal", ideal.scans, out, cases);
  simulated.noise = true;
  const SimulatedScans noisy = simulate_scans(out / "drive_gaussian", simulated, progress);
  CaseTable(noisy, rules).compare("gaussian", noisy.scans, out, cases);
  simulated.effects = {
      {"range0.short", 0.10}, {"range0.maximum", 0.05}, {"range0.crosstalk", 0.05}};
  const SimulatedScans mixed = simulate_scans(out / "drive_mixture", simulated, progress);
  CaseTable(mixed, rules).compare("mixture", mixed.scans, out, cases);
  const auto failing = with_failures(noisy.scans, noisy.max_m, options.seed);
  (void)CaseTable(noisy, rules)
      .add("failing", to_text(GridRule::kTempered),
           grid_by_rule(failing, GridRule::kTempered, rules), cases);
  study_wide_beams(noisy, options, out, cases);
  study_people(simulated, out, progress, cases);
  std::vector<std::pair<std::string, OccupancyTruth>> curves;
  for (const OccupancyCase& one : cases)
    if (one.sensor == "mixture") curves.emplace_back(one.rule, one.score);
  write_whole_file(out / "calibration.svg", calibration_chart(curves));
  return cases;
}

}  // namespace roadbook
