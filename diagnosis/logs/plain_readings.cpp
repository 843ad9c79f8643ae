#include "diagnosis/logs/plain_readings.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "diagnosis/logs/plain_streams.hpp"

namespace roadbook {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// Interpolates between two poses at most `max_gap_s` apart.
std::optional<PoseSample> pose_at(const std::vector<PoseSample>& poses, double t_s) {
  constexpr double kMaxGap = 2.0;  // [s]
  const auto after = std::lower_bound(poses.begin(), poses.end(), t_s,
                                      [](const PoseSample& p, double t) { return p.t_s < t; });
  if (after == poses.end()) return std::nullopt;
  if (after->t_s == t_s) return *after;
  if (after == poses.begin() || after->t_s - (after - 1)->t_s > kMaxGap) return std::nullopt;
  const PoseSample& a = *(after - 1);
  const double f = (t_s - a.t_s) / (after->t_s - a.t_s);
  const double turned = std::remainder(after->heading - a.heading, 2.0 * std::numbers::pi);
  return PoseSample{t_s, a.x + f * (after->x - a.x), a.y + f * (after->y - a.y),
                    a.heading + f * turned};
}

std::vector<double> column(StreamReader& table, YamlMap& yaml, const std::string& key, Quantity q) {
  const auto spec = read_value_spec(yaml, key, q);
  if (!spec) {
    yaml.report(key, "nothing", "its column");
    return {};
  }
  return table.values(*spec, key);
}

// Mounting position of a sensor on the vehicle.
struct Mount {
  double forward = 0.0, left = 0.0;
  explicit Mount(YamlMap& yaml) {
    yaml.read("sensor_forward_m", forward, {-100.0, 100.0});
    yaml.read("sensor_left_m", left, {-100.0, 100.0});
  }
  [[nodiscard]] Eigen::Vector2d at(const PoseSample& p) const {
    const double c = std::cos(p.heading), s = std::sin(p.heading);
    return {p.x + c * forward - s * left, p.y + s * forward + c * left};
  }
};

void read_scans(YamlMap& yaml,
                const TableFormat& common,
                const std::filesystem::path& folder,
                ProblemList& problems,
                PlainLog& log) {
  const StreamSpec spec = read_stream_spec(yaml, "scans", common, folder);
  StreamReader table(spec, problems, log.notes);
  const Mount mount(yaml);
  std::string first;
  int beams = 0;
  double from = 0.0, step = 0.0, max_m = 0.0;
  yaml.require("first_beam", first);
  yaml.require("beams", beams, Range{1.0, 1e5});
  yaml.require("from_deg", from);
  yaml.require("step_deg", step);
  yaml.require("max_m", max_m, Range{0.1, 1e3});
  const auto& names = table.table().names;
  const auto at = std::find(names.begin(), names.end(), first);
  if (at == names.end() || names.end() - at < beams) {
    problems.error(table.table().file, table.table().header_line, "scans.first_beam", first,
                   "the name of a column that " + std::to_string(beams) + " begin with");
    return;
  }
  std::vector<RangeBeam> all;
  std::vector<std::vector<double>> ranges;
  for (int b = 0; b < beams; ++b) {
    ValueSpec value;
    value.column = *(at + b);
    value.unit = *find_unit(Quantity::kLength, "m");
    ranges.push_back(table.values(value, "beam"));
    if (ranges.back().size() != table.stamps().size()) return;
  }
  for (std::size_t i = 0; i < table.stamps().size(); ++i) {
    const auto pose = pose_at(log.streams.poses, table.stamps()[i]);
    if (!pose) continue;
    for (int b = 0; b < beams; ++b) {
      const auto beam = static_cast<std::size_t>(b);
      const double a = pose->heading + (from + step * b) * kDegree;
      RangeBeam one;
      one.t_s = pose->t_s;
      one.beam = beam;
      one.origin = mount.at(*pose);
      one.along = {std::cos(a), std::sin(a)};
      one.range_m = ranges[beam][i];
      all.push_back(one);
    }
  }
  log.readings.ranges = expect_ranges(all, max_m);
}

void read_beacons(YamlMap& yaml,
                  const TableFormat& common,
                  const std::filesystem::path& folder,
                  ProblemList& problems,
                  PlainLog& log) {
  std::map<long, Eigen::Vector2d> places;
  if (auto at = yaml.map("places")) {
    TableFormat format = common;
    format.read(*at, folder);
    const LogTable table = read_plain_table(format, problems);
    const auto read = [&](const char* key) {
      std::string name;
      at->require(key, name);
      return numbers_of(table, {name, std::string("beacons.places.") + key}, problems);
    };
    const auto id = read("id"), x = read("x"), y = read("y");
    if (x.size() == id.size() && y.size() == id.size())
      for (std::size_t i = 0; i < id.size(); ++i) places[std::lround(id[i])] = {x[i], y[i]};
  } else {
    yaml.report("places", "nothing", "the positions of the beacons: file, id, x, y");
  }
  TableFormat format = common;
  format.read(yaml, folder);
  const LogTable table = read_plain_table(format, problems);
  const Mount mount(yaml);
  const auto read = [&](const char* key, Quantity q) {
    const auto value = read_value_spec(yaml, key, q);
    if (!value) yaml.report(key, "nothing", "its column");
    if (!value) return std::vector<double>{};
    const ColumnUse use{value->column, std::string("beacons.") + key,
                        value->scale * value->unit.to_si, value->offset};
    return numbers_of(table, use, problems);
  };
  const auto t = read("time", Quantity::kTime);
  const auto id = read("id", Quantity::kNumber);
  const auto range = read("range", Quantity::kLength);
  if (id.size() != t.size() || range.size() != id.size()) return;
  std::vector<BeaconRange> samples;
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < id.size(); ++i) {
    const auto pose = pose_at(log.streams.poses, format.since_begin(t[i]));
    const bool whole = std::abs(id[i]) <= 1e9;
    const auto beacon = whole ? places.find(std::lround(id[i])) : places.end();
    unknown += beacon == places.end();
    if (!pose || beacon == places.end()) continue;
    const Eigen::Vector2d antenna = mount.at(*pose);
    BeaconRange r;
    r.t_s = pose->t_s;
    r.beacon = static_cast<int>(beacon->first);
    r.read_m = range[i];
    r.expected_m = (beacon->second - antenna).norm();
    r.x = antenna.x();
    r.y = antenna.y();
    r.heading = pose->heading;
    r.bearing = std::remainder(
        std::atan2(beacon->second.y() - antenna.y(), beacon->second.x() - antenna.x()) -
            pose->heading,
        2.0 * std::numbers::pi);
    samples.push_back(r);
  }
  // Beacons may answer late, so stamps need not ascend.
  std::stable_sort(samples.begin(), samples.end(),
                   [](const BeaconRange& a, const BeaconRange& b) { return a.t_s < b.t_s; });
  log.readings.beacons = beacon_readings(std::move(samples));
  if (unknown > 0)
    log.notes.push_back(std::to_string(unknown) +
                        " ranges to beacons of unknown position left out");
}

