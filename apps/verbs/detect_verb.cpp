#include <memory>

#include "apps/drive_option.hpp"
#include "apps/summaries/detect_summary.hpp"
#include "apps/vehicle_option.hpp"
#include "apps/verb.hpp"
#include "workflows/labels/taught_people.hpp"

namespace roadbook {
namespace {

void add_detect_options(Options& options, DetectRequest& command) {
  PeopleDetectOptions& o = command.options;
  options.add("--map,-m", &command.map, "map file").required = true;
  add_drive_option(options, &command.drives);
  options.add("--session", &command.sessions,
              "session to search; default: all whose drive is there");
  options.add("--oracle", &command.oracle, "session of a simulated drive whose truth answers");
  options.add("--from", &command.from, "another map, whose examples are used too");
  options.add("--anew", &command.anew,
              "forget examples of earlier runs; those of the labelling page stay");
  options.add("--every-s", &o.every_s, "time between two searched frames [s]").range = {0.01, 1.0};
  options
      .add("--probability", &o.min_probability,
           "least probability of a detection; default: a balanced threshold")
      .range = {0.01, 0.999};
  options
      .add("--max-range-m", &o.learner.search.max_range_m,
           "farthest person that is searched, from each camera [m]")
      .range = {2.0, 20.0};
  options.add("--seed", &o.learner.seed, "seed of random negative windows");
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
