#include "workflows/diagnosis/diagnosis_ledger.hpp"

#include <array>
#include <utility>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "mapping/store/map_event_log.hpp"
#include "mapping/store/map_file.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

constexpr const char* kLog = "diagnosis";
constexpr std::array kViewedTables{"sessions",  "cameras",   "wheel_models", "map_frames",
                                   "keyframes", "landmarks", "descriptors",  "observations"};

std::string gain_of(const ordered_json& finding) {
  return ", gain " + finding.at("gain").at("total").dump() + " nats";
}

}  // namespace

std::string viewed_content(const std::filesystem::path& map) {
  Sha256 digest;
  const MapMeta meta = load_meta(map);
  for (const char* table : kViewedTables)
    if (const auto found = meta.table_digests.find(table); found != meta.table_digests.end())
      digest.update(std::string_view(table)).update(std::string_view(found->second));
  return digest.hex();
}

std::vector<LedgerRun> read_ledger(const std::filesystem::path& map) {
  std::vector<LedgerRun> runs;
  for (const std::string& event : read_event_log(map, kLog)) {
    try {
      const ordered_json json = ordered_json::parse(event);
      runs.push_back({json.at("drive").get<std::string>(),
                      json.at("drive_digest").get<std::string>(), json.at("options"),
                      json.at("result"), json.value("map_digest", "")});
    } catch (const ordered_json::exception& fault) {
      throw BadInput({Severity::kError, map.string(), static_cast<std::int64_t>(runs.size() + 1),
                      "diagnosis_events", fault.what(), "a run of diagnose"});
    }
  }
  return runs;
}

std::int64_t add_to_ledger(const std::filesystem::path& map, const LedgerRun& run) {
  ordered_json json = {{"drive", run.drive},
                       {"drive_digest", run.drive_digest},
                       {"options", run.options},
                       {"result", run.result}};
  if (!run.map_digest.empty()) json["map_digest"] = run.map_digest;
  return MapEventLog(map, kLog).append(json.dump());
}

std::vector<std::string> ledger_lines(const LedgerRun& run) {
  std::vector<std::string> lines;
  for (const ordered_json& cause : run.result.at("causes")) {
    const auto name = cause.at("effect").get<std::string>();
    const std::string size = cause.at("size").dump();
    lines.push_back(name + " = " + size + " " + cause.at("unit").get<std::string>() + " (" +
                    cause.at("interval95")[0].dump() + " to " + cause.at("interval95")[1].dump() +
                    ")" + gain_of(cause) + "; change: effects: " + name + ": " + size);
  }
  for (const ordered_json& unknown : run.result.at("unknown"))
    lines.push_back("unknown: " + unknown.at("stream").get<std::string>() + "." +
                    unknown.at("hook").get<std::string>() + " depends on " +
                    unknown.at("depends_on").get<std::string>() + gain_of(unknown) +
                    "; change: none");
  return lines;
}

}  // namespace roadbook
