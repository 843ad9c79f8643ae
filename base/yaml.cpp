#include "base/yaml.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <set>
#include <sstream>
#include <utility>

#include "base/text.hpp"

namespace roadbook {

struct YamlMap::Document {
  std::string file;
  std::vector<Problem> problems;
  std::vector<std::shared_ptr<State>> maps;  ///< every mapping handed out, for the unknown keys
};

struct YamlMap::State {
  Document* document = nullptr;  ///< kept alive by every YamlMap handed out
  std::string path;              ///< "wheels." before the field's name; "" at the top
  std::int64_t line = 0;
  std::vector<std::pair<std::string, YAML::Node>> entries;
  std::set<std::string, std::less<>> asked;

  void fault(std::string_view key, std::int64_t at, std::string got, std::string want) const {
    document->problems.push_back({Severity::kError, document->file, at, path + std::string(key),
                                  std::move(got), std::move(want)});
  }
  [[nodiscard]] const YAML::Node* find(std::string_view key) const {
    for (const auto& [name, node] : entries)
      if (name == key) return &node;
    return nullptr;
  }
  const YAML::Node* ask(std::string_view key) {
    asked.emplace(key);
    return find(key);
  }
};

namespace {

constexpr std::uintmax_t kMaxBytes = 64u << 20;  // far above any calibration or scenario

std::int64_t line_of(const YAML::Node& node) { return node.Mark().line + 1; }

std::string shown(const YAML::Node& node) {
  switch (node.Type()) {
    case YAML::NodeType::Scalar:
      return node.Scalar().size() > 60 ? node.Scalar().substr(0, 57) + "..." : node.Scalar();
    case YAML::NodeType::Sequence:
      return "a list";
    case YAML::NodeType::Map:
      return "a mapping";
    default:
      return "nothing";
  }
}

std::string to_text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

bool is_quoted(const YAML::Node& node) { return node.Tag() == "!"; }

std::optional<double> as_double(const YAML::Node& node) {
  if (!node.IsScalar() || is_quoted(node)) return std::nullopt;
  return parse_double(node.Scalar());
}

std::string range_text(const Range& range) {
  if (std::isinf(range.min) && std::isinf(range.max)) return "";
  if (std::isinf(range.max)) return " >= " + to_text(range.min);
  if (std::isinf(range.min)) return " <= " + to_text(range.max);
  return " in [" + to_text(range.min) + ", " + to_text(range.max) + "]";
}

bool inside(double value, const Range& range) { return value >= range.min && value <= range.max; }

// The entries of a mapping node; doubled keys and keys that are no plain words are faults.
template <typename State>
void fill_entries(State& state, const YAML::Node& node) {
  state.line = line_of(node);
  for (const auto& entry : node) {
    if (!entry.first.IsScalar()) {
      state.fault("", line_of(entry.first), shown(entry.first) + " as key", "a name");
      continue;
    }
    const std::string& key = entry.first.Scalar();
    if (state.find(key) != nullptr)
      state.fault(key, line_of(entry.first), "the key a second time", "each key once");
    else
      state.entries.emplace_back(key, entry.second);
  }
}

YAML::Node parse_text(const std::string& text, const std::string& name) {
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& e) {
    throw BadInput(
        {Severity::kError, name, e.mark.line + 1, "", "invalid YAML (" + e.msg + ")", "YAML"});
  }
}

}  // namespace

YamlMap YamlMap::load(const std::filesystem::path& file) {
  std::error_code error;
  const auto size = std::filesystem::file_size(file, error);
  if (error) throw BadInput({Severity::kError, file.string(), 0, "", "no readable file", "YAML"});
  if (size > kMaxBytes)
    throw BadInput({Severity::kError, file.string(), 0, "size", std::to_string(size) + " bytes",
                    "at most " + std::to_string(kMaxBytes)});
  std::ifstream in(file, std::ios::binary);
  std::string text(size, '\0');
  if (!in.read(text.data(), static_cast<std::streamsize>(size)))
    throw BadInput({Severity::kError, file.string(), 0, "", "no readable file", "YAML"});
  return parse(text, file.string());
}

YamlMap YamlMap::parse(const std::string& text, const std::string& name) {
  std::string body = text;
  // OpenCV writes "%YAML:1.0", which is not the directive it resembles.
  if (body.starts_with("%YAML:")) body[0] = '#';
  const YAML::Node root = parse_text(body, name);
  if (!root.IsMap() && !root.IsNull())
    throw BadInput({Severity::kError, name, line_of(root), "", shown(root), "a mapping"});
  auto document = std::make_shared<Document>();
  document->file = name;
  auto state = std::make_shared<State>();
  state->document = document.get();
  if (root.IsMap()) fill_entries(*state, root);
  document->maps.push_back(state);
  // The document lists every state, so the states must not own the document; each handle does.
  return YamlMap(std::shared_ptr<State>(document, state.get()));
}

