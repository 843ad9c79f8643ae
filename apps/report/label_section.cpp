#include "apps/report/label_section.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "apps/report/html.hpp"
#include "apps/report/label_diff_section.hpp"
#include "apps/report/label_effort_section.hpp"
#include "apps/report/label_shift_section.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

std::string evidence_words(const LabelReport& report) {
  if (report.evidence.empty()) return "";
  const auto count = [&](EvidenceStatus status) {
    return std::to_string(std::count_if(report.evidence.begin(), report.evidence.end(),
                                        [&](const auto& e) { return e.status == status; }));
  };
  std::string html =
      "<p>Looked for again in the newest session's images: " + count(EvidenceStatus::kFound) +
      " found, " + count(EvidenceStatus::kGone) + " gone, " + count(EvidenceStatus::kCovered) +
      " covered, " + count(EvidenceStatus::kNoPaint) + " without paint, " +
      count(EvidenceStatus::kUnseen) + " in no image.</p>";
  std::string gone;
  for (const std::int64_t id : report.gone())
    gone += (gone.empty() ? "" : ", ") + std::to_string(id);
  if (!gone.empty())
    html += "<p>The paint of these labels is gone, a person should look: " + gone + ".</p>";
  return html;
}

}  // namespace

std::string label_section(const LabelReport& report, const LabelRounds& rounds) {
  std::string html = effort_table(report.effort) + rounds_table(rounds);
  if (!report.before.empty()) html += label_diff_section(report.differences, report.before);
  if (const std::string words = not_compared_line(report); !words.empty())
    html += "<p>" + escaped(words) + ".</p>";
  if (!report.shifts.shifts.empty())
    html +=
        shift_words(report) + evidence_words(report) + shift_picture(report) + shift_tables(report);
  return html_section("Labels", html);
}

ordered_json label_report_json(const LabelReport& report, const LabelRounds& rounds) {
  ordered_json json = effort_json(report.effort);
  json["rounds"] = label_rounds_json(rounds);
  if (!report.before.empty()) json["diff"] = label_diff_json(report.differences, report.before);
  json["shift"] = shifts_json(report);
  json["needs_human"] = ordered_json::array();
  for (const LabelShift& shift : report.to_look_at())
    json["needs_human"].push_back({{"label", shift.label.id},
                                   {"class", shift.label.kind},
                                   {"shift_m", shift.metres()},
                                   {"sigmas", shift.sigmas}});
  for (const std::int64_t id : report.gone())
    json["needs_human"].push_back({{"label", id}, {"paint", "gone"}});
  json["looked_for"] = report.evidence.size();
  json["agreement"] = {{"sightings", report.agreement.sightings.size()},
                       {"median_m", report.agreement.median_m},
                       {"median_sigmas", report.agreement.median_sigmas},
                       {"contradicts", report.agreement.contradicts()}};
  return json;
}

}  // namespace roadbook
