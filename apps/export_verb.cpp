#include <memory>
#include <nlohmann/json.hpp>

#include "apps/verb.hpp"
#include "exchange/export_map.hpp"

namespace roadbook {
namespace {

struct ExportCommand {
  std::filesystem::path map;
  std::string format;
  std::filesystem::path output;
  ExportOptions options;
};

}  // namespace

Verb export_verb() {
  auto command = std::make_shared<ExportCommand>();
  return {"export", "writes a map for other programs",
          [command](Options& options) {
            options.add("--map,-m", &command->map, "map file").required = true;
            Option& format = options.add("--format,-f", &command->format, "format");
            format.required = true;
            format.choices = export_formats();
            options.add("--output,-o", &command->output, "file to write").required = true;
          },
          [command](Console& console, const CommonOptions&) {
            const auto files =
                export_map(command->map, command->format, command->output, command->options);
            nlohmann::ordered_json list = nlohmann::ordered_json::array();
            for (const auto& file : files) {
              console.say("wrote " + file.string());
              list.push_back(file.string());
            }
            console.result({{"format", command->format}, {"files", list}});
            return ExitStatus::kDone;
          }};
}

}  // namespace roadbook
