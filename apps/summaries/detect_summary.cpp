#include "apps/summaries/detect_summary.hpp"

#include <nlohmann/json.hpp>

namespace roadbook {
namespace {

using nlohmann::ordered_json;

ordered_json rounds_json(const std::vector<PersonRound>& rounds) {
  ordered_json list = ordered_json::array();
  for (const PersonRound& r : rounds)
    list.push_back({{"drawn", r.drawn},
                    {"put_right", r.put_right},
                    {"clicks", r.clicks},
                    {"people", r.people},
                    {"precision", r.precision},
                    {"recall", r.recall}});
  return list;
}

ordered_json score_json(const PeopleScore& score) {
  double chi2 = 0.0;
  for (const double m : score.mahalanobis2) chi2 += m;
  if (!score.mahalanobis2.empty()) chi2 /= static_cast<double>(score.mahalanobis2.size());
  return {{"people", score.people},         {"precision", score.precision()},
          {"recall", score.recall()},       {"foot_error_median_m", score.median_error_m()},
          {"foot_mahalanobis2_mean", chi2}, {"calibration_error", score.calibration_error()}};
}

}  // namespace

void print_detections(const Console& console, const DetectResult& result) {
  ordered_json sessions = ordered_json::array();
  for (const SessionDetections& one : result.sessions) {
    sessions.push_back(
        {{"session", one.session}, {"sightings", one.detections}, {"looks", one.frames}});
    if (one.score) sessions.back()["truth"] = score_json(*one.score);
  }
  console.result({{"rounds", rounds_json(result.rounds)},
                  {"examples", result.examples},
                  {"taught", result.taught},
                  {"persons", result.positives},
                  {"answers", result.answers},
                  {"prior_shift", result.prior_shift},
                  {"sessions", std::move(sessions)},
                  {"digest", result.digest}});
}

}  // namespace roadbook
