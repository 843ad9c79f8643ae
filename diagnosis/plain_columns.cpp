#include "diagnosis/plain_columns.hpp"

#include <algorithm>

#include "diagnosis/grammar.hpp"
#include "diagnosis/plain_streams.hpp"

namespace roadbook {
namespace {

// The name as it may stand in a report, or an empty one with the fault reported.
std::string name_of(YamlMap& yaml, const PlainLog& log) {
  std::string name;
  if (!yaml.require("name", name)) return {};
  const auto& columns = log.streams.columns;
  const bool taken = is_grammar_covariate(name) ||
                     std::any_of(columns.begin(), columns.end(),
                                 [&](const LoggedColumn& c) { return c.name == name; });
  if (name.empty() || taken) {
    yaml.report("name", name.empty() ? "nothing" : name,
                taken ? "another name: this one is taken" : "what the column is called");
    return {};
  }
  return name;
}

void read_column(YamlMap& yaml,
                 const TableFormat& common,
                 const std::filesystem::path& folder,
                 ProblemList& problems,
                 PlainLog& log) {
  LoggedColumn column;
  column.name = name_of(yaml, log);
  ValueSpec value;
  value.column = column.name;
  yaml.read("column", value.column);
  yaml.read("unit", column.unit);
  if (yaml.read("scale", value.scale) && value.scale == 0.0) yaml.report("scale", "0", "not zero");
  yaml.read("offset", value.offset);
  const StreamSpec spec = read_stream_spec(yaml, "covariates." + column.name, common, folder);
  if (column.name.empty() || spec.table.file.empty() || spec.time.column.empty()) return;
  StreamReader table(spec, problems, log.notes);
  column.values = table.values(value, "column");
  column.t_s = table.stamps();
  if (column.values.size() == column.t_s.size()) log.streams.columns.push_back(std::move(column));
}

}  // namespace

void read_plain_columns(YamlMap& yaml,
                        const TableFormat& common,
                        const std::filesystem::path& folder,
                        ProblemList& problems,
                        PlainLog& log) {
  for (YamlMap& column : yaml.maps("covariates"))
    read_column(column, common, folder, problems, log);
}

}  // namespace roadbook
