#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/yaml.hpp"
#include "diagnosis/logs/plain_log.hpp"
#include "diagnosis/logs/plain_table.hpp"
#include "diagnosis/logs/plain_units.hpp"

namespace roadbook {

// One stream of a plain log at a time: its mapping in the YAML, its columns, its samples. Internal
// to plain_log.cpp, which knows the order in which streams need each other.

/// Samples of one value; a stream of several has them side by side.
struct Series {
  std::vector<double> t_s;
  std::vector<double> value;
};

/// What the YAML says of one value's column.
struct ValueSpec {
  std::string column;
  Unit unit;
  double scale = 1.0;  ///< sign included
  double offset = 0.0;
  double ticks_per_turn = 0.0;
  double wraps_at = 0.0;  ///< counts after which a counter begins again; 0: never
};

struct StreamSpec {
  std::string name;
  TableFormat table;
  ValueSpec time;
};

/// Reports keys of streams and columns that stand at the top of a description, where they would
/// mean nothing, and says where they belong.
void refuse_stream_keys(YamlMap& top);
/// Reads table, time and drop_repeats of a stream.
[[nodiscard]] StreamSpec read_stream_spec(YamlMap& yaml,
                                          const std::string& name,
                                          const TableFormat& common,
                                          const std::filesystem::path& folder);
/// Reads `key`'s mapping, or the name of a column in the quantity's first unit.
[[nodiscard]] std::optional<ValueSpec> read_value_spec(YamlMap& yaml,
                                                       const std::string& key,
                                                       Quantity quantity);

/// A stream's table with its stamps, each row checked to come after the one before.
class StreamReader {
 public:
  StreamReader(StreamSpec spec, ProblemList& problems, std::vector<std::string>& notes);
  /// The value of every row that is kept, in SI; ticks become angles, counters are unwrapped.
  [[nodiscard]] std::vector<double> values(const ValueSpec& spec, const std::string& key);
  [[nodiscard]] const std::vector<double>& stamps() const { return t_s_; }
  [[nodiscard]] const LogTable& table() const { return table_; }

 private:
  [[nodiscard]] std::vector<double> column(const ValueSpec& spec, const std::string& key);
  StreamSpec spec_;
  ProblemList& problems_;
  LogTable table_;
  std::vector<double> t_s_;
};

/// A wheel's or vehicle's readings as cumulative angle [rad] of a wheel with this radius.
[[nodiscard]] std::vector<double> cumulative_angle(const std::vector<double>& t_s,
                                                   const std::vector<double>& readings,
                                                   WheelUnit unit,
                                                   double radius_m);

/// Heading by the direction of travel where a log has none: of the chord over `chord_m`, poses
/// between whose neighbours the vehicle has not gone so far keep the last direction.
void derive_course(std::vector<PoseSample>& poses, double chord_m);

/// `value` at each of `at`, linear between samples, constant beyond the ends.
[[nodiscard]] std::vector<double> interpolated(const Series& series, const std::vector<double>& at);

}  // namespace roadbook
