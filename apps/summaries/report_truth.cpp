#include "apps/summaries/report_truth.hpp"

#include <nlohmann/json.hpp>

#include "apps/summaries/offset_text.hpp"
#include "apps/summary_json.hpp"
#include "base/format.hpp"

namespace roadbook {
namespace {

nlohmann::ordered_json error_json(const TrajectoryError& error) {
  return {{"ate_median_m", error.median_m},
          {"ate_p95_m", error.p95_m},
          {"ate_rmse_m", error.rmse_m},
          {"ate_max_m", error.max_m}};
}

std::string error_text(const TrajectoryError& error) {
  return fixed(error.median_m, 3) + " m median, " + fixed(error.p95_m, 3) + " m 95 %";
}

}  // namespace

void say_truth(const Console& console, const ReportData& data) {
  const bool several = data.map.sessions.size() > 1;
  if (several && data.truth.together)
    console.say("against truth, all sessions together: " + error_text(*data.truth.together));
  for (const TruthComparison& truth : data.truth.sessions)
    console.say("against truth: " + error_text(truth.error) +
                (several ? "; off the other sessions: " + offset_text(truth.offset) : ""));
}

void add_truth(const ReportData& data, nlohmann::ordered_json& object) {
  object["truth"] = nlohmann::ordered_json::array();
  for (const TruthComparison& truth : data.truth.sessions) {
    nlohmann::ordered_json session = {
        {"session", data.map.sessions[static_cast<std::size_t>(truth.session)].name}};
    session.update(error_json(truth.error));
    session["offset"] = to_json(truth.offset);
    object["truth"].push_back(session);
  }
  object["truth_together"] = nullptr;
  if (data.truth.together) object["truth_together"] = error_json(*data.truth.together);
}

}  // namespace roadbook
