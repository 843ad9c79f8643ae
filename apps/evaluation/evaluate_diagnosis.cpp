#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "apps/evaluate.hpp"
#include "apps/evaluation/diagnosis_study.hpp"
#include "apps/evaluation/diagnosis_table.hpp"
#include "apps/report/chart.hpp"
#include "apps/report/html.hpp"
#include "apps/report/page_style.hpp"
#include "base/format.hpp"
#include "base/whole_file.hpp"
#include "speedmap/experiments/spm_experiment.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

using Confusion = std::map<std::string, std::map<std::string, std::size_t>>;

double share(std::size_t part, std::size_t all) {
  return all == 0 ? 0.0 : static_cast<double>(part) / static_cast<double>(all);
}

ordered_json study_json(const DiagnosisScore& s) {
  ordered_json json{
      {"drives", s.drives},
      {"named_first", s.first},
      {"in_set", s.in_set},
      {"in_set_with_a_flag", s.doubted},
      {"unnamed", s.unnamed},
      {"wrong_name", s.wrong},
      {"further_names", s.further},
      {"strong", s.strong},
      {"strong_in_set", s.strong_in_set},
      {"intervals", s.intervals},
      {"intervals_that_hold", s.covered},
      {"mean_set_size", share(s.set_members, s.sets)},
      {"cpu_seconds_a_drive", s.seconds / std::max<double>(1.0, static_cast<double>(s.drives))}};
  if (!s.gain_over_oracle.empty()) {
    json["gain_over_oracle_median"] = quantile(s.gain_over_oracle, 0.5);
    json["gain_over_oracle_3_percent"] = quantile(s.gain_over_oracle, 0.03);
  }
  return json;
}

std::string power_chart(const std::vector<PowerBin>& bins) {
  ChartSeries series{"in the set", {}, {}, false};
  for (const PowerBin& bin : bins) {
    const double p = share(bin.in_set, bin.drives);
    const double x = bin.high > 1e6 ? 1.5 * bin.low : 0.5 * (bin.low + bin.high);
    if (x > 60.0) continue;
    series.points.emplace_back(x, 100.0 * p);
    series.half_width.push_back(196.0 * std::sqrt(p * (1.0 - p) / static_cast<double>(bin.drives)));
  }
  return chart_svg(
      {"Power by size over standard error", "size / standard error", "drives [%]", 0.0, 105.0},
      {series});
}

// Draws the coverage: the share of intervals that contain the true size, over the nominal level.
std::string coverage_chart(std::vector<double> z) {
  ChartSeries held{"measured", {}, {}, false};
  ChartSeries claimed{"nominal", {{50.0, 50.0}, {100.0, 100.0}}, {}, true};
  for (double level = 50.0; level < 99.6; level += level < 95.0 ? 5.0 : 1.0) {
    // The interval's half width in standard errors, by bisection of the normal distribution.
    double low = 0.0, high = 6.0;
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (low + high);
      (100.0 * std::erf(middle / std::sqrt(2.0)) < level ? low : high) = middle;
    }
    const auto inside = static_cast<double>(
        std::count_if(z.begin(), z.end(), [&](double v) { return std::abs(v) <= high; }));
    const auto n = std::max(1.0, static_cast<double>(z.size()));
    held.points.emplace_back(level, 100.0 * inside / n);
    held.half_width.push_back(196.0 * std::sqrt(inside / n * (1.0 - inside / n) / n));
  }
  return chart_svg({"Coverage of the intervals", "nominal level [%]", "coverage [%]", 45.0, 102.0},
                   {held, claimed});
}

// Draws the share of drives whose held-out gain is at most a given fraction of the gain of the
// oracle, which knows the cause.
std::string gain_chart(std::vector<double> ratios) {
  std::sort(ratios.begin(), ratios.end());
  ChartSeries share{"drives", {}, {}, false};
  for (std::size_t i = 0; i < ratios.size(); ++i)
    share.points.emplace_back(
        std::clamp(ratios[i], 0.5, 1.2),
        100.0 * static_cast<double>(i + 1) / static_cast<double>(ratios.size()));
  return chart_svg({"Held-out gain over that of an oracle", "gain / gain of the oracle",
                    "drives at or below [%]", 0.0, 102.0},
                   {share});
}

std::string matrix_html(const Confusion& confusion) {
  std::set<std::string> answers;
  for (const auto& [hidden, row] : confusion)
    for (const auto& [answer, count] : row) answers.insert(answer);
  std::string html =
      "<div class=\"scroll\"><table style=\"white-space:nowrap;overflow-wrap:normal\"><thead><tr>"
      "<th>hidden</th>";
  for (const std::string& a : answers) html += "<th>" + escaped(a) + "</th>";
  html += "</tr></thead><tbody>";
  for (const auto& [hidden, row] : confusion) {
    html += "<tr><td>" + escaped(hidden) + "</td>";
    for (const std::string& a : answers)
      html += "<td>" + (row.contains(a) ? std::to_string(row.at(a)) : std::string()) + "</td>";
    html += "</tr>";
  }
  return html + "</tbody></table></div>";
}

