#include "apps/completion_scripts.hpp"

#include <vector>

#include "apps/verb.hpp"

namespace roadbook {
namespace {

std::string spaced(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

std::string verb_names() {
  std::vector<std::string> names;
  for (const Verb& verb : all_verbs()) names.push_back(verb.name);
  return spaced(names);
}

// Returns lines of a `case` with the options of every verb.
std::string option_cases() {
  std::string text;
  for (const Verb& verb : all_verbs()) {
    CommonOptions common;
    const Options options = options_of(verb, common);
    text += "    " + verb.name + ") options=\"" + spaced(options.names()) + " --help\" ;;\n";
  }
  return text;
}

// Returns the values of options with choices.
std::string choice_cases() {
  std::string text;
  for (const Verb& verb : all_verbs()) {
    CommonOptions common;
    const Options options = options_of(verb, common);
    for (const Option& option : options.all()) {
      if (option.choices.empty() || option.positional()) continue;
      text += "    " + verb.name + ":" + option.name;
      if (!option.short_name.empty()) text += "|" + verb.name + ":" + option.short_name;
      text += ") values=\"" + spaced(option.choices) + "\" ;;\n";
    }
  }
  return text;
}

// Returns the words of positional arguments with choices.
std::string positional_choices() {
  std::string text;
  for (const Verb& verb : all_verbs()) {
    CommonOptions common;
    const Options options = options_of(verb, common);
    for (const Option& option : options.all())
      if (option.positional() && !option.choices.empty())
        text += "    " + verb.name + ") more=\"" + spaced(option.choices) + "\" ;;\n";
  }
  return text;
}

std::string body() {
  return "  local verb=\"${words[1]-}\" options=\"\" more=\"\" values=\"\"\n"
         "  case \"$verb\" in\n" +
         option_cases() + "  esac\n  case \"$verb\" in\n" + positional_choices() +
         "  esac\n  case \"$verb:$previous\" in\n" + choice_cases() + "  esac\n";
}

}  // namespace

std::string bash_completion() {
  return "# bash completion of roadbook: eval \"$(roadbook completion bash)\"\n"
         "_roadbook() {\n"
         "  local current=\"${COMP_WORDS[COMP_CWORD]}\" previous=\"${COMP_WORDS[COMP_CWORD-1]}\"\n"
         "  local words=(\"${COMP_WORDS[@]}\")\n"
         "  COMPREPLY=()\n"
         "  if [ \"$COMP_CWORD\" -eq 1 ]; then\n"
         "    COMPREPLY=($(compgen -W \"" +
         verb_names() +
         " --help --version\" -- \"$current\"))\n"
         "    return\n"
         "  fi\n" +
         body() +
         "  if [ -n \"$values\" ]; then\n"
         "    COMPREPLY=($(compgen -W \"$values\" -- \"$current\"))\n"
         "  elif [[ \"$current\" == -* ]]; then\n"
         "    COMPREPLY=($(compgen -W \"$options\" -- \"$current\"))\n"
         "  else\n"
         "    COMPREPLY=($(compgen -W \"$more\" -- \"$current\") $(compgen -f -- \"$current\"))\n"
         "  fi\n"
         "}\n"
         "complete -o filenames -F _roadbook roadbook\n";
}

std::string zsh_completion() {
  return "#compdef roadbook\n"
         "# zsh completion of roadbook: eval \"$(roadbook completion zsh)\"\n"
         "_roadbook() {\n"
         "  local previous=\"${words[CURRENT-1]}\"\n"
         "  if (( CURRENT == 2 )); then\n"
         "    compadd -- " +
         verb_names() +
         " --help --version\n"
         "    return\n"
         "  fi\n" +
         [] {
           // zsh counts words from 1, so the verb is the second word.
           std::string text = body();
           text.replace(text.find("${words[1]-}"), 12, "${words[2]-}");
           return text;
         }() +
         "  if [[ -n \"$values\" ]]; then\n"
         "    compadd -- ${=values}\n"
         "  elif [[ \"${words[CURRENT]}\" == -* ]]; then\n"
         "    compadd -- ${=options}\n"
         "  else\n"
         "    compadd -- ${=more}\n"
         "    _files\n"
         "  fi\n"
         "}\n"
         "compdef _roadbook roadbook\n";
}

}  // namespace roadbook