std::optional<YamlMap> YamlMap::map(std::string_view key) {
  const YAML::Node* const node = state_->ask(key);
  if (node == nullptr) return std::nullopt;
  if (!node->IsMap()) {
    state_->fault(key, line_of(*node), shown(*node), "a mapping");
    return std::nullopt;
  }
  auto child = std::make_shared<State>();
  child->document = state_->document;
  child->path = state_->path + std::string(key) + ".";
  fill_entries(*child, *node);
  state_->document->maps.push_back(child);
  return YamlMap(std::shared_ptr<State>(state_, child.get()));
}

std::vector<YamlMap> YamlMap::maps(std::string_view key) {
  std::vector<YamlMap> result;
  const YAML::Node* const node = state_->ask(key);
  if (node == nullptr) return result;
  if (!node->IsSequence()) {
    state_->fault(key, line_of(*node), shown(*node), "a list of mappings");
    return result;
  }
  std::size_t index = 0;
  for (const auto& item : *node) {
    const std::string name = std::string(key) + "[" + std::to_string(index++) + "]";
    if (!item.IsMap()) {
      state_->fault(name, line_of(item), shown(item), "a mapping");
      continue;
    }
    auto child = std::make_shared<State>();
    child->document = state_->document;
    child->path = state_->path + name + ".";
    fill_entries(*child, item);
    state_->document->maps.push_back(child);
    result.push_back(YamlMap(std::shared_ptr<State>(state_, child.get())));
  }
  return result;
}

bool YamlMap::read(std::string_view key, double& value, const Range& range) {
  const YAML::Node* const node = state_->ask(key);
  if (node == nullptr) return false;
  const auto number = as_double(*node);
  if (!number || !inside(*number, range)) {
    state_->fault(key, line_of(*node), shown(*node), "a finite number" + range_text(range));
    return false;
  }
  value = *number;
  return true;
}

bool YamlMap::read(std::string_view key, std::optional<double>& value, const Range& range) {
  double number = 0.0;
  if (!read(key, number, range)) return false;
  value = number;
  return true;
}

bool YamlMap::read(std::string_view key, std::int64_t& value, const Range& range) {
  const YAML::Node* const node = state_->ask(key);
  if (node == nullptr) return false;
  const auto number = node->IsScalar() && !is_quoted(*node) ? parse_int(node->Scalar())
                                                            : std::optional<std::int64_t>{};
  if (!number || !inside(static_cast<double>(*number), range)) {
    state_->fault(key, line_of(*node), shown(*node), "a whole number" + range_text(range));
    return false;
  }
  value = *number;
  return true;
}

bool YamlMap::read(std::string_view key, int& value, const Range& range) {
  std::int64_t wide = 0;
  const Range fits{std::max(range.min, static_cast<double>(std::numeric_limits<int>::min())),
                   std::min(range.max, static_cast<double>(std::numeric_limits<int>::max()))};
  if (!read(key, wide, fits)) return false;
  value = static_cast<int>(wide);
  return true;
}

bool YamlMap::read(std::string_view key, std::uint64_t& value) {
  const YAML::Node* const node = state_->ask(key);
  if (node == nullptr) return false;
  std::uint64_t number = 0;
  const std::string text = node->IsScalar() && !is_quoted(*node) ? node->Scalar() : std::string();
  const auto result = std::from_chars(text.data(), text.data() + text.size(), number);
  if (text.empty() || result.ec != std::errc{} || result.ptr != text.data() + text.size()) {
    state_->fault(key, line_of(*node), shown(*node), "a whole number >= 0");
    return false;
  }
  value = number;
  return true;
}

bool YamlMap::read(std::string_view key, bool& value) {
  const YAML::Node* const node = state_->ask(key);
  if (node == nullptr) return false;
  const std::string text = node->IsScalar() && !is_quoted(*node) ? node->Scalar() : std::string();
  if (text != "true" && text != "false") {
    state_->fault(key, line_of(*node), shown(*node), "true or false");
    return false;
  }
  value = text == "true";
  return true;
}