struct StudyCharts {
  std::string power, coverage, gain;
};

std::string study_page(const ordered_json& json,
                       const Confusion& confusion,
                       const StudyCharts& charts) {
  std::string rows;
  for (const auto& [effect, s] : json["effects"].items())
    rows += "<tr><td>" + escaped(effect) + "</td><td>" + s["drives"].dump() + "</td><td>" +
            s["named_first"].dump() + "</td><td>" + s["in_set"].dump() + "</td><td>" +
            s["wrong_name"].dump() + "</td><td>" + s["intervals_that_hold"].dump() + " of " +
            s["intervals"].dump() + "</td></tr>";
  return "<!doctype html><html lang=\"en\"><head><meta charset=\"utf-8\"><title>roadbook: "
         "diagnosis evaluated</title><style>" +
         std::string(kPageStyle) +
         "</style></head><body><main><header><p>roadbook evaluate diagnosis</p></header>"
         "<h1>Hidden effects and what the diagnosis found</h1><section><h2>By effect</h2><div "
         "class=\"scroll\"><table><thead><tr><th>effect</th><th>drives</th><th>first</th><th>in "
         "the set</th><th>wrong name</th><th>intervals that hold</th></tr></thead><tbody>" +
         rows + "</tbody></table></div></section><section><h2>Power</h2><figure>" + charts.power +
         "</figure></section><section><h2>Intervals</h2><figure>" + charts.coverage +
         "</figure></section><section><h2>Gain</h2><figure>" + charts.gain +
         "</figure></section><section><h2>Confusion</h2>" + matrix_html(confusion) +
         "</section><section><h2>All figures</h2><pre>" + escaped(json.dump(2)) +
         "</pre></section></main></body></html>\n";
}

DiagnosisStudyOptions study_options(const EvaluateCommand& command) {
  DiagnosisStudyOptions options;
  options.folder = command.out / "drives";
  options.seed = command.seed;
  options.num_threads = command.threads;
  options.only = command.only;
  if (command.repeats > 0) options.drives_an_effect = static_cast<std::size_t>(command.repeats);
  // The proportions of the full study: 1,000 null drives and 200 pairs of each kind (300 null
  // drives for friction, range, detector) at 30 drives per effect.
  options.null_drives = 100 * options.drives_an_effect / 3;
  options.lasting_drives = 40 * options.drives_an_effect / 3;
  options.pair_drives = 20 * options.drives_an_effect / 3;
  options.removed_an_effect = (options.drives_an_effect + 9) / 10;
  if (command.quick) {
    options.length_m = 150.0;
    for (std::size_t* drives :
         {&options.null_drives, &options.lasting_drives, &options.pair_drives})
      *drives = (*drives + 2) / 3;
  }
  return options;
}

// The counts for one kind of drives, or for all drives.
struct Tally {
  DiagnosisScore score;
  std::size_t nulls = 0, alarms = 0, pairs = 0, both = 0, removed = 0, silent = 0, alike = 0;
  std::size_t strong = 0, strong_both = 0;  // pairs
  double best_possible = 0.0;
  // References whose errors last, by correlation time [s].
  struct Lasting {
    DiagnosisScore score;
    std::size_t nulls = 0, alarms = 0, correlations = 0;
    double best_possible = 0.0;
  };
  std::map<double, Lasting> lasting;

