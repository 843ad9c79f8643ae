#include "diagnosis/logs/plain_columns.hpp"

#include <algorithm>
#include <cctype>

#include "diagnosis/friction/friction_columns.hpp"
#include "diagnosis/logs/plain_streams.hpp"
#include "diagnosis/motion/grammar.hpp"
#include "drive/csv.hpp"
#include "sensors/effects.hpp"

namespace roadbook {
namespace {

// A column that was read: its file and position.
struct Taken {
  std::string name;
  std::filesystem::path file;
  std::string matrix, column, time;
};

// What else has this name (a covariate, an effect, a built-in one); empty: nothing.
std::string meaning_of(const std::string& name,
                       bool friction,
                       const PlainLog& log,
                       const std::vector<Taken>& taken) {
  const auto named = [&](const auto& one) { return one.name == name; };
  if (std::any_of(taken.begin(), taken.end(), named)) return "another covariate's";
  const auto effects = all_effects();
  if (std::any_of(effects.begin(), effects.end(), named)) return "an effect's";
  const bool of_friction = friction && is_friction_covariate(name) &&
                           (name != "temperature" || log.readings.friction.has_temperature);
  return of_friction || is_grammar_covariate(name) ? "diagnosis' own" : "";
}

class ColumnReader {
 public:
  ColumnReader(const TableFormat& common,
               const std::filesystem::path& folder,
               bool friction,
               ProblemList& problems,
               PlainLog& log)
      : common_(common), folder_(folder), friction_(friction), problems_(problems), log_(log) {}

  void read(YamlMap& yaml) {
    LoggedColumn column;
    column.name = name_of(yaml);
    ValueSpec value;
    value.column = column.name;
    const bool has_column = !yaml.has("column") || yaml.read("column", value.column);
    yaml.read("unit", column.unit);
    if (yaml.read("scale", value.scale) && value.scale == 0.0)
      yaml.report("scale", "0", "not zero");
    yaml.read("offset", value.offset);
    const StreamSpec spec = read_stream_spec(yaml, "covariates." + column.name, common_, folder_);
    if (column.name.empty() || !has_column || spec.table.file.empty() || spec.time.column.empty() ||
        is_twice(yaml,
                 {column.name, spec.table.file, spec.table.matrix, value.column, spec.time.column}))
      return;
    StreamReader table(spec, problems_, log_.notes);
    column.values = table.values(value, "column");
    column.t_s = table.stamps();
    if (column.values.size() == column.t_s.size()) log_.streams.columns.push_back(column);
  }

 private:
  // The name, checked for use in reports; empty if it is faulty, with the fault reported.
  std::string name_of(YamlMap& yaml) {
    std::string name;
    if (!yaml.require("name", name)) return {};
    const auto control = [](unsigned char c) { return std::iscntrl(c) != 0; };
    if (name.empty() || std::any_of(name.begin(), name.end(), control)) {
      yaml.report("name", name.empty() ? "nothing" : printable(name),
                  "the name of the column, in one line");
      return {};
    }
    const std::string meaning = meaning_of(name, friction_, log_, taken_);
    if (meaning.empty()) return name;
    yaml.report("name", name, "another name: this one is " + meaning);
    return {};
  }

  // Reports a column listed under two names: the two would be confounded.
  bool is_twice(YamlMap& yaml, Taken one) {
    for (const Taken& t : taken_)
      if (t.file == one.file && t.matrix == one.matrix && t.column == one.column &&
          t.time == one.time) {
        yaml.report("column", one.column, "a column that is not listed as " + t.name + " already");
        return true;
      }
    taken_.push_back(std::move(one));
    return false;
  }

  const TableFormat& common_;
  const std::filesystem::path& folder_;
  bool friction_;
  ProblemList& problems_;
  PlainLog& log_;
  std::vector<Taken> taken_;
};

}  // namespace

void read_plain_columns(YamlMap& yaml,
                        const TableFormat& common,
                        const std::filesystem::path& folder,
                        ProblemList& problems,
                        PlainLog& log) {
  ColumnReader reader(common, folder, yaml.has("friction"), problems, log);
  for (YamlMap& column : yaml.maps("covariates")) reader.read(column);
}

}  // namespace roadbook
