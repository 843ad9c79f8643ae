#include "apps/summaries/occupancy_summary.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/format.hpp"
#include "base/text.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;

std::string percent_of(double share, int digits = 1) { return fixed(100.0 * share, digits) + " %"; }

double scan_ms(const OccupancyOfDrive& d) {
  return 1e3 * d.seconds / std::max(1.0, static_cast<double>(d.drive.scans));
}

std::string reading_name(const OccupancyDrive& d) {
  return d.sensor == "cameras" ? "keyframe" : "scan";
}

Json drive_json(const OccupancyOfDrive& d) {
  if (d.drive.sensor == "cameras")
    return {{"drive", d.drive.drive},
            {"sensor", d.drive.sensor},
            {"keyframes", d.drive.scans},
            {"landmarks_on_ground", d.on_ground},
            {"landmarks_raised", d.raised},
            {"patches", d.patches},
            {"updates", d.updates},
            {"ms_a_scan", scan_ms(d)},
            {"sights_raised", d.drive.sights_raised},
            {"sights_raised_free", d.drive.sights_raised_free},
            {"temper", d.drive.temper}};
  return {{"drive", d.drive.drive},
          {"sensor", d.drive.sensor},
          {"localised", d.drive.localised},
          {"scans", d.drive.scans},
          {"scans_without_pose", d.without_pose},
          {"patches", d.patches},
          {"updates", d.updates},
          {"ms_a_scan", scan_ms(d)},
          {"model", d.drive.model},
          {"fitted_readings", d.fitted_samples},
          {"mixture", to_json(d.drive.mixture)},
          {"temper", d.drive.temper},
          {"autocorrelation", d.autocorrelation}};
}

void say_drive(const Console& console, const OccupancyOfDrive& d) {
  const RangeMixture& m = d.drive.mixture;
  console.say(
      d.drive.drive + ": " + std::to_string(d.drive.scans) + " " + reading_name(d.drive) + "s in " +
      std::to_string(d.patches) + " patches" + (d.drive.localised ? ", localised in the map" : "") +
      (d.without_pose > 0 ? "; " + std::to_string(d.without_pose) + " without a pose" : ""));
  if (d.drive.sensor == "cameras") {
    console.say(d.drive.drive + ": " + std::to_string(d.on_ground) + " landmarks on the ground, " +
                std::to_string(d.raised) + " raised; raised ones are " +
                percent_of(d.drive.sights_raised) + " of the sights of an occupied cell, " +
                percent_of(d.drive.sights_raised_free, 2) +
                " of a free one; a further sight of a cell counts as " + fixed(d.drive.temper, 3));
    return;
  }
  console.say(d.drive.drive + ": beam model (" + d.drive.model + "): hits " + percent_of(m.hit()) +
              " with " + fixed(100.0 * m.sigma_m, 1) + " cm, short " + percent_of(m.share[kShort]) +
              ", maximum " + percent_of(m.share[kMaximum]) + ", crosstalk " +
              percent_of(m.share[kCrosstalk]) + "; a further reading of a cell counts as " +
              fixed(d.drive.temper, 3));
}

// The seven demands of document 001, as far as the map itself tells them.
Json demands_json(const OccupancyResult& r) {
  double ms = 0.0;
  for (const OccupancyOfDrive& d : r.drives) ms = std::max(ms, scan_ms(d));
  const OccupancyDemands& one = r.demands;
  Json demands{{"complete", 1.0 - one.undecided_share()},
               {"bytes_per_m2", one.figures.bytes_per_m2},
               {"updates_a_scan", one.updates_a_scan()},
               {"ms_a_scan", r.drives.empty() ? Json(nullptr) : Json(ms)},
               {"core_at_10_hz", r.drives.empty() ? Json(nullptr) : Json(ms / 100.0)},
               {"merged_share", one.figures.merged_share},
               {"free_share", one.free_share()},
               {"vanished_share", one.figures.vanished_share},
               {"driven_cells", one.driven.cells},
               {"driven_seen", one.driven.seen},
               {"driven_free", one.driven.free},
               {"driven_occupied", one.driven.occupied}};
  demands["trails"] = one.trails ? Json(one.trails->called_occupied) : Json(nullptr);
  demands["uncertainty"] = one.truth ? Json(one.truth->calibration_error) : Json(nullptr);
  return demands;
}

