#include "apps/report/label_effort_section.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "apps/report/html.hpp"
#include "base/format.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

std::string duration_text(double seconds) {
  const auto whole = static_cast<std::int64_t>(std::llround(seconds));
  const std::string rest = std::to_string(whole % 60) + " s";
  return whole < 60 ? rest : std::to_string(whole / 60) + " min " + rest;
}

HtmlRow effort_row(const std::string& name, const LabelEffort& e) {
  HtmlRow row{name};
  for (const std::size_t count : {e.labels, e.drawn, e.filled, e.imported, e.accepted, e.rejected,
                                  e.images, e.changes, e.all_clicks()})
    row.push_back(std::to_string(count));
  row.push_back(duration_text(e.seconds));
  return row;
}

ordered_json effort_fields(const LabelEffort& e) {
  ordered_json json = {{"labels", e.labels},     {"drawn", e.drawn},       {"filled", e.filled},
                       {"imported", e.imported}, {"accepted", e.accepted}, {"rejected", e.rejected},
                       {"images", e.images},     {"changes", e.changes}};
  for (const LabelStep step : kLabelSteps) {
    const auto found = e.clicks.find(step);
    json["clicks_by_step"][to_text(step)] = found == e.clicks.end() ? 0 : found->second;
  }
  json["clicks"] = e.all_clicks();
  json["seconds"] = e.seconds;
  return json;
}

}  // namespace

std::string effort_table(const LabelLedger& ledger) {
  std::vector<HtmlRow> rows;
  for (const auto& [kind, effort] : ledger.classes) rows.push_back(effort_row(kind, effort));
  rows.push_back(effort_row("all", ledger.all));
  return html_table({"class", "labels", "drawn", "filled in rows", "imported", "accepted",
                     "rejected", "images done", "changes", "clicks", "time"},
                    rows) +
         "<p>Clicks and keys as many as it takes at least. Time from one step of a person to the "
         "next, pauses no longer than " +
         fixed(kLongestPauseS, 0) + " s; the first step of a person counts none.</p>\n";
}

ordered_json effort_json(const LabelLedger& ledger) {
  ordered_json json = {{"classes", ordered_json::array()}};
  for (const auto& [kind, effort] : ledger.classes) {
    ordered_json entry = {{"class", kind}};
    entry.update(effort_fields(effort));
    json["classes"].push_back(entry);
  }
  json["effort"] = effort_fields(ledger.all);
  json["effort"]["longest_pause_s"] = kLongestPauseS;
  return json;
}

}  // namespace roadbook
