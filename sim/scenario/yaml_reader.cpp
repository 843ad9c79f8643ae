#include "sim/scenario/yaml_reader.hpp"

#include <algorithm>
#include <utility>

#include "base/error.hpp"
#include "base/text.hpp"
#include "base/yaml.hpp"

namespace roadbook {
namespace {

std::string shape_of(const YAML::Node& node) {
  if (node.IsMap()) return "a mapping";
  if (node.IsSequence()) return "a list";
  if (node.IsScalar()) return node.Scalar();
  return "nothing";
}

std::string range_text(double low, double high) {
  std::string text = "a number from " + std::to_string(low) + " to " + std::to_string(high);
  return text;
}

}  // namespace

YamlReader YamlReader::parse(const std::string& text, const std::string& file) {
  require_one_yaml_document(text, file);
  try {
    return {YAML::Load(text), file, ""};
  } catch (const YAML::Exception& e) {
    throw BadInput(Problem{Severity::kError, file, e.mark.line + 1, "", e.msg, "YAML"});
  }
}

void YamlReader::fail(const std::string& got, const std::string& want) const {
  throw BadInput(Problem{Severity::kError, file_, node_.Mark().line + 1, field_, got, want});
}

void YamlReader::only(const std::vector<std::string>& keys) const {
  if (!node_.IsMap()) fail(shape_of(node_), "a mapping");
  for (const auto& entry : node_) {
    const std::string key = entry.first.Scalar();
    if (std::find(keys.begin(), keys.end(), key) != keys.end()) continue;
    const auto near = nearest_name(key, keys);
    const YamlReader place(entry.first, file_, field_.empty() ? key : field_ + "." + key);
    place.fail("unknown key", near ? "'" + *near + "'" : "a known key");
  }
}

std::vector<std::string> YamlReader::keys() const {
  if (!node_.IsMap()) fail(shape_of(node_), "a mapping");
  std::vector<std::string> names;
  for (const auto& entry : node_) names.push_back(entry.first.Scalar());
  return names;
}

bool YamlReader::has(const std::string& key) const { return find(key).has_value(); }

std::optional<YamlReader> YamlReader::find(const std::string& key) const {
  if (!node_.IsMap()) fail(shape_of(node_), "a mapping");
  const YAML::Node child = std::as_const(node_)[key];
  if (!child.IsDefined() || child.IsNull()) return std::nullopt;
  return YamlReader(child, file_, field_.empty() ? key : field_ + "." + key);
}

YamlReader YamlReader::at(const std::string& key) const {
  auto child = find(key);
  if (child) return *child;
  YamlReader missing(node_, file_, field_.empty() ? key : field_ + "." + key);
  missing.fail("nothing", "a value");
}

std::vector<YamlReader> YamlReader::items(const std::string& key) const {
  const auto child = find(key);
  return child ? child->items() : std::vector<YamlReader>{};
}

std::vector<YamlReader> YamlReader::items() const {
  if (!node_.IsSequence()) fail(shape_of(node_), "a list");
  std::vector<YamlReader> result;
  for (std::size_t i = 0; i < node_.size(); ++i)
    result.push_back({std::as_const(node_)[i], file_, field_ + "[" + std::to_string(i) + "]"});
  return result;
}

YamlReader YamlReader::overridden_by(const YamlReader& other) const {
  YAML::Node merged(YAML::NodeType::Map);
  for (const auto& entry : node_)
    if (!other.has(entry.first.Scalar())) merged[entry.first.Scalar()] = entry.second;
  for (const auto& entry : other.node_) merged[entry.first.Scalar()] = entry.second;
  return {merged, file_, field_};
}

std::string YamlReader::scalar(const std::string& want) const {
  if (!node_.IsScalar()) fail(shape_of(node_), want);
  return node_.Scalar();
}

double YamlReader::number(double low, double high) const {
  const std::string want = range_text(low, high);
  const std::string value = scalar(want);
  const auto parsed = parse_double(value);
  if (!parsed || *parsed < low || *parsed > high) fail(value, want);
  return *parsed;
}

int YamlReader::integer(int low, int high) const {
  const std::string want = "an integer from " + std::to_string(low) + " to " + std::to_string(high);
  const std::string value = scalar(want);
  const auto parsed = parse_int(value);
  if (!parsed || *parsed < low || *parsed > high) fail(value, want);
  return static_cast<int>(*parsed);
}

bool YamlReader::boolean() const {
  const std::string value = scalar("true or false");
  if (value != "true" && value != "false") fail(value, "true or false");
  return value == "true";
}

std::string YamlReader::text() const { return scalar("text"); }

Eigen::Vector2d YamlReader::point() const {
  if (!node_.IsSequence() || node_.size() != 2) fail(shape_of(node_), "[x, y] in metres");
  const auto both = items();
  return {both[0].number(-1e5, 1e5), both[1].number(-1e5, 1e5)};
}

std::size_t YamlReader::choice(const std::vector<std::string>& names) const {
  std::string want = "one of";
  for (const auto& name : names) want += " " + name;
  const std::string value = scalar(want);
  const auto found = std::find(names.begin(), names.end(), value);
  if (found == names.end()) fail(value, want);
  return static_cast<std::size_t>(found - names.begin());
}

double YamlReader::number(const std::string& key, double fallback, double low, double high) const {
  const auto child = find(key);
  return child ? child->number(low, high) : fallback;
}

int YamlReader::integer(const std::string& key, int fallback, int low, int high) const {
  const auto child = find(key);
  return child ? child->integer(low, high) : fallback;
}

std::string YamlReader::text(const std::string& key, const std::string& fallback) const {
  const auto child = find(key);
  return child ? child->text() : fallback;
}

}  // namespace roadbook
