#include <memory>
#include <nlohmann/json.hpp>

#include "apps/completion_scripts.hpp"
#include "apps/verb.hpp"

namespace roadbook {

Verb completion_verb() {
  auto shell = std::make_shared<std::string>();
  return {"completion", "prints the completion script of a shell",
          [shell](Options& options) {
            Option& option = options.add("SHELL", shell.get(), "shell");
            option.required = true;
            option.choices = {"bash", "zsh"};
          },
          [shell](Console& console, const CommonOptions&) {
            const std::string script = *shell == "bash" ? bash_completion() : zsh_completion();
            console.say(script);
            console.result({{"shell", *shell}, {"script", script}});
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
