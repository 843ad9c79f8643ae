#include "diagnosis/logs/plain_streams.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace roadbook {
namespace {

constexpr double kFullTurn = 2.0 * std::numbers::pi;

// "covariates.NAME" is an entry of a list in the YAML.
std::string stream_in_yaml(const std::string& name) {
  return name.starts_with("covariates.") ? "the covariate" : name;
}

std::string_view default_unit(Quantity quantity) {
  switch (quantity) {
    case Quantity::kTime:
      return "s";
    case Quantity::kLength:
      return "m";
    case Quantity::kAngle:
      return "rad";
    case Quantity::kSpeed:
      return "m/s";
    case Quantity::kTurnRate:
      return "rad/s";
    case Quantity::kNumber:
      return "1";
    case Quantity::kWheel:
      break;
  }
  return "rad";
}

}  // namespace

void refuse_stream_keys(YamlMap& top) {
  struct StreamKey {
    const char* key;
    const char* streams;
  };
  constexpr std::array<StreamKey, 13> kStreamKeys{{{"time", "each stream"},
                                                   {"drop_jumps_m_s", "poses"},
                                                   {"measured_by", "poses"},
                                                   {"course_chord_m", "poses"},
                                                   {"sensor_forward_m", "poses, scans or beacons"},
                                                   {"sensor_left_m", "poses, scans or beacons"},
                                                   {"of", "speed"},
                                                   {"unit", "a column's mapping"},
                                                   {"sign", "a column's mapping"},
                                                   {"scale", "a column's mapping"},
                                                   {"offset", "a column's mapping"},
                                                   {"ticks_per_turn", "a column's mapping"},
                                                   {"wraps_at", "a column's mapping"}}};
  for (const auto& [key, streams] : kStreamKeys) {
    if (!top.has(key)) continue;
    top.ignore(key);
    top.report(key, "this key at the top level", std::string("it within ") + streams);
  }
}

std::optional<ValueSpec> read_value_spec(YamlMap& yaml, const std::string& key, Quantity quantity) {
  if (!yaml.has(key)) return std::nullopt;
  ValueSpec spec;
  spec.unit = *find_unit(quantity, default_unit(quantity));
  if (!yaml.is_map(key)) {
    yaml.read(key, spec.column);
    return spec;
  }
  YamlMap map = *yaml.map(key);
  map.require("column", spec.column);
  if (std::string unit; map.read("unit", unit)) {
    if (const auto found = find_unit(quantity, unit))
      spec.unit = *found;
    else
      map.report("unit", unit, units_of(quantity));
  }
  int sign = 1;
  if (map.read("sign", sign) && sign != 1 && sign != -1)
    map.report("sign", std::to_string(sign), "1 or -1");
  if (map.read("scale", spec.scale) && spec.scale == 0.0) map.report("scale", "0", "not zero");
  spec.scale *= sign;
  map.read("offset", spec.offset);
  map.read("wraps_at", spec.wraps_at, {0.0, 1e19});
  if (spec.unit.ticks) map.require("ticks_per_turn", spec.ticks_per_turn, Range{1e-6, 1e12});
  return spec;
}

StreamSpec read_stream_spec(YamlMap& yaml,
                            const std::string& name,
                            const TableFormat& common,
                            const std::filesystem::path& folder) {
  StreamSpec spec;
  spec.name = name;
  spec.table = common;
  spec.table.read(yaml, folder);
  if (spec.table.file.empty()) yaml.report("file", "nothing", "the table's file");
  if (auto time = read_value_spec(yaml, "time", Quantity::kTime))
    spec.time = *time;
  else
    yaml.report("time", "nothing", "column, unit and offset of the stamps");
  yaml.read("drop_repeats", spec.table.drop_repeats);
  return spec;
}

StreamReader::StreamReader(StreamSpec spec, ProblemList& problems, std::vector<std::string>& notes)
    : spec_(std::move(spec)), problems_(problems), table_(read_plain_table(spec_.table, problems)) {
  const auto stamps = column(spec_.time, "time");
  if (stamps.size() != table_.rows.size()) return;
  LogTable kept = table_;
  kept.rows.clear();
  kept.lines.clear();
  std::vector<std::size_t> late;  // rows
  double before_s = 0.0;          // the last good one before the first of them
  double last_s = 0.0;            // the last good one
  std::size_t repeats = 0;
  for (std::size_t i = 0; i < stamps.size(); ++i) {
    double t_s = spec_.table.since_begin(stamps[i]);
    if (!t_s_.empty() && stamps[i] <= last_s) {
      const bool repeat = stamps[i] == last_s;
      repeats += repeat ? 1 : 0;
      if (spec_.table.drop_repeats && repeat) continue;
      if (late.empty()) before_s = last_s;
      late.push_back(i);
      continue;
    }
    // Stamps within one microsecond stay in order. Their unit is wrong, which stream_faults
    // reports.
    if (!t_s_.empty() && t_s <= t_s_.back())
      t_s = std::nextafter(t_s_.back(), std::numeric_limits<double>::max());
    last_s = stamps[i];
    t_s_.push_back(t_s);
    kept.rows.push_back(std::move(table_.rows[i]));
    kept.lines.push_back(table_.lines[i]);
  }
  // Dropping repeats does not help if stamps decrease.
  const std::string advice = repeats > 0 && !spec_.table.drop_repeats
                                 ? " (drop_repeats: true, in " + stream_in_yaml(spec_.name) +
                                       " or at the top for all streams, drops equal ones)"
                                 : "";
  if (!late.empty())
    problems_.error(table_.file, table_.lines[late.front()], spec_.name + ".time",
                    std::to_string(stamps[late.front()]) + " s after " + std::to_string(before_s) +
                        " s" + and_more_rows(late.size()),
                    "increasing stamps" + advice);
  if (repeats > 0 && spec_.table.drop_repeats)
    notes.push_back(spec_.name + ": " + std::to_string(repeats) + " of " +
                    std::to_string(stamps.size()) + " rows with a repeated stamp dropped");
  table_ = std::move(kept);
}

