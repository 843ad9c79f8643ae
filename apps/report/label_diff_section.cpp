#include "apps/report/label_diff_section.hpp"

#include <algorithm>
#include <array>
#include <set>

#include "apps/report/html.hpp"
#include "base/format.hpp"
#include "mapping/layers/map_layers.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;
using DiffKind = LabelDifferenceKind;

constexpr std::array kDiffKinds{DiffKind::kAdded, DiffKind::kDeleted, DiffKind::kRestored,
                                DiffKind::kChanged};

std::size_t count_of(const std::vector<LabelDifference>& differences, DiffKind kind) {
  return static_cast<std::size_t>(
      std::count_if(differences.begin(), differences.end(),
                    [&](const LabelDifference& d) { return d.kind == kind; }));
}

// Reports call a label's kind its class.
std::string shown_name(const std::string& field) { return field == "kind" ? "class" : field; }

std::string time_text(std::int64_t t_ns) { return t_ns == 0 ? "" : utc_text(t_ns); }

// Describes a change. For names and plain values, gives both values. For places, gives the distance
// between them, if both are relative to the same vehicle pose.
std::string change_words(const LabelFieldChange& change, bool same_anchor) {
  const std::string name = shown_name(change.field);
  if (change.field == "middle" && same_anchor && change.from.is_array() && change.to.is_array()) {
    Eigen::Vector3d way;
    for (int i = 0; i < 3; ++i)
      way[i] = change.to[static_cast<std::size_t>(i)].get<double>() -
               change.from[static_cast<std::size_t>(i)].get<double>();
    return name + " by " + fixed(100.0 * way.norm(), 1) + " cm";
  }
  const auto words = [](const ordered_json& value) {
    if (value.is_string()) return value.get<std::string>();
    return value.is_number_float() ? fixed(value.get<double>(), 3) : std::string();
  };
  const std::string from = words(change.from);
  const std::string to = words(change.to);
  const bool is_told = change.field != "pictures" && !(from.empty() && to.empty());
  return is_told ? name + ": '" + from + "', now '" + to + "'" : name;
}

std::string field_words(const LabelDifference& difference) {
  const auto& fields = difference.fields;
  const bool same_anchor =
      std::none_of(fields.begin(), fields.end(), [](const auto& f) { return f.field == "anchor"; });
  std::string words;
  for (const LabelFieldChange& change : fields) {
    words += (words.empty() ? "" : "; ") + change_words(change, same_anchor);
    if (change.who != difference.who || change.t_ns != difference.t_ns)
      words += " (" + change.who + ", " + time_text(change.t_ns) + ")";
  }
  return words;
}

}  // namespace

std::string label_diff_line(const std::vector<LabelDifference>& differences,
                            const std::string& before) {
  if (differences.empty()) return "nobody has changed a label since " + before;
  std::string line;
  for (const DiffKind kind : kDiffKinds)
    if (const std::size_t count = count_of(differences, kind); count > 0)
      line += (line.empty() ? "labels since " + before + ": " : ", ") + std::to_string(count) +
              " " + to_text(kind);
  std::set<std::string> people;
  for (const LabelDifference& d : differences) {
    if (!d.who.empty()) people.insert(d.who);
    for (const LabelFieldChange& change : d.fields) people.insert(change.who);
  }
  std::string names;
  for (const std::string& who : people) names += (names.empty() ? " by " : ", ") + who;
  return line + names;
}

std::string label_diff_section(const std::vector<LabelDifference>& differences,
                               const std::string& before) {
  std::string html = "<p>By hand: " + escaped(label_diff_line(differences, before)) + ".</p>";
  if (differences.empty()) return html;
  std::vector<HtmlRow> rows;
  for (const LabelDifference& d : differences)
    rows.push_back({std::to_string(d.label.id), d.label.kind, to_text(d.kind), field_words(d),
                    d.who, time_text(d.t_ns)});
  return html + "<details><summary>Each of them</summary>" +
         html_table({"label", "class", "what", "fields", "by", "when"}, rows) + "</details>\n";
}

ordered_json label_diff_json(const std::vector<LabelDifference>& differences,
                             const std::string& before) {
  ordered_json json = {{"since", before}};
  for (const DiffKind kind : kDiffKinds) json[to_text(kind)] = count_of(differences, kind);
  json["each"] = ordered_json::array();
  for (const LabelDifference& d : differences) {
    ordered_json fields = ordered_json::array();
    for (const LabelFieldChange& change : d.fields)
      fields.push_back({{"field", shown_name(change.field)},
                        {"from", change.from},
                        {"to", change.to},
                        {"who", change.who},
                        {"when", time_text(change.t_ns)}});
    json["each"].push_back({{"label", d.label.id},
                            {"class", d.label.kind},
                            {"what", to_text(d.kind)},
                            {"who", d.who},
                            {"when", time_text(d.t_ns)},
                            {"fields", fields}});
  }
  return json;
}

}  // namespace roadbook
