#include "apps/summaries/calibration_summary.hpp"

#include <nlohmann/json.hpp>

#include "apps/summary_json.hpp"
#include "base/format.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;

int decimals_of(const std::string& unit) { return unit == "m" ? 4 : unit == "ms" ? 1 : 2; }

const char* state_of(const CalibratedColumn& c) {
  if (c.reference) return "reference";
  if (c.held) return "held";
  return c.observable ? "estimated" : "not observable";
}

Json column_json(const CalibratedValue& v) {
  return {{"name", v.column.column.name},
          {"state", state_of(v.column)},
          {"unit", v.unit},
          {"before", v.before},
          {"after", v.after},
          {"half_width_95", v.half_width},
          {"size", v.column.value},
          {"size_half_width_95", v.column.half_width}};
}

}  // namespace

std::vector<std::string> calibration_lines(const CalibrateResult& result) {
  std::vector<std::string> lines;
  for (const CalibratedValue& v : result.values) {
    const int decimals = decimals_of(v.unit);
    std::string line = v.column.column.name + ": ";
    if (v.column.reference)
      line += "the other delays are relative to this one";
    else if (v.column.held)
      line += fixed(v.before, decimals) + " " + v.unit + ", held";
    else
      line += fixed(v.before, decimals) + " -> " + fixed(v.after, decimals) + " " + v.unit +
              " +- " + fixed(v.half_width, decimals) +
              (v.column.observable ? "" : ", not observable in the drives");
    lines.push_back(line);
  }
  const EstimatedCalibration& c = result.calibration;
  lines.push_back("median pixel error " + fixed(c.reprojection_before_px, 3) + " -> " +
                  fixed(c.reprojection_after_px, 3) + " px, " + std::to_string(c.views) +
                  " views, " + std::to_string(c.motions) + " motions of the wheels");
  return lines;
}

void print_calibration(const Console& console,
                       const CalibrateResult& result,
                       const std::filesystem::path& model) {
  console.warn(result.warnings);
  for (const std::string& line : calibration_lines(result)) console.say(line);
  if (!result.refusal) console.say("model: " + model.string());
  Json columns = Json::array();
  for (const CalibratedValue& v : result.values) columns.push_back(column_json(v));
  Json effects = Json::object();
  for (const auto& [name, size] : result.model) effects[name] = size;
  console.result({{"columns", columns},
                  {"effects", effects},
                  {"views", result.calibration.views},
                  {"motions", result.calibration.motions},
                  {"pixel_error_px",
                   {{"before", result.calibration.reprojection_before_px},
                    {"after", result.calibration.reprojection_after_px}}},
                  {"model", result.refusal ? Json() : Json(model.string())},
                  {"warnings", to_json(result.warnings)}});
}

}  // namespace roadbook
