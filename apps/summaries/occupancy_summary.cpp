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

Json drive_json(const OccupancyOfDrive& d) {
  return {{"drive", d.drive.drive},
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
      d.drive.drive + ": " + std::to_string(d.drive.scans) + " scans in " +
      std::to_string(d.patches) + " patches" + (d.drive.localised ? ", localised in the map" : "") +
      (d.without_pose > 0 ? "; " + std::to_string(d.without_pose) + " without a pose" : ""));
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
  const auto cells = static_cast<double>(std::max<std::size_t>(r.figures.cells, 1));
  Json demands{{"complete", 1.0 - static_cast<double>(r.figures.undecided) / cells},
               {"bytes_per_m2", r.figures.bytes_per_m2},
               {"ms_a_scan", r.drives.empty() ? Json(nullptr) : Json(ms)},
               {"core_at_10_hz", r.drives.empty() ? Json(nullptr) : Json(ms / 100.0)},
               {"merged_share", r.figures.merged_share},
               {"free_share", static_cast<double>(r.figures.free) / cells},
               {"vanished_share", r.figures.vanished_share}};
  demands["uncertainty"] = r.truth ? Json(r.truth->calibration_error) : Json(nullptr);
  return demands;
}

void say_demands(const Console& console, const OccupancyResult& r) {
  const auto cells = static_cast<double>(std::max<std::size_t>(r.figures.cells, 1));
  console.say("complete: " + std::to_string(r.figures.cells) + " cells seen, " +
              percent_of(static_cast<double>(r.figures.undecided) / cells) + " undecided");
  console.say("compact: " + fixed(r.figures.bytes_per_m2, 0) + " bytes a square metre");
  for (const OccupancyOfDrive& d : r.drives)
    console.say("real time: " + fixed(scan_ms(d), 3) + " ms a scan, " +
                percent_of(scan_ms(d) / 100.0, 2) + " of a core at 10 Hz");
  console.say("detail: " + percent_of(r.figures.merged_share) +
              " of the cells are left after merging equal neighbours");
  console.say(
      "free space: " + percent_of(static_cast<double>(r.figures.free) / cells) + " of the cells" +
      (r.truth ? "; recall " + percent_of(r.truth->free_recall, 2) + ", occupied called free " +
                     percent_of(r.truth->occupied_called_free, 2)
               : ""));
  console.say("moving things: " + percent_of(r.figures.vanished_share, 2) +
              " of the free cells had echoes of something that left");
  console.say(std::string("uncertainty: calibration error ") +
              (r.truth ? fixed(r.truth->calibration_error, 4) : "unknown without truth"));
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
  Json json{
      {"scans", scans},
      {"cells", result.figures.cells},
      {"free", result.figures.free},
      {"occupied", result.figures.occupied},
      {"undecided", result.figures.undecided},
      {"updates", updates},
      {"updates_per_second",
       seconds > 0.0 ? Json(static_cast<double>(updates) / seconds) : Json(nullptr)},
      {"patches", result.stored.patches.size()},
      {"patches_moved", result.grid.moved},
      {"patches_without_pose", result.grid.without_pose},
      {"prior", 1.0 / (1.0 + std::exp(-result.stored.prior_log_odds()))},
      {"calibration_error", result.truth ? Json(result.truth->calibration_error) : Json(nullptr)},
      {"demands", demands_json(result)},
      {"drives", drives}};
  if (result.truth) json["truth"] = to_json(*result.truth);
  console.result(json);
}

}  // namespace roadbook
