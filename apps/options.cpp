#include "apps/options.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <type_traits>

#include "base/error.hpp"
#include "base/text.hpp"

namespace roadbook {
namespace {

template <typename... Handlers>
struct Overloaded : Handlers... {
  using Handlers::operator()...;
};

// A text that an option does not accept. The caller decides how to report it.
struct Mismatch {
  std::string got;
  std::string want;
};

std::string number_text(double value) {
  std::ostringstream out;
  out << value;
  return out.str();
}

std::string wanted_number(const char* kind, const Range& range) {
  if (std::isinf(range.min) && std::isinf(range.max)) return kind;
  if (std::isinf(range.max)) return std::string(kind) + " >= " + number_text(range.min);
  return std::string(kind) + " from " + number_text(range.min) + " to " + number_text(range.max);
}

double to_number(const std::string& text, const Range& range) {
  const auto value = parse_double(text);
  if (!value || *value < range.min || *value > range.max)
    throw Mismatch{"'" + text + "'", wanted_number("a number", range)};
  return *value;
}

// `least` and `most` are the limits of the type.
std::int64_t to_integer(const std::string& text, Range range, double least, double most) {
  range = {std::max(least, range.min), std::min(most, range.max)};
  const auto value = parse_int(text);
  if (!value || static_cast<double>(*value) < range.min || static_cast<double>(*value) > range.max)
    throw Mismatch{"'" + text + "'", wanted_number("a whole number", range)};
  return *value;
}

void check_choice(const Option& option, const std::string& text) {
  if (option.choices.empty() ||
      std::find(option.choices.begin(), option.choices.end(), text) != option.choices.end())
    return;
  std::string want = "one of";
  for (const std::string& choice : option.choices) want += " " + choice;
  if (const auto near = nearest_name(text, option.choices)) want += "; did you mean " + *near + "?";
  throw Mismatch{"'" + text + "'", want};
}

void store(Option& option, const std::vector<std::string>& texts) {
  ROADBOOK_ASSERT(option.is_flag() || !texts.empty());
  option.given = true;
  const std::string text = texts.empty() ? "" : texts.back();
  const Range& range = option.range;
  constexpr double kMaxInt = 2147483647.0;
  constexpr double kMaxExact = 9007199254740992.0;  // 2^53: larger bounds are not exact
  std::visit(Overloaded{
                 [&](bool* value) { *value = true; },
                 [&](int* value) {
                   *value = static_cast<int>(to_integer(text, range, -kMaxInt, kMaxInt));
                 },
                 [&](std::uint64_t* value) {
                   *value = static_cast<std::uint64_t>(to_integer(text, range, 0.0, kMaxExact));
                 },
                 [&](double* value) { *value = to_number(text, range); },
                 [&](std::optional<double>* value) { *value = to_number(text, range); },
                 [&](std::string* value) {
                   check_choice(option, text);
                   *value = text;
                 },
                 [&](std::filesystem::path* value) { *value = text; },
                 [&](std::vector<std::string>* value) {
                   for (const std::string& one : texts) check_choice(option, one);
                   *value = texts;
                 },
                 [&](std::vector<std::filesystem::path>* value) {
                   value->assign(texts.begin(), texts.end());
                 },
             },
             option.target);
}

}  // namespace

bool Option::is_list() const {
  return std::holds_alternative<std::vector<std::string>*>(target) ||
         std::holds_alternative<std::vector<std::filesystem::path>*>(target);
}

bool Option::is_file() const {
  return std::holds_alternative<std::filesystem::path*>(target) ||
         std::holds_alternative<std::vector<std::filesystem::path>*>(target);
}

std::string Option::value_name() const {
  if (is_flag()) return "";
  if (is_file()) return "FILE";
  if (std::holds_alternative<std::string*>(target) ||
      std::holds_alternative<std::vector<std::string>*>(target))
    return "TEXT";
  return "NUMBER";
}

std::string Option::key() const {
  std::string text = positional() ? name : name.substr(2);
  for (char& c : text)
    c = c == '-' ? '_' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

Option& Options::add(const std::string& names, OptionTarget target, std::string help) {
  Option option;
  const auto comma = names.find(',');
  option.name = names.substr(0, comma);
  if (comma != std::string::npos) option.short_name = names.substr(comma + 1);
  option.target = target;
  option.help = std::move(help);
  options_.push_back(std::move(option));
  return options_.back();
}

const Option* Options::find(const std::string& name) const {
  for (const Option& option : options_)
    if (option.name == name || option.short_name == name) return &option;
  return nullptr;
}

bool Options::given(const std::string& name) const {
  const Option* const option = find(name);
  ROADBOOK_ASSERT(option != nullptr);
  return option->given;
}

std::vector<std::string> Options::names() const {
  std::vector<std::string> result;
  for (const Option& option : options_) {
    if (option.positional()) continue;
    result.push_back(option.name);
    if (!option.short_name.empty()) result.push_back(option.short_name);
  }
  return result;
}

void set_option(Option& option, const std::vector<std::string>& texts) {
  try {
    store(option, texts);
  } catch (const Mismatch& fault) {
    throw InvalidOption(option.name, fault.got, fault.want);
  }
}

void Options::read_yaml(const std::filesystem::path& file) {
  YamlMap yaml = YamlMap::load(file);
  for (Option& option : options_) {
    if (option.positional() || option.name == "--options") continue;
    const std::string key = option.key();
    if (!yaml.has(key) || option.given) {
      yaml.ignore(key);
      continue;
    }
    std::string text;
    std::vector<std::string> texts;
    bool flag = false;
    const bool read = option.is_flag()
                          ? yaml.read(key, flag)
                          : (option.is_list() ? yaml.read(key, texts) : yaml.read(key, text));
    if (!read || (option.is_flag() && !flag)) continue;
    if (!option.is_list()) texts = {text};
    try {
      store(option, texts);
    } catch (const Mismatch& fault) {
      yaml.report(key, fault.got, fault.want);
    }
  }
  yaml.finish();
}

void Options::check_required() const {
  for (const Option& option : options_)
    if (option.required && !option.given) throw InvalidOption(option.name, "nothing", option.help);
}

}  // namespace roadbook
