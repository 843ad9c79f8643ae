#include "semantics/labels/label_classes.hpp"

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

#include "base/error.hpp"
#include "base/utf8.hpp"

namespace roadbook {
namespace {

constexpr const char* kTable = "label_classes";
constexpr const char* kNot = "not_";
constexpr std::size_t kLongest = 64;
constexpr std::size_t kMost = 64;

// Okabe and Ito 2008: colours that colour-blind people can distinguish.
constexpr std::array<const char*, 6> kColours{"#56B4E9", "#E69F00", "#CC79A7",
                                              "#009E73", "#F0E442", "#D55E00"};

std::string text_of(const FieldValue& value) {
  const auto* const text = std::get_if<std::string>(&value);
  return text == nullptr ? std::string() : *text;
}

bool is_name(const std::string& text) {
  return !text.empty() && utf8_characters(text).value_or(kLongest + 1) <= kLongest;
}

bool is_colour(const std::string& text) {
  return text.size() == 7 && text[0] == '#' &&
         text.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
}

}  // namespace

std::vector<LabelClass> read_label_classes(const MapLayers& layers) {
  std::vector<LabelClass> classes;
  if (!layers.has(kTable))
    return {{"parking_space", "parking space", kColours[0], true},
            {"crossing", "crossing", kColours[1], false}};
  const auto refuse = [&](const std::string& got, const std::string& want) {
    throw BadInput(
        {Severity::kError, layers.file().string(), 0, std::string("table ") + kTable, got, want});
  };
  for (const auto& row : layers.read_table(kTable).rows) {
    if (row.size() != 4)
      refuse(std::to_string(row.size()) + " columns", "kind, title, colour, shape");
    const std::string shape = text_of(row[3]);
    if (shape != "box" && shape != "polygon") refuse("shape '" + shape + "'", "box or polygon");
    classes.push_back({text_of(row[0]), text_of(row[1]), text_of(row[2]), shape == "box"});
  }
  try {
    check_label_classes(classes);
  } catch (const InvalidOption& fault) {
    refuse(fault.problem().field + " " + fault.problem().got, fault.problem().want);
  }
  return classes;
}

PlainTable label_class_table(const std::vector<LabelClass>& classes) {
  PlainTable table{kTable,
                   {{"kind", FieldType::kText},
                    {"title", FieldType::kText},
                    {"colour", FieldType::kText},
                    {"shape", FieldType::kText}},
                   {}};
  for (const LabelClass& c : classes)
    table.rows.push_back({c.kind, c.title, c.colour, std::string(c.box ? "box" : "polygon")});
  return table;
}

nlohmann::ordered_json classes_to_json(const std::vector<LabelClass>& classes) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const LabelClass& c : classes)
    list.push_back({{"kind", c.kind},
                    {"title", c.title},
                    {"colour", c.colour},
                    {"shape", c.box ? "box" : "polygon"}});
  return list;
}

std::vector<LabelClass> classes_from_json(const nlohmann::ordered_json& json,
                                          const std::string& source) {
  std::vector<LabelClass> classes;
  try {
    for (const auto& c : json)
      classes.push_back({c.at("kind").get<std::string>(), c.at("title").get<std::string>(),
                         c.at("colour").get<std::string>(),
                         c.at("shape").get<std::string>() == "box"});
  } catch (const nlohmann::json::exception& fault) {
    throw BadInput({Severity::kError, source, 0, "classes", fault.what(), "a list of classes"});
  }
  return classes;
}

void check_label_classes(const std::vector<LabelClass>& classes) {
  if (classes.empty() || classes.size() > kMost)
    throw InvalidOption("classes", std::to_string(classes.size()), "1 to 64");
  std::set<std::string> kinds;
  for (const LabelClass& c : classes) {
    if (!is_name(c.kind) || is_rejected_kind(c.kind))
      throw InvalidOption("kind", "'" + c.kind + "'",
                          "1 to 64 characters that do not begin with not_");
    if (!kinds.insert(c.kind).second)
      throw InvalidOption("kind", c.kind + " twice", "each class once");
    if (!is_name(c.title)) throw InvalidOption("title", "'" + c.title + "'", "1 to 64 characters");
    if (!is_colour(c.colour))
      throw InvalidOption("colour", "'" + c.colour + "'", "a colour such as #56B4E9");
  }
}

std::optional<std::string> wrong_name(const std::string& name) {
  if (name.empty()) return "''";
  const auto characters = utf8_characters(name);
  if (!characters) return "bytes that are no UTF-8";
  if (*characters > kLongest) return std::to_string(*characters) + " characters";
  for (const char c : name)
    if (static_cast<unsigned char>(c) < 32 || c == 127) return "a control character";
  if (name.find_first_not_of(' ') == std::string::npos) return "blanks alone";
  return std::nullopt;
}

std::vector<LabelClass> with_kinds(std::vector<LabelClass> classes,
                                   const std::vector<std::string>& kinds) {
  for (const std::string& kind : kinds) {
    const bool known = std::any_of(classes.begin(), classes.end(),
                                   [&](const LabelClass& c) { return c.kind == kind; });
    if (known || is_rejected_kind(kind)) continue;
    const char* const colour = kColours[classes.size() % kColours.size()];
    classes.push_back({kind, kind, colour, true});
  }
  return classes;
}

std::string rejected_kind(const std::string& kind) { return kNot + kind; }
bool is_rejected_kind(const std::string& kind) { return kind.starts_with(kNot); }
std::string searched_kind(const std::string& kind) {
  return is_rejected_kind(kind) ? kind.substr(std::string_view(kNot).size()) : kind;
}

}  // namespace roadbook