bool YamlMap::read(std::string_view key, std::string& value) {
  const YAML::Node* const node = state_->ask(key);
  if (node == nullptr) return false;
  if (!node->IsScalar()) {
    state_->fault(key, line_of(*node), shown(*node), "a word");
    return false;
  }
  value = node->Scalar();
  return true;
}

bool YamlMap::read(std::string_view key, std::vector<double>& value) {
  const YAML::Node* const node = state_->ask(key);
  if (node == nullptr) return false;
  if (!node->IsSequence()) {
    state_->fault(key, line_of(*node), shown(*node), "a list of numbers");
    return false;
  }
  std::vector<double> numbers;
  for (const auto& item : *node) {
    if (const auto number = as_double(item)) {
      numbers.push_back(*number);
      continue;
    }
    const std::string name = std::string(key) + "[" + std::to_string(numbers.size()) + "]";
    state_->fault(name, line_of(item), shown(item), "a finite number");
    return false;
  }
  value = std::move(numbers);
  return true;
}

bool YamlMap::read(std::string_view key, std::vector<std::vector<double>>& value) {
  const YAML::Node* const node = state_->ask(key);
  if (node == nullptr) return false;
  std::vector<std::vector<double>> rows;
  bool good = node->IsSequence();
  std::int64_t bad_line = line_of(*node);
  for (std::size_t i = 0; good && i < node->size(); ++i) {
    const YAML::Node row = (*node)[i];
    good = row.IsSequence();
    bad_line = line_of(row);
    rows.emplace_back();
    for (std::size_t j = 0; good && j < row.size(); ++j) {
      const auto number = as_double(row[j]);
      good = number.has_value();
      if (number) rows.back().push_back(*number);
    }
  }
  if (!good) {
    state_->fault(key, bad_line, shown(*node), "a list of lists of finite numbers");
    return false;
  }
  value = std::move(rows);
  return true;
}

bool YamlMap::read(std::string_view key, std::vector<std::string>& value) {
  const YAML::Node* const node = state_->ask(key);
  if (node == nullptr) return false;
  std::vector<std::string> words;
  bool good = node->IsSequence();
  for (std::size_t i = 0; good && i < node->size(); ++i) {
    const YAML::Node item = (*node)[i];
    good = item.IsScalar();
    if (good) words.push_back(item.Scalar());
  }
  if (!good) {
    state_->fault(key, line_of(*node), shown(*node), "a list of words");
    return false;
  }
  value = std::move(words);
  return true;
}

bool YamlMap::read_list(std::string_view key, std::size_t count, std::vector<double>& value) {
  std::vector<double> numbers;
  if (!read(key, numbers)) return false;
  if (numbers.size() != count) {
    report(key, std::to_string(numbers.size()) + " numbers", std::to_string(count));
    return false;
  }
  value = std::move(numbers);
  return true;
}

void YamlMap::ignore(std::string_view key) { state_->ask(key); }

bool YamlMap::has(std::string_view key) const { return state_->find(key) != nullptr; }

bool YamlMap::is_map(std::string_view key) const {
  const YAML::Node* const node = state_->find(key);
  return node != nullptr && node->IsMap();
}

std::vector<std::string> YamlMap::keys() const {
  std::vector<std::string> names;
  for (const auto& [name, node] : state_->entries) names.push_back(name);
  return names;
}

void YamlMap::report(std::string_view key, const std::string& got, const std::string& want) {
  state_->fault(key, line(key), got, want);
}

bool YamlMap::missing(std::string_view key) {
  state_->asked.emplace(key);
  state_->fault(key, state_->line, "nothing", "this key");
  return false;
}

std::int64_t YamlMap::line(std::string_view key) const {
  const YAML::Node* const node = state_->find(key);
  return node == nullptr ? state_->line : line_of(*node);
}

const std::string& YamlMap::file() const { return state_->document->file; }

const std::vector<Problem>& YamlMap::problems() const { return state_->document->problems; }

std::vector<Problem> YamlMap::finish_problems() {
  for (const auto& map : state_->document->maps) {
    const std::vector<std::string> known(map->asked.begin(), map->asked.end());
    for (const auto& [name, node] : map->entries) {
      if (map->asked.contains(name)) continue;
      const auto nearest = nearest_name(name, known);
      map->fault(name, line_of(node), "an unknown key",
                 nearest ? "a known one (did you mean " + *nearest + "?)" : "a known one");
      map->asked.insert(name);  // said once, however often finish is called
    }
  }
  return state_->document->problems;
}

void YamlMap::finish() {
  if (auto found = finish_problems(); !found.empty()) throw BadInput(std::move(found));
}

}  // namespace roadbook
