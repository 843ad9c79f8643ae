#include <memory>
#include <nlohmann/json.hpp>

#include "apps/summary_json.hpp"
#include "apps/verb.hpp"
#include "drive/check.hpp"
#include "drive/import.hpp"

namespace roadbook {
namespace {

struct ImportCommand {
  std::string format;
  std::filesystem::path source;
  std::filesystem::path output;
  ImportOptions options;
};

ExitStatus run(const ImportCommand& command, Console& console) {
  const ImportResult made = import_drive(command.format, command.source, command.output,
                                         command.options, console.progress());
  console.warn(made.warnings);
  const DriveReport report = check_drive(command.output);
  console.warn(report.problems);
  console.say(std::to_string(report.frames) + " frames of " + std::to_string(report.cameras) +
              " cameras" + (report.has_wheels ? ", wheels" : ", no wheels"));
  console.say("drive: " + command.output.string());
  console.result({{"drive", command.output.string()},
                  {"frames", report.frames},
                  {"cameras", report.cameras},
                  {"wheels", report.has_wheels},
                  {"images", made.images},
                  {"wheel_rows", made.wheel_rows},
                  {"imu_rows", made.imu_rows},
                  {"poses", made.poses},
                  {"warnings", to_json(made.warnings)},
                  {"problems", to_json(report.problems)}});
  return report.usable ? ExitStatus::kDone : ExitStatus::kBadInput;
}

}  // namespace

Verb import_verb() {
  auto command = std::make_shared<ImportCommand>();
  return {"import", "converts a recording of another layout into a drive",
          [command](Options& options) {
            Option& format = options.add("FORMAT", &command->format, "layout of the recording");
            format.required = true;
            format.choices = import_formats();
            options.add("SOURCE", &command->source, "recording").required = true;
            options.add("--output,-o", &command->output, "folder of the drive to write").required =
                true;
            ImportOptions& how = command->options;
            options.add("--camera-height-m", &how.camera_height_m, "kitti: of the first camera")
                .range = {0.1, 10.0};
            options
                .add("--camera-forward-m", &how.camera_forward_m, "kitti: ahead of the rear axle")
                .range = {-10.0, 10.0};
            options.add("--overwrite", &how.overwrite, "replace a drive that is there");
          },
          [command](Console& console, const CommonOptions&) { return run(*command, console); }};
}

}  // namespace roadbook
