#include <memory>

#include "apps/output_option.hpp"
#include "apps/summaries/calibration_summary.hpp"
#include "apps/verb.hpp"
#include "base/text.hpp"
#include "base/whole_file.hpp"

namespace roadbook {

Verb calibrate_verb() {
  auto command = std::make_shared<CalibrateRequest>();
  auto output = std::make_shared<std::filesystem::path>();
  auto held = std::make_shared<std::string>();
  return {
      "calibrate", "estimates the calibration of cameras and wheels from drives",
      [=](Options& options) {
        options.add("DRIVE", &command->drives, "recorded drives of one vehicle").required = true;
        options.add("--output,-o", output.get(), "model file to write, for --model of other verbs")
            .required = true;
        options.add("--map,-m", &command->map,
                    "map of the drives to start from; default: the drives are mapped");
        options.add("--model", &command->model,
                    "YAML file of known effects, from which the estimate starts");
        options.add("--hold", held.get(),
                    "columns that keep their value, as cam0.focal,wheels0.latency");
        options.add("--seed", &command->options.seed, "seed of all random numbers");
      },
      [=](Console& console, const CommonOptions& common) {
        if (!command->map.empty()) refuse_to_replace(command->map, *output);
        if (!command->model.empty()) refuse_to_replace(command->model, *output);
        if (!held->empty())
          for (const std::string_view name : split(*held)) command->held.emplace_back(name);
        command->options.num_threads = common.threads;
        const CalibrateResult result = calibrate_drives(*command, console);
        if (!result.refusal) write_whole_file(*output, calibrated_model_text(result));
        print_calibration(console, result, *output);
        if (result.refusal) throw *result.refusal;
        return ExitStatus::kDone;
      }};
}

}  // namespace roadbook
