#include "apps/command_line.hpp"

#include <CLI/App.hpp>
#include <CLI/Config.hpp>
#include <CLI/Formatter.hpp>
#include <iostream>

#include "base/error.hpp"
#include "base/text.hpp"

namespace roadbook {
namespace {

std::string help_of(const Option& option) {
  std::string text = option.help;
  for (std::size_t i = 0; i < option.choices.size(); ++i)
    text += (i == 0 ? ": " : ", ") + option.choices[i];
  return option.required ? text + " (needed)" : text;
}

CLI::Option* declare(CLI::App& app, const Option& option) {
  const std::string names =
      option.short_name.empty() ? option.name : option.short_name + "," + option.name;
  const std::string help = help_of(option);
  if (option.is_flag()) return app.add_flag(names, help);
  // The options convert the values. CLI11 only collects the words.
  CLI::Option* const made = app.add_option(names, help)->type_name(option.value_name());
  if (option.is_list() && option.positional())
    return made->expected(1, 1 << 20)->allow_extra_args();
  return option.is_list() ? made->take_all() : made->expected(1)->take_last();
}

[[noreturn]] void refuse_extra(const std::string& verb,
                               const std::string& word,
                               const Options& options) {
  const std::string help = "`roadbook " + verb + " --help`";
  if (word.size() < 2 || word.front() != '-')
    throw InvalidOption(verb, "'" + word + "' too many", "the arguments of " + help);
  std::string want = "an option of " + help;
  const std::string name = word.substr(0, word.find('='));
  if (const auto near = nearest_name(name, options.names()))
    want += "; did you mean " + *near + "?";
  throw InvalidOption(name, "an unknown option", want);
}

}  // namespace

bool parse_command_line(const std::string& verb,
                        const std::string& summary,
                        const std::vector<std::string>& words,
                        Options& options) {
  CLI::App app(summary, "roadbook " + verb);
  app.allow_extras();
  std::vector<CLI::Option*> declared;
  for (const Option& option : options.all()) declared.push_back(declare(app, option));
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));
  } catch (const CLI::CallForHelp&) {
    std::cout << app.help();
    return false;
  } catch (const CLI::ParseError& fault) {
    // Usually an option without its value. CLI11's text names the option.
    throw InvalidOption(verb, fault.what(), "the arguments of `roadbook " + verb + " --help`");
  }
  if (const auto extra = app.remaining(); !extra.empty())
    refuse_extra(verb, extra.front(), options);
  for (std::size_t i = 0; i < declared.size(); ++i)
    if (declared[i]->count() > 0) set_option(options.all()[i], declared[i]->results());
  return true;
}

}  // namespace roadbook
