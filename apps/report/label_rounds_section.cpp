#include "apps/report/label_rounds_section.hpp"

#include <nlohmann/json.hpp>

#include "apps/report/html.hpp"
#include "base/format.hpp"
#include "semantics/people/person_labels.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

constexpr std::size_t kShownDigits = 8;  // digits that distinguish the rounds of a map

// The fields that rounds of both kinds have.
struct RoundRow {
  std::string kind;
  int number = 0;
  std::int64_t event = 0;
  std::size_t shown = 0;  // positive examples
  std::size_t none = 0;
  std::size_t again = 0;  // of `none`: from a second look
  std::size_t found = 0;
  double seconds = 0.0;
  std::string classifier;
};

std::vector<RoundRow> rows_of(const LabelRounds& rounds) {
  std::vector<RoundRow> rows;
  for (const LearningRound& r : rounds.ground)
    rows.push_back(
        {r.kind, r.number, r.event, r.positives, r.negatives, 0, r.found, r.seconds, r.classifier});
  for (const PeopleRound& r : rounds.people)
    rows.push_back({kPersonKind, r.number, r.event, r.persons, r.nobody, r.again, r.found,
                    r.seconds, r.classifier});
  return rows;
}

}  // namespace

LabelRounds read_label_rounds(const MapLayers& layers) {
  return {record_from_text(read_stored_learning(layers).record).rounds,
          read_people_record(layers).rounds};
}

std::string rounds_table(const LabelRounds& rounds) {
  std::vector<HtmlRow> table;
  for (const RoundRow& r : rows_of(rounds)) {
    const bool told = !r.classifier.empty();
    table.push_back({r.kind, std::to_string(r.number), told ? std::to_string(r.event) : "",
                     std::to_string(r.shown), std::to_string(r.none), std::to_string(r.again),
                     std::to_string(r.found), fixed(r.seconds, 1) + " s",
                     told ? r.classifier.substr(0, kShownDigits) : "not told"});
  }
  if (table.empty()) return "";
  return html_table({"class", "round", "changes until then", "examples", "of none",
                     "of them false alarms of its own", "found", "took", "classifier"},
                    table) +
         "<p>Rounds of learning in the labelling page. A classifier's name is the beginning of its "
         "digest; <code>roadbook label --replay</code> learns the rounds again and compares.</p>\n";
}

ordered_json label_rounds_json(const LabelRounds& rounds) {
  ordered_json list = ordered_json::array();
  for (const RoundRow& r : rows_of(rounds)) {
    list.push_back({{"class", r.kind},
                    {"round", r.number},
                    {"event", r.event},
                    {"examples", r.shown},
                    {"none", r.none},
                    {"again", r.again},
                    {"found", r.found},
                    {"seconds", r.seconds},
                    {"classifier", nullptr}});
    if (!r.classifier.empty()) list.back()["classifier"] = r.classifier;
  }
  return list;
}

}  // namespace roadbook
