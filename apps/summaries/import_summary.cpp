#include "apps/summaries/import_summary.hpp"

#include <nlohmann/json.hpp>

#include "apps/summary_json.hpp"

namespace roadbook {
namespace {

// Returns the first reasons and the number of further ones. `--json` prints all.
std::vector<Problem> reasons_of(const LabelImport& made) {
  constexpr std::size_t kMostLines = 20;
  std::vector<Problem> lines;
  for (const LabelsLeftOut& one : made.left_out) {
    if (lines.size() == kMostLines) break;
    lines.push_back(one.reason);
    lines.back().want += "; left out";
  }
  if (made.left_out.size() > lines.size())
    lines.push_back({Severity::kWarning, "", 0, "left out",
                     std::to_string(made.left_out.size() - lines.size()) + " more",
                     "none (--json names each)"});
  return lines;
}

std::string import_summary(const LabelImport& made) {
  std::string text = std::to_string(made.stored) + " labels stored, " +
                     std::to_string(made.already) + " were there";
  if (made.changed > 0) text += ", " + std::to_string(made.changed) + " changed";
  if (const std::size_t left_out = made.count_left_out(); left_out > 0)
    text += ", " + std::to_string(left_out) + " left out";
  return text;
}

}  // namespace

void print_imported_labels(const Console& console,
                           const LabelImport& made,
                           const std::filesystem::path& map) {
  console.warn(made.notes);
  console.warn(reasons_of(made));
  console.say(import_summary(made));
  nlohmann::ordered_json reasons = nlohmann::ordered_json::array();
  for (const LabelsLeftOut& one : made.left_out) {
    reasons.push_back(to_json(std::vector<Problem>{one.reason}).front());
    reasons.back()["count"] = one.count;
  }
  const std::size_t left_out = made.count_left_out();
  console.result({{"map", map.string()},
                  {"stored", made.stored},
                  {"already", made.already},
                  {"changed", made.changed},
                  {"left_out", left_out},
                  {"total", made.stored + made.already + made.changed + left_out},
                  {"reasons", reasons},
                  {"warnings", to_json(made.notes)}});
}

void print_imported_drive(const Console& console,
                          const ImportResult& made,
                          const DriveReport& report,
                          const std::filesystem::path& drive) {
  console.warn(report.problems);
  console.say(std::to_string(report.frames) + " frames of " + std::to_string(report.cameras) +
              " cameras" + (report.has_wheels ? ", wheels" : ", no wheels"));
  console.say("drive: " + drive.string());
  console.result({{"drive", drive.string()},
                  {"frames", report.frames},
                  {"cameras", report.cameras},
                  {"wheels", report.has_wheels},
                  {"images", made.images},
                  {"wheel_rows", made.wheel_rows},
                  {"imu_rows", made.imu_rows},
                  {"poses", made.poses},
                  {"warnings", to_json(made.warnings)},
                  {"problems", to_json(report.problems)}});
}

}  // namespace roadbook
