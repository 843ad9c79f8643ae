#include <nlohmann/json.hpp>

#include "apps/evaluate.hpp"
#include "apps/evaluation/occupancy/beam_fit_study.hpp"
#include "apps/evaluation/occupancy/intel_study.hpp"
#include "apps/evaluation/occupancy/occupancy_study.hpp"
#include "apps/summaries/occupancy_summary.hpp"
#include "base/format.hpp"
#include "base/whole_file.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

std::string in_percent(double share, int digits = 2) { return fixed(100.0 * share, digits) + " %"; }

ordered_json fit_json(const BeamFitStudy& s, Console& console) {
  console.say("beam fit: 10 fits to 10,000 beams, worst share off by " + fixed(s.worst_share, 4) +
              ", worst noise by " + in_percent(s.worst_sigma, 1));
  console.say("beam fit: 95 % intervals of " + std::to_string(s.draws) + " fits hold: hits " +
              in_percent(s.held_hit, 1) + ", short " + in_percent(s.held_short, 1) + ", maximum " +
              in_percent(s.held_maximum, 1) + ", crosstalk " + in_percent(s.held_crosstalk, 1) +
              ", noise " + in_percent(s.held_sigma, 1) + ", rate " + in_percent(s.held_rate, 1));
  return {{"worst_share", s.worst_share},
          {"worst_sigma", s.worst_sigma},
          {"draws", s.draws},
          {"held",
           {{"hit", s.held_hit},
            {"short", s.held_short},
            {"maximum", s.held_maximum},
            {"crosstalk", s.held_crosstalk},
            {"sigma_m", s.held_sigma},
            {"short_rate_per_m", s.held_rate}}}};
}

ordered_json cases_json(const std::vector<OccupancyCase>& cases, Console& console) {
  ordered_json list = ordered_json::array();
  for (const OccupancyCase& c : cases) {
    console.say(c.sensor + ", " + c.rule + ": calibration error " +
                fixed(c.score.calibration_error, 4) + ", free recall " +
                in_percent(c.score.free_recall) + ", occupied recall " +
                in_percent(c.score.occupied_recall) + ", occupied called free " +
                in_percent(c.score.occupied_called_free) +
                (c.crossed > 0 ? ", trails of people " + in_percent(c.trails) : "") +
                (c.temper < 1.0 ? ", temper " + fixed(c.temper, 3) : ""));
    ordered_json json{{"sensor", c.sensor}, {"rule", c.rule}, {"temper", c.temper}};
    json.update(to_json(c.score));
    json["trails"] = c.crossed > 0 ? ordered_json(c.trails) : ordered_json(nullptr);
    json["cells_crossed"] = c.crossed;
    list.push_back(std::move(json));
  }
  return list;
}

ordered_json intel_json(const IntelStudy& s, Console& console) {
  const RangeMixture& m = s.fitted;
  console.say("Intel lab: " + std::to_string(s.scans) + " scans, " + std::to_string(s.samples) +
              " readings; hits " + in_percent(m.hit()) + " with " + fixed(100.0 * m.sigma_m, 2) +
              " cm, short " + in_percent(m.share[kShort]) + ", maximum " +
              in_percent(m.share[kMaximum]) + ", crosstalk " + in_percent(m.share[kCrosstalk]));
  console.say("Intel lab: odd scans predicted with " + fixed(s.fitted_nats, 3) +
              " nats a beam by the model fitted to even ones, " + fixed(s.hand_set_nats, 3) +
              " by hand-set shares, " + fixed(s.naive_nats, 3) + " by hits alone");
  console.say("Intel lab: walls " + fixed(100.0 * s.thickness_corrected_m, 1) +
              " cm thick at corrected poses, " + fixed(100.0 * s.thickness_raw_m, 1) +
              " cm at those of the odometry; occupied cells " +
              std::to_string(s.occupied_corrected) + " and " + std::to_string(s.occupied_raw));
  return {{"scans", s.scans},
          {"samples", s.samples},
          {"mixture", to_json(m)},
          {"nats_fitted", s.fitted_nats},
          {"nats_hand_set", s.hand_set_nats},
          {"nats_naive", s.naive_nats},
          {"thickness_corrected_m", s.thickness_corrected_m},
          {"thickness_raw_m", s.thickness_raw_m},
          {"occupied_corrected", s.occupied_corrected},
          {"occupied_raw", s.occupied_raw}};
}

void run_occupancy(Console& console, const EvaluateCommand& command) {
  const int draws = command.repeats > 0 ? command.repeats : command.quick ? 40 : 1000;
  ordered_json json{{"experiment", "occupancy"}, {"seed", command.seed}};
  // First: a wrong file is said at once.
  if (!command.data.empty())
    json["intel"] = intel_json(study_intel(command.data, command.out), console);
  json["beam_fit"] = fit_json(study_beam_fit(command.seed, draws, command.threads), console);
  OccupancyStudyOptions options;
  options.size = command.quick ? "small" : "full";
  if (!command.only.empty()) options.place = command.only;
  options.seed = command.seed;
  options.num_threads = command.threads;
  json["grids"] = cases_json(study_occupancy(command.out, options, console.progress()), console);
  write_whole_file(command.out / "result.json", json.dump(2) + "\n");
  console.result(json);
}

}  // namespace

Experiment occupancy_experiment() {
  return {"occupancy",
          "occupancy grids by four rules for an ideal sensor, Gaussian noise and the full mixture, "
          "people who cross the lane, the fit of the beam model, and (--data intel_scans.csv) "
          "recorded scans; --repeats: fits for the intervals, --only: a built-in place",
          run_occupancy};
}

}  // namespace roadbook
