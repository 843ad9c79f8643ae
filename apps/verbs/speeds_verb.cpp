#include <memory>

#include "apps/now_option.hpp"
#include "apps/summaries/speeds_summary.hpp"
#include "apps/verb.hpp"

namespace roadbook {

Verb speeds_verb() {
  auto command = std::make_shared<SpeedsRequest>();
  auto now = std::make_shared<std::string>();
  return {"speeds", "computes where people are met and how fast to drive",
          [=](Options& options) {
            options.add("--map,-m", &command->map, "map file, after `roads`").required = true;
            options.add("--detections", &command->detections,
                        "tables of detected people, in the vehicle frame");
            options.add("--observed", &command->observed,
                        "session in which people were searched, even if none was found");
            options.add("--replace", &command->replace,
                        "replace earlier detections of the sessions in the tables");
            options.add("--local", &command->local, "solve only around new detections, to 1e-6");
            options.add("--truth", &command->truth,
                        "people, spaces and crossings from the truth of simulated drives");
            options
                .add("--days-later", &command->days_later,
                     "speed map for a later date [days], without new visits")
                .range = {0.0, 36500.0};
            options.add("--now", now.get(),
                        "time for which ages count (UTC); without: the end of the newest session, "
                        "or of the newest item of a layer if that is later");
            options.add("--config", &command->config, "YAML file of priors, speeds and limits");
          },
          [=](Console& console, const CommonOptions&) {
            command->now_ns = now_option(*now);
            print_speeds(console, make_speeds(*command));
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
