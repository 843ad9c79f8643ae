#include <memory>

#include "apps/summaries/speeds_summary.hpp"
#include "apps/verb.hpp"

namespace roadbook {

Verb speeds_verb() {
  auto command = std::make_shared<SpeedsRequest>();
  return {"speeds", "where people are met, and how fast to drive",
          [command](Options& options) {
            options.add("--map,-m", &command->map, "map file, after `roads`").required = true;
            options.add("--detections", &command->detections,
                        "tables of people seen, in the frame of the vehicle");
            options.add("--observed", &command->observed,
                        "session in which people were looked for, though nobody may be in a table");
            options.add("--replace", &command->replace,
                        "sessions in the tables lose the detections they had before");
            options.add("--local", &command->local,
                        "begins from the map's speeds: solves around new rows alone, to 1e-6");
            options.add("--truth", &command->truth,
                        "people, spaces and crossings from the truth of simulated drives");
            options
                .add("--days-later", &command->days_later,
                     "the map as it will be then, if nobody drives there before")
                .range = {0.0, 36500.0};
            options.add("--config", &command->config, "YAML file: priors, speeds, limits");
          },
          [command](Console& console, const CommonOptions&) {
            print_speeds(console, make_speeds(*command));
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
