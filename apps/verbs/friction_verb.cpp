#include <memory>

#include "apps/summaries/friction_summary.hpp"
#include "apps/verb.hpp"

namespace roadbook {

Verb friction_verb() {
  auto command = std::make_shared<FrictionRequest>();
  return {"friction", "learns the ground's friction along the lanes of a map",
          [command](Options& options) {
            options
                .add("DRIVE", &command->drive, "a drive of the map, with class images and friction")
                .required = true;
            options.add("--map,-m", &command->map, "map file, after `roads`").required = true;
            options.add("--config", &command->config,
                        "YAML file: classes, priors, further properties, models");
            options.add("--replace", &command->replace, "start a new friction map");
            options.add("--slice", &command->slice,
                        "friction along a lane for a controller: .json or .h");
            options.add("--property", &command->property, "property of the slice");
            options.add("--lane", &command->lane, "lane of the slice; default: the first");
            options.add("--from-m", &command->from_m, "begin of the slice [m]").range = {0.0, 1e6};
            options.add("--to-m", &command->to_m, "end of the slice [m]; default: end of the lane");
          },
          [command](Console& console, const CommonOptions&) {
            print_friction(console, learn_friction(*command, console), command->drive);
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