std::vector<double> StreamReader::column(const ValueSpec& spec, const std::string& key) {
  return numbers_of(
      table_, {spec.column, spec_.name + "." + key, spec.unit.to_si * spec.scale, spec.offset},
      problems_);
}

std::vector<double> StreamReader::values(const ValueSpec& spec, const std::string& key) {
  if (!spec.unit.ticks && spec.wraps_at == 0.0) return column(spec, key);
  // Counters are unwrapped before scale and offset are applied.
  ValueSpec raw = spec;
  raw.scale = 1.0;
  raw.offset = 0.0;
  raw.unit.to_si = 1.0;
  std::vector<double> counts = column(raw, key);
  if (counts.size() != t_s_.size()) return {};
  const double per_count = spec.unit.ticks ? kFullTurn / spec.ticks_per_turn : spec.unit.to_si;
  if (spec.wraps_at > 0.0) {
    double unwrapped = counts.empty() ? 0.0 : std::remainder(counts.front(), spec.wraps_at);
    double before = counts.empty() ? 0.0 : counts.front();
    for (double& c : counts) {
      unwrapped += std::remainder(c - before, spec.wraps_at);
      before = c;
      c = unwrapped;
    }
  }
  for (double& c : counts) c = c * per_count * spec.scale + spec.offset;
  return counts;
}

std::vector<double> cumulative_angle(const std::vector<double>& t_s,
                                     const std::vector<double>& readings,
                                     WheelUnit unit,
                                     double radius_m) {
  std::vector<double> angle(readings);
  switch (unit) {
    case WheelUnit::kAngle:
    case WheelUnit::kTicks:
      break;
    case WheelUnit::kAnglePerRow: {
      double sum = 0.0;
      for (double& a : angle) a = sum += a;
      break;
    }
    case WheelUnit::kLength:
      for (double& a : angle) a /= radius_m;
      break;
    case WheelUnit::kLengthPerRow: {
      double sum = 0.0;
      for (double& a : angle) a = sum += a / radius_m;
      break;
    }
    case WheelUnit::kTurnRate:
    case WheelUnit::kSpeed: {
      // Trapezoidal rule: exact for linear changes of speed between readings.
      const double per_reading = unit == WheelUnit::kSpeed ? 1.0 / radius_m : 1.0;
      double sum = 0.0;
      for (std::size_t i = 0; i < angle.size(); ++i) {
        if (i > 0)
          sum += 0.5 * (readings[i] + readings[i - 1]) * (t_s[i] - t_s[i - 1]) * per_reading;
        angle[i] = sum;
      }
      break;
    }
  }
  return angle;
}

void derive_course(std::vector<PoseSample>& poses, double chord_m) {
  const auto distance = [&](std::size_t a, std::size_t b) {
    return std::hypot(poses[a].x - poses[b].x, poses[a].y - poses[b].y);
  };
  bool known = false;
  double last = 0.0;
  std::size_t first_known = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    std::size_t a = i, b = i;
    while (a > 0 && distance(a, i) < 0.5 * chord_m) --a;
    while (b + 1 < poses.size() && distance(b, i) < 0.5 * chord_m) ++b;
    if (distance(a, b) >= 0.5 * chord_m) {
      last = std::atan2(poses[b].y - poses[a].y, poses[b].x - poses[a].x);
      if (!known) first_known = i;
      known = true;
    }
    poses[i].heading = last;
  }
  for (std::size_t i = 0; i < first_known; ++i) poses[i].heading = poses[first_known].heading;
}

std::vector<double> interpolated(const Series& series, const std::vector<double>& at) {
  std::vector<double> values;
  values.reserve(at.size());
  std::size_t k = 0;
  for (const double t : at) {
    while (k + 1 < series.t_s.size() && series.t_s[k + 1] < t) ++k;
    if (series.t_s.empty() || k + 1 >= series.t_s.size() || t <= series.t_s.front()) {
      values.push_back(series.value.empty()      ? 0.0
                       : t <= series.t_s.front() ? series.value.front()
                                                 : series.value.back());
      continue;
    }
    const double f =
        std::clamp((t - series.t_s[k]) / (series.t_s[k + 1] - series.t_s[k]), 0.0, 1.0);
    values.push_back((1.0 - f) * series.value[k] + f * series.value[k + 1]);
  }
  return values;
}

}  // namespace roadbook
