#include "sim/scenario/scenario.hpp"

#include <algorithm>
#include <filesystem>

#include "base/error.hpp"
#include "base/text.hpp"
#include "base/text_file.hpp"
#include "sim/scenario/scenario_parser.hpp"

namespace roadbook {
namespace {

std::string list_of_builtins() {
  std::string text = "a file or one of";
  for (const auto& name : builtin_scenarios()) text += " " + name;
  return text;
}

}  // namespace

Scenario parse_scenario(const std::string& text,
                        const std::string& file,
                        const ScenarioOptions& options) {
  if (!(options.image_scale >= 0.05 && options.image_scale <= 2.0))
    throw InvalidOption("image_scale", std::to_string(options.image_scale), "0.05 to 2");
  YamlReader root = YamlReader::parse(text, file);
  if (options.size != "full") {
    const auto sizes = root.find("sizes");
    const auto chosen = sizes ? sizes->find(options.size) : std::nullopt;
    if (!chosen)
      throw BadInput(Problem{Severity::kError, file, 0, "size", options.size,
                             "full or a size that the scenario lists under 'sizes'"});
    root = root.overridden_by(*chosen);
  }
  Scenario scenario = read_scenario(root, file);
  if (options.visit < 0 || options.visit >= static_cast<int>(scenario.laps.size()))
    throw InvalidOption("visit", std::to_string(options.visit),
                        "0 to " + std::to_string(scenario.laps.size() - 1));
  scenario.visit = options.visit;
  scenario.size = options.size;
  const auto scaled = [&](int pixels) {
    return std::max(16, static_cast<int>(pixels * options.image_scale / 4.0 + 0.5) * 4);
  };
  scenario.cameras.width = scaled(scenario.cameras.width);
  scenario.cameras.height = scaled(scenario.cameras.height);
  return scenario;
}

Scenario load_scenario(const std::string& name_or_file, const ScenarioOptions& options) {
  const std::string builtin = builtin_scenario_text(name_or_file);
  if (!builtin.empty()) return parse_scenario(builtin, name_or_file + ".yaml", options);
  if (!std::filesystem::is_regular_file(name_or_file)) {
    const auto near = nearest_name(name_or_file, builtin_scenarios());
    throw BadInput(Problem{Severity::kError, name_or_file, 0, "scenario", "no such file",
                           near ? "'" + *near + "'" : list_of_builtins()});
  }
  return parse_scenario(read_regular_file(name_or_file, "a scenario"), name_or_file, options);
}

}  // namespace roadbook
