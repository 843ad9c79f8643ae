#include <memory>

#include "apps/output_option.hpp"
#include "apps/report/localisation_picture.hpp"
#include "apps/summaries/localise_summary.hpp"
#include "apps/vehicle_option.hpp"
#include "apps/verb.hpp"
#include "base/text.hpp"
#include "base/whole_file.hpp"

namespace roadbook {

Verb localise_verb() {
  auto command = std::make_shared<LocaliseRequest>();
  auto start = std::make_shared<std::string>();
  auto picture = std::make_shared<std::filesystem::path>();
  auto every = std::make_shared<std::string>("all");
  auto stay_lost = std::make_shared<bool>(false);
  auto landmarks = std::make_shared<int>(3000);
  auto sessions = std::make_shared<std::string>();
  return {
      "localise", "finds the poses of a drive in a map, which stays as it is",
      [=](Options& options) {
        options.add("DRIVE", &command->drive, "recorded drive").required = true;
        options.add("--map,-m", &command->map, "map file").required = true;
        options.add("--output,-o", &command->poses, "TUM trajectory to write").required = true;
        options.add("--frames", &command->frames, "CSV table to write, with a row for each frame");
        options.add("--picture", picture.get(),
                    "SVG file to write: the drive in the map, its uncertainty and its landmarks");
        options.add("--every", every.get(), "frames to localise").choices = {"all", "keyframe"};
        options.add("--start", start.get(),
                    "where the drive begins, X,Y,HEADING in the map [m, m, rad]");
        options.add("--no-relocalise", stay_lost.get(),
                    "do not search the whole map when the pose is not known");
        options.add("--predicted", &command->with_predicted,
                    "write poses by the motion alone to the trajectory too");
        options.add("--landmarks", landmarks.get(), "most landmarks searched for in a frame")
            .range = {50, 100000};
        options.add("--sessions", sessions.get(),
                    "sessions of the map whose views count, A,B; default: all");
        options.add("--model", &command->model, "YAML file of known effects, which are corrected");
        add_vehicle_option(options, &command->vehicle);
        options
            .add("--want", &command->want,
                 "share of frames that must be localised, else exit status 4")
            .range = {0.0, 1.0};
        options.add("--seed", &command->options.localiser.relocalise.seed,
                    "seed of all random numbers");
      },
      [=](Console& console, const CommonOptions& common) {
        refuse_to_replace(command->map, command->poses);
        if (!command->frames.empty()) refuse_to_replace(command->map, command->frames, "--frames");
        if (!picture->empty()) refuse_to_replace(command->map, *picture, "--picture");
        command->options.tracking.num_threads = common.threads;
        command->options.start = start_pose(*start);
        if (!sessions->empty())
          for (const std::string_view name : split(*sessions))
            command->sessions.emplace_back(trim(name));
        command->options.localiser.may_relocalise = !*stay_lost;
        command->options.localiser.fix.near.max_landmarks = static_cast<std::size_t>(*landmarks);
        command->options.localiser.relocalise.descriptors.seed =
            command->options.localiser.relocalise.seed;
        if (*every == "keyframe") command->options.frames = LocalisedFrames::kKeyframes;
        const LocaliseResult result = localise_in_map(*command, console);
        if (!picture->empty()) write_whole_file(*picture, localisation_picture(result));
        print_localisation(console, result);
        if (result.refusal) throw *result.refusal;
        return ExitStatus::kDone;
      }};
}

}  // namespace roadbook
