#include <memory>

#include "apps/summaries/occupancy_summary.hpp"
#include "apps/verb.hpp"

namespace roadbook {

Verb occupancy_verb() {
  auto command = std::make_shared<OccupancyRequest>();
  auto update = std::make_shared<std::string>("log-odds");
  auto sensor = std::make_shared<std::string>("range0");
  auto temper = std::make_shared<std::string>("auto");
  return {"occupancy", "updates the occupancy grid of a map from a range scanner or cameras",
          [=](Options& options) {
            options.add("DRIVE", &command->drives,
                        "drives of the sensor; none: places the stored patches again");
            options.add("--map,-m", &command->map, "map file").required = true;
            options
                .add("--sensor", sensor.get(),
                     "range scanner, or landmarks of the map that the cameras of its sessions saw")
                .choices = {"range0", "cameras"};
            options
                .add("--update", update.get(),
                     "rule for a cell: log odds, the same as a ratio, or a naive demonstration")
                .choices = {"log-odds", "bayes", "naive"};
            options.add("--model", &command->model,
                        "beam model: fitted (to the drive), nominal, or a YAML file");
            options.add(
                "--temper", temper.get(),
                "weight of a cell's readings after the first, 0 to 1; auto: by their dependence");
            options.add("--cell-m", &command->cell_m, "side of a cell [m]").range = {0.01, 2.0};
            options.add("--patch-m", &command->patch_m, "distance driven within one patch [m]")
                .range = {0.1, 500.0};
            options
                .add("--wide-beam", &command->wide_beam_rad,
                     "full angle of a beam [rad], for ultrasonic sensors; 0: a ray")
                .range = {0.0, 1.6};
            options.add("--replace", &command->replace, "start a new grid");
          },
          [=](Console& console, const CommonOptions& common) {
            command->update = *occupancy_update(*update);
            command->sensor =
                *sensor == "cameras" ? OccupancySensor::kCameras : OccupancySensor::kRange;
            command->temper = temper_option(*temper);
            command->num_threads = common.threads;
            print_occupancy(console, make_occupancy(*command, console));
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
