#include "apps/option_table.hpp"

namespace roadbook {
namespace {

// Bars would end the cell.
std::string cell(const std::string& text) {
  std::string safe;
  for (const char c : text) safe += c == '|' ? std::string("\\|") : std::string(1, c);
  return safe;
}

std::string names_of(const Option& option) {
  std::string text = "`" + option.name;
  if (!option.short_name.empty()) text += ", " + option.short_name;
  if (!option.is_flag() && !option.positional()) text += " " + option.value_name();
  return text + "`";
}

std::string meaning_of(const Option& option) {
  std::string text = cell(option.help);
  for (std::size_t i = 0; i < option.choices.size(); ++i)
    text += (i == 0 ? ": `" : ", `") + option.choices[i] + "`";
  return option.required ? text + " (needed)" : text;
}

}  // namespace

std::string option_table(const Verb& verb) {
  Options options;
  verb.declare(options);
  std::string table = "| option | meaning |\n|---|---|\n";
  for (const Option& option : options.all())
    table += "| " + names_of(option) + " | " + meaning_of(option) + " |\n";
  return table;
}

std::string with_option_tables(const std::string& page) {
  std::string text = page;
  for (const Verb& verb : all_verbs()) {
    const std::string begin = "<!-- options of " + verb.name + " -->\n";
    const std::size_t from = text.find(begin);
    if (from == std::string::npos) continue;
    const std::size_t to = text.find("<!-- end -->", from);
    if (to == std::string::npos) continue;
    text.replace(from + begin.size(), to - from - begin.size(), "\n" + option_table(verb) + "\n");
  }
  return text;
}

}  // namespace roadbook
