
#include <nlohmann/json.hpp>
#include <optional>

#include "apps/evaluate.hpp"
#include "apps/evaluation/sessions/session_study.hpp"
#include "apps/report/chart.hpp"
#include "base/format.hpp"
#include "base/whole_file.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

ordered_json value_or_null(const std::optional<double>& value) {
  return value ? ordered_json(*value) : ordered_json();
}

std::string centimetres(const std::optional<double>& metres) {
  return metres ? fixed(100.0 * *metres, 2) + " cm" : std::string("-");
}

ordered_json step_json(const SessionStep& step) {
  ordered_json sessions = ordered_json::array();
  for (const SessionError& session : step.sessions)
    sessions.push_back({{"alone_m", value_or_null(session.alone_m)},
                        {"offset_m", value_or_null(session.offset_m)}});
  return {{"visit", step.visit},
          {"cpu_s", step.cpu_s},
          {"alone_cpu_s", step.alone_cpu_s},
          {"peak_rss_mb", step.peak_rss_mb},
          {"localised_share", value_or_null(step.localised_share)},
          {"landmarks", step.landmarks},
          {"map_frames", step.map_frames},
          {"bytes", step.bytes},
          {"together_m", value_or_null(step.together_m)},
          {"sessions", sessions},
          {"held_out_m", value_or_null(step.held_out_m)},
          {"held_out_share", value_or_null(step.held_out_share)}};
}

std::string step_line(const std::string& adjust, const SessionStep& step) {
  std::string line = adjust + ", " + std::to_string(step.visit + 1) +
                     (step.visit == 0 ? " session: " : " sessions: ") + fixed(step.cpu_s, 1) +
                     " CPU s (alone " + fixed(step.alone_cpu_s, 1) + "), " +
                     std::to_string(step.landmarks) + " landmarks, error " +
                     centimetres(step.together_m) + " together;";
  for (const SessionError& session : step.sessions) line += " " + centimetres(session.alone_m);
  return line + "; held-out visit " + centimetres(step.held_out_m);
}

// Cost and error over the number of sessions, and what outdated landmarks leave.
void write_session_charts(const std::filesystem::path& folder, const SessionStudy& study) {
  std::vector<ChartSeries> cost;
  std::vector<ChartSeries> error;
  for (const SessionChain& chain : study.chains) {
    ChartSeries seconds{chain.adjust, {}, {}, chain.adjust == "batch"};
    ChartSeries centimetre = seconds;
    for (const SessionStep& step : chain.steps) {
      seconds.points.emplace_back(step.visit + 1, step.cpu_s);
      if (step.together_m) centimetre.points.emplace_back(step.visit + 1, 100.0 * *step.together_m);
    }
    cost.push_back(std::move(seconds));
    if (!centimetre.points.empty()) error.push_back(std::move(centimetre));
  }
  ChartSeries alone{"a map of this visit alone", {}, {}, true};
  for (const SessionStep& step : study.chains.front().steps)
    alone.points.emplace_back(step.visit + 1, step.alone_cpu_s);
  cost.push_back(std::move(alone));
  write_whole_file(folder / "cost.svg",
                   chart_svg({"Processor time of one more session", "sessions", "CPU s"}, cost));
  if (!error.empty())
    write_whole_file(
        folder / "error.svg",
        chart_svg({"Median error of all sessions, one alignment", "sessions", "cm"}, error));
  if (study.outdated.empty()) return;
  ChartSeries right{"within 0.3 m of the truth", {}, {}, false};
  ChartSeries wrong{"farther away", {}, {}, true};
  for (const OutdatedStep& step : study.outdated) {
    right.points.emplace_back(100.0 * step.share, 100.0 * step.right);
    wrong.points.emplace_back(100.0 * step.share, 100.0 * step.wrong);
  }
  write_whole_file(folder / "outdated.svg",
                   chart_svg({"Frames localised in an outdated map", "outdated landmarks [%]",
                              "frames [%]", 0.0, 105.0},
                             {right, wrong}));
}

void run_sessions(Console& console, const EvaluateCommand& command) {
  SessionStudyOptions options;
  if (!command.only.empty()) options.place = command.only;
  options.seed = command.seed;
  options.num_threads = command.threads;
  if (command.quick) {
    options.size = "small";
    options.image_scale = 0.5;
    options.visits = 3;
    options.order_visits = 3;
    options.orders = 2;
  }
  if (command.repeats > 0) options.visits = command.repeats;
  const SessionStudy study = session_study(command.out, options, console.progress());
  ordered_json chains = ordered_json::object();
  for (const SessionChain& chain : study.chains) {
    ordered_json steps = ordered_json::array();
    for (const SessionStep& step : chain.steps) {
      console.say(step_line(chain.adjust, step));
      steps.push_back(step_json(step));
    }
    chains[chain.adjust] = steps;
  }
  console.say(std::to_string(study.orders) + " orders of the visits: poses differ by " +
              centimetres(study.orders_median_m) + " median, " + centimetres(study.orders_worst_m) +
              " at most");
  ordered_json outdated = ordered_json::array();
  for (const OutdatedStep& step : study.outdated) {
    console.say(fixed(100.0 * step.share, 0) + " % of the landmarks outdated: " +
                fixed(100.0 * step.localised, 1) + " % of the frames localised, " +
                fixed(100.0 * step.wrong, 1) + " % wrong, error " + centimetres(step.median_m));
    outdated.push_back({{"share", step.share},
                        {"localised", step.localised},
                        {"right", step.right},
                        {"wrong", step.wrong},
                        {"median_m", value_or_null(step.median_m)}});
  }
  const ordered_json json{{"experiment", "sessions"},
                          {"place", options.place},
                          {"seed", command.seed},
                          {"chains", chains},
                          {"orders", study.orders},
                          {"orders_median_m", value_or_null(study.orders_median_m)},
                          {"orders_worst_m", value_or_null(study.orders_worst_m)},
                          {"outdated", outdated}};
  write_session_charts(command.out, study);
  write_whole_file(command.out / "result.json", json.dump(2) + "\n");
  console.result(json);
}

}  // namespace

Experiment sessions_experiment() {
  return {"sessions",
          "visits that extend a map one after another: cost, errors, orders, outdated landmarks "
          "(--repeats: sessions, --only: a built-in place); drives stay in the folder and are used "
          "again",
          run_sessions};
}

}  // namespace roadbook
