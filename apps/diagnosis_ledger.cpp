#include "apps/diagnosis_ledger.hpp"

#include <utility>

#include "base/error.hpp"
#include "mapping/map_file.hpp"
#include "mapping/map_layers.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kRuns = "diagnosis_runs";
constexpr const char* kLedger = "diagnosis_ledger";

PlainTable runs_table(const std::vector<LedgerRun>& runs) {
  PlainTable table{kRuns,
                   {{"run", FieldType::kInteger},
                    {"drive", FieldType::kText},
                    {"drive_digest", FieldType::kText},
                    {"options", FieldType::kText},
                    {"result", FieldType::kText}},
                   {}};
  for (const LedgerRun& run : runs)
    table.rows.push_back({static_cast<std::int64_t>(table.rows.size() + 1), run.drive,
                          run.drive_digest, run.options.dump(), run.result.dump()});
  return table;
}

FieldValue number(const Json& value) {
  return value.is_number() ? FieldValue{value.get<double>()} : FieldValue{};
}

// A line a cause. What has no name changes no model: its `change` says so.
void add_lines(std::int64_t run, const Json& result, PlainTable& table) {
  for (const Json& cause : result.at("causes")) {
    const auto name = cause.at("effect").get<std::string>();
    table.rows.push_back({run, name, number(cause.at("size")), number(cause.at("interval95")[0]),
                          number(cause.at("interval95")[1]), cause.at("unit").get<std::string>(),
                          number(cause.at("p")), number(cause.at("evidence")),
                          "effects: " + name + ": " + cause.at("size").dump(),
                          number(cause.at("gain").at("total")),
                          number(cause.at("gain").at("interval95")[0]),
                          number(cause.at("gain").at("interval95")[1])});
  }
  for (const Json& unknown : result.at("unknown")) {
    const auto name = "unknown: " + unknown.at("stream").get<std::string>() + "." +
                      unknown.at("hook").get<std::string>() + " depends on " +
                      unknown.at("depends_on").get<std::string>();
    table.rows.push_back({run,
                          name,
                          {},
                          {},
                          {},
                          unknown.at("unit").get<std::string>(),
                          number(unknown.at("p")),
                          {},
                          std::string("none: no name explains it"),
                          number(unknown.at("gain").at("total")),
                          number(unknown.at("gain").at("interval95")[0]),
                          number(unknown.at("gain").at("interval95")[1])});
  }
}

PlainTable ledger_table(const std::vector<LedgerRun>& runs) {
  PlainTable table{kLedger,
                   {{"run", FieldType::kInteger},
                    {"cause", FieldType::kText},
                    {"size", FieldType::kReal},
                    {"size_low", FieldType::kReal},
                    {"size_high", FieldType::kReal},
                    {"unit", FieldType::kText},
                    {"p", FieldType::kReal},
                    {"evidence_nats", FieldType::kReal},
                    {"change", FieldType::kText},
                    {"gain_nats", FieldType::kReal},
                    {"gain_low", FieldType::kReal},
                    {"gain_high", FieldType::kReal}},
                   {}};
  for (std::size_t i = 0; i < runs.size(); ++i)
    add_lines(static_cast<std::int64_t>(i + 1), runs[i].result, table);
  return table;
}

}  // namespace

std::vector<LedgerRun> read_ledger(const std::filesystem::path& map) {
  const MapLayers layers(map);
  std::vector<LedgerRun> runs;
  if (!layers.has(kRuns)) return runs;
  for (const auto& row : layers.read_table(kRuns).rows) {
    try {
      LedgerRun run;
      run.drive = std::get<std::string>(row.at(1));
      run.drive_digest = std::get<std::string>(row.at(2));
      run.options = Json::parse(std::get<std::string>(row.at(3)));
      run.result = Json::parse(std::get<std::string>(row.at(4)));
      runs.push_back(std::move(run));
    } catch (const std::exception&) {
      throw BadInput({Severity::kError, map.string(), 0, kRuns,
                      "a damaged row " + std::to_string(runs.size() + 1), "a run of diagnose"});
    }
  }
  return runs;
}

std::size_t add_to_ledger(const std::filesystem::path& map, const LedgerRun& run) {
  MapUpdate update(map);  // holds the lock while the runs are read
  std::vector<LedgerRun> runs = read_ledger(map);
  runs.push_back(run);
  update.write_table(runs_table(runs));
  update.write_table(ledger_table(runs));
  update.note("diagnose", "run " + std::to_string(runs.size()) + " of " + run.drive);
  update.commit();
  return runs.size();
}

}  // namespace roadbook
