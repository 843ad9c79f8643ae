#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "base/text.hpp"
#include "base/yaml_state.hpp"

namespace roadbook {
namespace {

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

}  // namespace

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
  const YAML::Node* const node = state_->ask(key);
  if (node != nullptr && node->IsNull()) {
    value.reset();
    return true;
  }
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

}  // namespace roadbook