  void add_lasting(const StudiedDrive& d) {
    Lasting& of = lasting[d.reference.time_s];
    const bool correlation =
        std::any_of(d.found.causes.begin(), d.found.causes.end(),
                    [](const FoundCause& c) { return c.effect == "poses.correlation"; });
    of.correlations += correlation ? 1 : 0;
    if (d.effect.empty()) {
      ++of.nulls;
      of.alarms += d.raises_alarm() ? 1 : 0;
    } else {
      // The correlation of the poses is there too: it is no other name.
      StudiedDrive without = d;
      std::erase_if(without.found.causes,
                    [](const FoundCause& c) { return c.effect == "poses.correlation"; });
      of.score.add(without);
      of.best_possible += best_power(d);
    }
  }
  void add(const StudiedDrive& d) {
    if (d.reference.time_s > 0.0) return add_lasting(d);
    if (!d.beside.empty()) {
      ++pairs;
      both += d.all_named() ? 1 : 0;
      strong += is_strong_pair(d) ? 1 : 0;
      strong_both += is_strong_pair(d) && d.all_named() ? 1 : 0;
    } else if (d.removed) {
      ++removed;
      silent += d.unflagged() ? 1 : 0;
      alike += d.unflagged() && d.is_indistinguishable() ? 1 : 0;
    } else if (d.effect.empty()) {
      ++nulls;
      alarms += d.silent() ? 0 : 1;
    } else {
      score.add(d);
      best_possible += best_power(d);
    }
  }
  void put(ordered_json& json) const {
    json["all"] = study_json(score);
    json["best_possible_in_set"] = best_possible;
    json["without_a_cause"] = {{"drives", nulls}, {"alarms", alarms}};
    json["pairs"] = {{"drives", pairs},
                     {"both_named", both},
                     {"strong", strong},
                     {"strong_both_named", strong_both}};
    for (const auto& [time_s, of] : lasting)
      json["reference_errors_last"].push_back({{"correlation_s", time_s},
                                               {"drives", of.nulls},
                                               {"alarms", of.alarms},
                                               {"correlation_named", of.correlations},
                                               {"with_an_effect", study_json(of.score)},
                                               {"best_possible_in_set", of.best_possible}});
    json["cause_removed"] = {
        {"drives", removed}, {"unflagged_names", silent}, {"of_these_indistinguishable", alike}};
  }
  void say(const std::string& name, Console& console) const {
    console.say(name + ": in the set " + fixed(100.0 * share(score.in_set, score.drives), 1) +
                " %; false alarms " + std::to_string(alarms) + " of " + std::to_string(nulls) +
                " drives without an effect; pairs: both named " + std::to_string(both) + " of " +
                std::to_string(pairs) +
                "; effect removed from the catalogue: a wrong name without a warning " +
                std::to_string(silent) + " of " + std::to_string(removed) +
                ", where the true effect fits no better in " + std::to_string(alike));
    for (const auto& [time_s, of] : lasting)
      console.say("errors of the reference that last " + fixed(time_s, 1) + " s: false alarms " +
                  std::to_string(of.alarms) + " of " + std::to_string(of.nulls) +
                  "; with an effect: in the set " + std::to_string(of.score.in_set) + " of " +
                  std::to_string(of.score.drives) + ", best possible " +
                  fixed(of.best_possible, 1));
  }
};

const char* name_of(HiddenKind kind) {
  switch (kind) {
    case HiddenKind::kFriction:
      return "friction";
    case HiddenKind::kRange:
      return "range";
    case HiddenKind::kDetector:
      return "detector";
    default:
      return "motion";
  }
}

void evaluate_causes(Console& console, const EvaluateCommand& command) {
  const DiagnosisStudyOptions options = study_options(command);
  const auto drives = run_diagnosis_study(options, console.progress());
  if (drives.empty())
    throw InvalidOption("--only", "'" + command.only + "'",
                        "the beginning of an effect's name: friction0, imu0.gyro, ...");
  std::error_code ignored;
  std::filesystem::remove_all(options.folder, ignored);
  Tally all;
  std::map<HiddenKind, Tally> kinds;
  std::map<std::string, DiagnosisScore> by_effect;
  Confusion confusion;
  for (const StudiedDrive& d : drives) {
    all.add(d);
    kinds[d.kind].add(d);
    if (!d.beside.empty() || d.removed || d.reference.time_s > 0.0) continue;
    const std::string nothing = std::string("nothing (") + name_of(d.kind) + ")";
    ++confusion[d.effect.empty() ? nothing : d.effect][d.answer()];
    if (!d.effect.empty()) by_effect[d.effect].add(d);
  }
  ordered_json json{
      {"experiment", "diagnosis"}, {"seed", options.seed}, {"length_m", options.length_m}};
  all.put(json);
  json["effects"] = ordered_json::object();
  json["power"] = ordered_json::array();
  for (const PowerBin& bin : power_of(drives))
    json["power"].push_back(
        {{"size_over_sigma", {bin.low, bin.high}}, {"drives", bin.drives}, {"in_set", bin.in_set}});
  for (const auto& [kind, tally] : kinds) tally.put(json["kinds"][name_of(kind)]);
  for (const auto& [effect, score] : by_effect) {
    json["effects"][effect] = study_json(score);
    console.say(effect + ": in the set " + std::to_string(score.in_set) + " of " +
                std::to_string(score.drives));
  }
  json["confusion"] = confusion;
  for (const auto& [kind, tally] : kinds) tally.say(name_of(kind), console);
  if (kinds.size() > 1) all.say("all", console);
  const StudyCharts charts{power_chart(power_of(drives)), coverage_chart(all.score.z),
                           gain_chart(all.score.gain_over_oracle)};
  write_whole_file(command.out / "power.svg", charts.power);
  write_whole_file(command.out / "coverage.svg", charts.coverage);
  write_whole_file(command.out / "gain.svg", charts.gain);
  write_whole_file(command.out / "drives.csv", drives_csv(drives));
  write_whole_file(command.out / "result.json", json.dump(2) + "\n");
  write_whole_file(command.out / "report.html", study_page(json, confusion, charts));
  console.result(json);
}

}  // namespace

Experiment diagnosis_experiment() {
  return {"diagnosis", "hidden effects in simulated drives, and which of them diagnosis finds",
          evaluate_causes};
}

}  // namespace roadbook