void read_friction(YamlMap& yaml,
                   const TableFormat& common,
                   const std::filesystem::path& folder,
                   ProblemList& problems,
                   PlainLog& log) {
  StreamReader table(read_stream_spec(yaml, "friction", common, folder), problems, log.notes);
  const auto value = column(table, yaml, "value", Quantity::kNumber);
  std::vector<double> surface;
  const bool labelled = yaml.has("surface");
  if (labelled) surface = column(table, yaml, "surface", Quantity::kNumber);
  std::vector<double> temperature;
  const bool warm = yaml.has("temperature_c");
  if (warm) temperature = column(table, yaml, "temperature_c", Quantity::kNumber);
  double sigma = 0.05;
  yaml.read("sigma", sigma, {1e-6, 10.0});
  const std::size_t n = table.stamps().size();
  if (value.size() != n || (labelled && surface.size() != n) || (warm && temperature.size() != n))
    return;
  std::vector<RawFriction> raw;
  for (std::size_t i = 0; i < n; ++i) {
    raw.push_back({table.stamps()[i], value[i], sigma, std::nullopt, std::nullopt});
    if (labelled && std::abs(surface[i]) <= 1e9)
      raw.back().surface = static_cast<int>(std::lround(surface[i]));
    if (warm) raw.back().temperature_c = temperature[i];
  }
  log.readings.friction = friction_readings(log.streams.poses, raw);
}

}  // namespace

void read_plain_readings(YamlMap& yaml,
                         const TableFormat& common,
                         const std::filesystem::path& folder,
                         ProblemList& problems,
                         PlainLog& log) {
  if (auto scans = yaml.map("scans")) read_scans(*scans, common, folder, problems, log);
  if (auto beacons = yaml.map("beacons")) read_beacons(*beacons, common, folder, problems, log);
  if (auto friction = yaml.map("friction")) read_friction(*friction, common, folder, problems, log);
}

}  // namespace roadbook