void say_demands(const Console& console, const OccupancyResult& r) {
  const OccupancyDemands& one = r.demands;
  console.say("complete: " + std::to_string(one.figures.cells) + " cells seen, " +
              percent_of(one.undecided_share()) + " undecided");
  console.say("compact: " + fixed(one.figures.bytes_per_m2, 0) + " bytes a square metre");
  for (const OccupancyOfDrive& d : r.drives)
    console.say("real time: " + fixed(scan_ms(d), 3) + " ms a " + reading_name(d.drive) + ", " +
                percent_of(scan_ms(d) / 100.0, 2) + " of a core at 10 Hz");
  console.say("detail: " + percent_of(one.figures.merged_share) +
              " of the cells are left after merging equal neighbours");
  console.say("free space: " + percent_of(one.free_share()) + " of the cells" +
              (one.truth
                   ? "; recall " + percent_of(one.truth->free_recall, 2) +
                         ", occupied called free " + percent_of(one.truth->occupied_called_free, 2)
                   : ""));
  console.say("moving things: " + percent_of(one.figures.vanished_share, 2) +
              " of the free cells had echoes of something that left");
  console.say(std::string("uncertainty: calibration error ") +
              (one.truth ? fixed(one.truth->calibration_error, 4) : "unknown without truth"));
}

}  // namespace

Json to_json(const RangeMixture& m) {
  return {{"hit", m.hit()},
          {"hit_sigma", m.sigma_hit},
          {"short", m.share[kShort]},
          {"short_sigma", m.sigma[kShort]},
          {"maximum", m.share[kMaximum]},
          {"maximum_sigma", m.sigma[kMaximum]},
          {"crosstalk", m.share[kCrosstalk]},
          {"crosstalk_sigma", m.sigma[kCrosstalk]},
          {"sigma_m", m.sigma_m},
          {"sigma_m_sigma", m.sigma_sigma_m},
          {"wide", m.wide},
          {"short_rate_per_m", m.short_rate_per_m}};
}

Json to_json(const OccupancyTruth& truth) {
  return {{"calibration_error", truth.calibration_error},
          {"free_recall", truth.free_recall},
          {"occupied_recall", truth.occupied_recall},
          {"occupied_called_free", truth.occupied_called_free},
          {"mean_probability", truth.mean_probability},
          {"true_share", truth.true_share},
          {"cells", truth.count}};
}

std::optional<double> temper_option(const std::string& text) {
  if (text == "auto") return std::nullopt;
  const auto value = parse_double(text);
  if (!value || !(*value >= 1e-3 && *value <= 1.0))
    throw InvalidOption("--temper", "'" + text + "'", "auto, or a number from 0.001 to 1");
  return value;
}

void print_occupancy(const Console& console, const OccupancyResult& result) {
  Json drives = Json::array();
  std::size_t updates = 0, scans = 0;
  double seconds = 0.0;
  for (const OccupancyOfDrive& d : result.drives) {
    say_drive(console, d);
    drives.push_back(drive_json(d));
    updates += d.updates;
    scans += static_cast<std::size_t>(d.drive.scans);
    seconds += d.seconds;
  }
  if (result.grid.without_pose > 0)
    console.note(std::to_string(result.grid.without_pose) +
                 " patches belong to poses that the map no longer has; they are left out");
  say_demands(console, result);
  const OccupancyFigures& figures = result.demands.figures;
  const auto& truth = result.demands.truth;
  Json json{{"scans", scans},
            {"cells", figures.cells},
            {"free", figures.free},
            {"occupied", figures.occupied},
            {"undecided", figures.undecided},
            {"updates", updates},
            {"updates_per_second",
             seconds > 0.0 ? Json(static_cast<double>(updates) / seconds) : Json(nullptr)},
            {"patches", result.stored.patches.size()},
            {"patches_moved", result.grid.moved},
            {"patches_without_pose", result.grid.without_pose},
            {"prior", 1.0 / (1.0 + std::exp(-result.stored.prior_log_odds()))},
            {"calibration_error", truth ? Json(truth->calibration_error) : Json(nullptr)},
            {"demands", demands_json(result)},
            {"drives", drives}};
  if (truth) json["truth"] = to_json(*truth);
  console.result(json);
}

}  // namespace roadbook
