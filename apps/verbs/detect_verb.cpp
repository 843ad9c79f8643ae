#include <memory>

#include "apps/drive_option.hpp"
#include "apps/label_server/taught_people.hpp"
#include "apps/summaries/detect_summary.hpp"
#include "apps/vehicle_option.hpp"
#include "apps/verb.hpp"

namespace roadbook {
namespace {

void add_detect_options(Options& options, DetectRequest& command) {
  PeopleDetectOptions& o = command.options;
  options.add("--map,-m", &command.map, "map file").required = true;
  add_drive_option(options, &command.drives);
  options.add("--session", &command.sessions,
              "session to look through; default: all whose drive is at hand");
  options.add("--oracle", &command.oracle,
              "session of a simulated drive whose truth plays the labeller");
  options.add("--from", &command.from, "another map, whose learnt examples serve too");
  options.add("--anew", &command.anew,
              "forgets what earlier runs have learnt; what people taught in the page stays");
  options.add("--every-s", &o.every_s, "between two looks [s]").range = {0.01, 1.0};
  options
      .add("--probability", &o.min_probability,
           "of a sighting that counts; default: as like a person as not among what was learnt")
      .range = {0.01, 0.999};
  options
      .add("--max-range-m", &o.learner.search.max_range_m,
           "people are looked for out to here, from each camera [m]")
      .range = {2.0, 20.0};
  options.add("--seed", &o.learner.seed, "of the windows drawn by chance");
}

}  // namespace

Verb detect_verb() {
  auto command = std::make_shared<DetectRequest>();
  auto vehicle = std::make_shared<std::filesystem::path>();
  return {"detect", "finds people in the images of a map's sessions",
          [=](Options& options) {
            add_detect_options(options, *command);
            add_vehicle_option(options, vehicle.get());
          },
          [=](Console& console, const CommonOptions& common) {
            command->options.learner.num_threads = common.threads;
            command->options.vehicle = given_vehicle(*vehicle);
            command->taught_examples = taught_examples;
            print_detections(console, detect_people(*command, console));
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
