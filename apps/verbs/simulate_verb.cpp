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
    options.effects = effects_beside_place(scenario, read_effect_model(command.model));
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
        options.add("SCENARIO", &command->scenario, "stuttgart, zurich, road, or a YAML file")
            .required = true;
        options.add("--output,-o", &command->output, "folder of the drive to write").required =
            true;
        options.add("--size", &place.size, "size of the place: full, small");
        options.add("--visit", &place.visit, "0: initial visit; 1, 2, ...: revisits").range = {
            0, 1000};
        options.add("--image-scale", &place.image_scale, "of the images' size").range = {0.05, 2.0};
        options.add("--model", &command->model,
                    "YAML file of imperfections; --effect goes before it");
        options.add("--effect", &command->effects, "imperfection: SENSOR.EFFECT=SIZE");
        SimulateOptions& drive = command->options;
        options.add("--camera-dies", &command->dying_cameras,
                    "no images from then on: CAMERA=SECONDS");
        options.add("--max-duration-s", &drive.max_duration_s, "ends the drive early; 0: whole")
            .range = {0.0, 1e6};
        options.add("--class-images", &drive.class_images, "also what every pixel shows");
        options.add("--range-images", &drive.range_images, "also how far every pixel is");
        options.add("--ranges", &drive.ranges, "also a range scanner's readings");
        options.add("--detections", &drive.detections, "also whom a detector of people finds");
        options.add("--temperature", &drive.temperature, "also the tyres' beside the friction");
        options.add("--no-images", &command->no_images, "all but images: motion and readings");
        options.add("--overwrite", &drive.overwrite, "replace a drive that is there");
        options.add("--seed", &command->options.seed, "of everything drawn by chance");
      },
      [command](Console& console, const CommonOptions& common) {
        return run_simulate(*command, console, common);
      }};
}

}  // namespace roadbook
