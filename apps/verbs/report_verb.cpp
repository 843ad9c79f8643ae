#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/output_option.hpp"
#include "apps/report/label_diff_section.hpp"
#include "apps/report/label_section.hpp"
#include "apps/report/label_shift_section.hpp"
#include "apps/report/page.hpp"
#include "apps/summaries/report_truth.hpp"
#include "apps/summaries/value_summary.hpp"
#include "apps/verb.hpp"
#include "base/whole_file.hpp"

namespace roadbook {
namespace {

struct ReportCommand {
  std::filesystem::path map;
  std::filesystem::path output;
  std::vector<std::filesystem::path> evaluation;
  std::filesystem::path before;
  bool look_again = false;
};

nlohmann::ordered_json report_json(const ReportData& data,
                                   const LabelRounds& rounds,
                                   const std::filesystem::path& output) {
  nlohmann::ordered_json object = {{"report", output.string()},
                                   {"keyframes", data.map.keyframes.size()},
                                   {"landmarks", data.map.landmarks.size()},
                                   {"sessions", data.map.sessions.size()},
                                   {"observations", data.map.observations.size()},
                                   {"loops", data.map.loops.size()},
                                   {"warnings", data.warnings.size()},
                                   {"digest", data.meta.digest}};
  object["value"] = value_json(data.map, data.value);
  if (data.labels) object["labels"] = label_report_json(*data.labels, rounds);
  add_truth(data, object);
  return object;
}

void say_since_before(const LabelReport& labels, const Console& console) {
  console.say(label_diff_line(labels.differences, labels.before));
  if (const auto line = not_compared_line(labels); !line.empty()) console.say(line);
  console.say("labels: " + std::to_string(labels.to_look_at().size()) +
              " moved farther than their covariance told");
}

}  // namespace

Verb report_verb() {
  auto command = std::make_shared<ReportCommand>();
  return {"report", "writes one HTML page of figures and pictures about a map",
          [command](Options& options) {
            options.add("--map,-m", &command->map, "map file").required = true;
            options.add("--before", &command->before,
                        "earlier state of the map, to show moved and edited labels");
            options.add("--look-again", &command->look_again,
                        "search every label in the images of the newest drive");
            options.add("--output,-o", &command->output, "HTML file to write").required = true;
            options.add("--evaluation", &command->evaluation,
                        "folder written by `evaluate`: its figures go into the page");
          },
          [command](Console& console, const CommonOptions&) {
            refuse_to_replace(command->map, command->output);
            const ReportData data =
                collect_report(command->map, command->before, command->look_again);
            const LabelRounds rounds =
                data.labels ? read_label_rounds(MapLayers(command->map)) : LabelRounds();
            std::vector<EvaluationFigure> figures;
            for (const auto& folder : command->evaluation)
              for (EvaluationFigure& one : evaluation_figures(folder))
                figures.push_back(std::move(one));
            write_whole_file(command->output, report_page(data, rounds, figures));
            say_truth(console, data);
            if (data.labels && !command->before.empty()) say_since_before(*data.labels, console);
            if (data.labels && command->look_again)
              console.say("labels: the paint of " + std::to_string(data.labels->gone().size()) +
                          " is gone");
            console.say("report: " + command->output.string());
            console.result(report_json(data, rounds, command->output));
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
