#include <memory>
#include <nlohmann/json.hpp>

#include "apps/named_numbers.hpp"
#include "apps/verb.hpp"
#include "base/format.hpp"
#include "sim/model_effects.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/simulate.hpp"
#include "workflows/settings/effect_model.hpp"

namespace roadbook {
namespace {

struct SimulateCommand {
  std::string scenario;
  std::filesystem::path output;
  std::filesystem::path model;
  std::vector<std::string> effects;
  std::vector<std::string> dying_cameras;
  ScenarioOptions scenario_options;
  SimulateOptions options;
  bool no_images = false;
};

ExitStatus run_simulate(const SimulateCommand& command,
                        Console& console,
                        const CommonOptions& common) {
  SimulateOptions options = command.options;
  options.num_threads = common.threads;
  options.images = !command.no_images;
  const Scenario scenario = load_scenario(command.scenario, command.scenario_options);
  if (!command.model.empty())
    options.effects = effects_without_place_hinge(scenario, read_effect_model(command.model));
  for (const auto& [name, size] : named_numbers("--effect", command.effects, "SENSOR.EFFECT=SIZE"))
    options.effects[name] = size;
  options.camera_dies_s = named_numbers("--camera-dies", command.dying_cameras, "CAMERA=SECONDS");
  const SimulationSummary made = simulate(scenario, command.output, options, console.progress());
  console.say(std::to_string(made.frames) + " frames, " + fixed(made.distance_m, 1) + " m, " +
              fixed(made.duration_s, 1) + " s of driving");
  console.say("drive: " + command.output.string());
  console.result({{"drive", command.output.string()},
                  {"scenario", scenario.name},
                  {"frames", made.frames},
                  {"images", made.images},
                  {"distance_m", made.distance_m},
                  {"duration_s", made.duration_s},
                  {"render_cpu_s", made.render_cpu_s},
                  {"parked_cars", made.parked_cars},
                  {"pedestrians", made.pedestrians}});
  return ExitStatus::kDone;
}

}  // namespace

Verb simulate_verb() {
  auto command = std::make_shared<SimulateCommand>();
  return {
      "simulate", "renders a drive through a scenario, with its truth",
      [command](Options& options) {
        ScenarioOptions& place = command->scenario_options;
        options.add("SCENARIO", &command->scenario, "a built-in place, or a YAML file").required =
            true;
        options.add("--output,-o", &command->output, "folder of the drive to write").required =
            true;
        options.add("--size", &place.size, "size of the place: full, small");
        options
            .add("--visit", &place.visit,
                 "0: first visit; 1, 2, ...: later visits, with other parked cars")
            .range = {0, 1000};
        options.add("--image-scale", &place.image_scale, "factor on the size of the images")
            .range = {0.05, 2.0};
        options.add("--model", &command->model, "YAML file of effects; --effect has priority");
        options.add("--effect", &command->effects,
                    "effect to simulate: SENSOR.EFFECT=SIZE; may be repeated");
        SimulateOptions& drive = command->options;
        options.add("--camera-dies", &command->dying_cameras,
                    "camera that fails after a time: CAMERA=SECONDS");
        options
            .add("--max-duration-s", &drive.max_duration_s,
                 "end of the drive [s]; 0: the whole drive")
            .range = {0.0, 1e6};
        options.add("--class-images", &drive.class_images,
                    "write class images: what each pixel shows");
        options.add("--range-images", &drive.range_images,
                    "write range images: distance of each pixel");
        options.add("--ranges", &drive.ranges, "write readings of a range scanner");
        options.add("--detections", &drive.detections, "write detections of a person detector");
        options.add("--temperature", &drive.temperature,
                    "write the tyres' temperature with the friction");
        options.add("--no-images", &command->no_images, "write motion and readings only");
        options.add("--overwrite", &drive.overwrite, "replace an existing drive");
        options.add("--seed", &command->options.seed, "seed of all random numbers");
      },
      [command](Console& console, const CommonOptions& common) {
        return run_simulate(*command, console, common);
      }};
}

}  // namespace roadbook
