#include <memory>
#include <nlohmann/json.hpp>

#include "apps/format.hpp"
#include "apps/verb.hpp"
#include "base/text.hpp"
#include "sim/scenario.hpp"
#include "sim/simulate.hpp"

namespace roadbook {
namespace {

struct SimulateCommand {
  std::string scenario;
  std::filesystem::path output;
  std::vector<std::string> effects;
  ScenarioOptions scenario_options;
  SimulateOptions options;
};

// "wheels0.radius=0.01"
void add_effect(const std::string& text, EffectSizes& sizes) {
  const auto equals = text.find('=');
  const auto size =
      equals == std::string::npos ? std::nullopt : parse_double(text.substr(equals + 1));
  if (!size) throw InvalidOption("--effect", "'" + text + "'", "SENSOR.EFFECT=SIZE");
  sizes[text.substr(0, equals)] = *size;
}

ExitStatus run(const SimulateCommand& command, Console& console, const CommonOptions& common) {
  SimulateOptions options = command.options;
  options.num_threads = common.threads;
  for (const std::string& effect : command.effects) add_effect(effect, options.effects);
  const Scenario scenario = load_scenario(command.scenario, command.scenario_options);
  const SimulationSummary made = simulate(scenario, command.output, options, console.progress());
  console.say(std::to_string(made.frames) + " frames, " + fixed(made.length_m, 1) + " m, " +
              fixed(made.seconds, 1) + " s of driving");
  console.say("drive: " + command.output.string());
  console.result({{"drive", command.output.string()},
                  {"scenario", scenario.name},
                  {"frames", made.frames},
                  {"length_m", made.length_m},
                  {"seconds", made.seconds}});
  return ExitStatus::kDone;
}

}  // namespace

Verb simulate_verb() {
  auto command = std::make_shared<SimulateCommand>();
  return {
      "simulate", "renders a drive through a scenario, with its truth",
      [command](Options& options) {
        ScenarioOptions& place = command->scenario_options;
        options.add("SCENARIO", &command->scenario, "stuttgart, zurich, road, or a YAML file")
            .required = true;
        options.add("--output,-o", &command->output, "folder of the drive to write").required =
            true;
        options.add("--size", &place.size, "size of the place: full, small");
        options.add("--visit", &place.visit, "0: initial visit; 1, 2, ...: revisits").range = {
            0, 1000};
        options.add("--image-scale", &place.image_scale, "of the images' size").range = {0.05, 2.0};
        options.add("--effect", &command->effects, "imperfection: SENSOR.EFFECT=SIZE");
        options.add("--seed", &command->options.seed, "of everything drawn by chance");
      },
      [command](Console& console, const CommonOptions& common) {
        return run(*command, console, common);
      }};
}

}  // namespace roadbook
