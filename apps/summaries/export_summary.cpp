#include "apps/summaries/export_summary.hpp"

#include <nlohmann/json.hpp>

namespace roadbook {
namespace {

nlohmann::ordered_json say_what_is_left_out(const ExportNotes& notes, const Console& console) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const ExportNote& note : notes) {
    console.note(std::to_string(note.count) + " " + note.what + ": not in the file: " + note.why);
    list.push_back({{"what", note.what}, {"count", note.count}, {"why", note.why}});
  }
  return list;
}

}  // namespace

void print_export(const Console& console, const ExportResult& result, const std::string& format) {
  console.warn(result.warnings);
  nlohmann::ordered_json files = nlohmann::ordered_json::array();
  for (const auto& file : result.files) {
    console.say("wrote " + file.string());
    files.push_back(file.string());
  }
  std::string rasters;
  for (const std::string& name : result.rasters_left_out)
    rasters += (rasters.empty() ? "" : ", ") + name;
  if (!rasters.empty())
    console.note("rasters are not in it: " + rasters + "; --format geotiff writes them");
  console.result({{"format", format},
                  {"files", files},
                  {"left_out", say_what_is_left_out(result.left_out, console)}});
}

}  // namespace roadbook
