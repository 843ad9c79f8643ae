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

// Reads one stream of a plain log: its mapping in the YAML, its columns, its samples. Internal to
// plain_log.cpp, which knows the order in which streams need each other.

/// Samples of one value. A stream of several values has one series each.
struct Series {
  std::vector<double> t_s;
  std::vector<double> value;
};

/// The description of one value's column in the YAML.
struct ValueSpec {
  std::string column;
  Unit unit;
  double scale = 1.0;  ///< includes the sign
  double offset = 0.0;
  double ticks_per_turn = 0.0;
  double wraps_at = 0.0;  ///< counts after which a counter restarts; 0: never
};

struct StreamSpec {
  std::string name;
  TableFormat table;
  ValueSpec time;
};

/// Reports keys of streams and columns at the top level of a description, where they have no
/// meaning, and says where they belong.
void refuse_stream_keys(YamlMap& top);
/// Reads the table, its time column and drop_repeats of a stream.
[[nodiscard]] StreamSpec read_stream_spec(YamlMap& yaml,
                                          const std::string& name,
                                          const TableFormat& common,
                                          const std::filesystem::path& folder);
/// Reads the mapping of `key`, or only a column name, which then has the first unit of the
/// quantity. No value if absent.
[[nodiscard]] std::optional<ValueSpec> read_value_spec(YamlMap& yaml,
                                                       const std::string& key,
                                                       Quantity quantity);

/// The table of a stream with its stamps [s since the log's clock begins, whole microseconds].
/// Checks that stamps increase from row to row.
class StreamReader {
 public:
  StreamReader(StreamSpec spec, ProblemList& problems, std::vector<std::string>& notes);
  /// Values of all kept rows in SI units. Ticks become angles [rad]; counters are unwrapped.
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

/// Converts readings of a wheel or vehicle to the cumulative angle [rad] of a wheel of radius
/// `radius_m`.
[[nodiscard]] std::vector<double> cumulative_angle(const std::vector<double>& t_s,
                                                   const std::vector<double>& readings,
                                                   WheelUnit unit,
                                                   double radius_m);

/// Sets headings to the direction of travel for logs without headings: the direction of the chord
/// over `chord_m` [m] of driving. Poses at which the vehicle has not moved that far keep the
/// previous heading.
void derive_course(std::vector<PoseSample>& poses, double chord_m);

/// Values of `series` at the times `at`, interpolated linearly, constant beyond the ends.
[[nodiscard]] std::vector<double> interpolated(const Series& series, const std::vector<double>& at);

}  // namespace roadbook
