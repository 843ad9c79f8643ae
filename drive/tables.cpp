#include "drive/tables.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "base/text.hpp"
#include "drive/csv.hpp"
#include "drive/plausible.hpp"
#include "drive/table_faults.hpp"

namespace roadbook {
namespace {

// The numbers of the given columns; false where one of them is bad (all of them are reported).
template <std::size_t N>
bool read_numbers(CsvReader& csv,
                  const std::array<std::optional<std::size_t>, N>& columns,
                  std::array<double, N>& values) {
  bool good = true;
  for (std::size_t i = 0; i < N; ++i) {
    const auto value = csv.number(*columns[i]);
    good = good && value.has_value();
    values[i] = value.value_or(0.0);
  }
  return good;
}

std::string decimals_of(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

StreamSummary close_table(CsvReader& csv,
                          StampCheck& stamps,
                          const std::string& stream,
                          const StampLimits& limits,
                          ProblemList& problems) {
  const StreamSummary summary = stamps.finish(stream, limits);
  if (csv.good() && summary.rows == 0) problems.error(csv.file(), 0, "", "no rows", "at least one");
  return summary;
}

bool read_surface(CsvReader& csv,
                  std::size_t column,
                  FrictionReading& reading,
                  ProblemList& problems) {
  const auto surface = parse_int(csv.fields()[column]);
  if (!surface || *surface < 0 || *surface > 255) {
    problems.error(csv.file(), csv.line(), "surface", printable(csv.fields()[column]),
                   "a class, 0 to 255");
    return false;
  }
  reading.surface = static_cast<int>(*surface);
  return true;
}

// Single rows with forces beyond any IMU's are damaged; else the mean tells the unit.
class ForceCheck {
 public:
  void add(double force_m_s2, std::int64_t line) {
    rare_.add(force_m_s2, line);
    if (force_m_s2 > kMostForce_m_s2)
      ++beyond_;
    else
      good_sum_ += force_m_s2;
    sum_ += force_m_s2;
    ++rows_;
  }
  void report(const std::string& file, ProblemList& problems) const {
    if (rows_ == 0) return;
    const bool few = 20 * beyond_ <= rows_;
    if (few) rare_.report(file, problems, "");
    check_mean_force(
        file,
        few ? good_sum_ / static_cast<double>(rows_ - beyond_) : sum_ / static_cast<double>(rows_),
        problems);
  }

 private:
  ColumnBound rare_{"a_RS_S_x, _y, _z", kMostForce_m_s2,
                    "at most 500 m/s^2, as an IMU on a vehicle feels"};
  double sum_ = 0.0;
  double good_sum_ = 0.0;
  std::size_t rows_ = 0;
  std::size_t beyond_ = 0;
};

// Warns of poses that are farther apart than any vehicle drives. Where most are, they are not in
// metres; a single one is a jump of the reference.
class PoseSpeedCheck {
 public:
  void add(const TimedPose& pose, std::int64_t line) {
    const auto before = std::exchange(before_, pose);
    if (!before) return;
    const double dt_s = static_cast<double>(pose.t_ns - before->t_ns) * 1e-9;
    const double way_m =
        (pose.T_world_vehicle.translation() - before->T_world_vehicle.translation()).norm();
    ++rows_;
    if (way_m <= kFastest_m_s * dt_s + kCorrection_m || ++beyond_ > 1) return;
    std::ostringstream got;
    got << "a way of " << way_m << " m in " << dt_s << " s";
    first_ = got.str();
    first_line_ = line;
  }
  void report(const std::string& file, ProblemList& problems) const {
    if (beyond_ == 0) return;
    const bool most = beyond_ >= 3 && 2 * beyond_ >= rows_;
    problems.warning(file, first_line_, "position",
                     first_ + (beyond_ == 1 ? ""
                                            : ", and the like in " + std::to_string(beyond_) +
                                                  " of " + std::to_string(rows_) + " rows"),
                     most ? "less than 100 m/s (metres?)" : "less than 100 m/s");
  }

 private:
  static constexpr double kFastest_m_s = 100.0;
  static constexpr double kCorrection_m = 5.0;  ///< of a reference that finds its place again
  std::optional<TimedPose> before_;
  std::size_t rows_ = 0;
  std::size_t beyond_ = 0;
  std::string first_;
  std::int64_t first_line_ = 0;
};

}  // namespace

StreamSummary read_truth_table(const std::filesystem::path& file,
                               ProblemList& problems,
                               const RowVisitor<TimedPose>& visit) {
  // A quaternion printed with a few digits is off by 1e-3 at most; farther off it is something
  // else.
  constexpr double kNormTolerance = 1e-2;
  constexpr double kFarthest_m = 1e8;
  PoseSpeedCheck speeds;
  CsvReader csv(file, CsvHeader::kIgnored, problems);
  StampCheck stamps(file.string(), problems);
  while (csv.next()) {
    const std::size_t count = csv.fields().size();
    if (count != 8 && count != 17) {
      problems.error(
          csv.file(), csv.line(), "row",
          std::to_string(count) + " fields" + in_brackets(layout_fault(csv.text(), ',', count, 8)),
          "8 or 17");
      continue;
    }
    const auto t = csv.stamp(0);
    bool good = t.has_value();
    std::array<double, 17> v{};
    for (std::size_t i = 1; i < count; ++i) {
      const auto value = csv.number(i);
      good = good && value.has_value();
      v[i] = value.value_or(0.0);
    }
    if (!good) continue;
    const Eigen::Quaterniond q(v[4], v[5], v[6], v[7]);
    if (!(std::abs(q.norm() - 1.0) <= kNormTolerance)) {
      problems.error(csv.file(), csv.line(), "quaternion", "length " + std::to_string(q.norm()),
                     "1 (w first)");
      continue;
    }
    const double farthest = std::max({std::abs(v[1]), std::abs(v[2]), std::abs(v[3])});
    if (!(farthest <= kFarthest_m)) {
      problems.error(csv.file(), csv.line(), "position", decimals_of(farthest) + " m",
                     "metres, at most 1e8 (earth-centred ones are below 1e7)");
      continue;
    }
    if (!stamps.add(*t, csv.line())) continue;
    TimedPose pose;
    pose.t_ns = *t;
    pose.T_world_vehicle.linear() = q.normalized().toRotationMatrix();
    pose.T_world_vehicle.translation() = Eigen::Vector3d(v[1], v[2], v[3]);
    speeds.add(pose, csv.line());
    visit(pose);
  }
  speeds.report(csv.file(), problems);
  return close_table(csv, stamps, "state_groundtruth_estimate0", {}, problems);
}

StreamSummary read_imu_table(const std::filesystem::path& file,
                             const StampLimits& limits,
                             ProblemList& problems,
                             const RowVisitor<ImuReading>& visit) {
  CsvReader csv(file, CsvHeader::kRequired, problems);
  StampCheck stamps(file.string(), problems);
  if (csv.good()) {
    const auto t_column = csv.require("timestamp", "ns|");
    constexpr const char* kRate = "rad s^-1|rad/s";
    constexpr const char* kForce = "m s^-2|m/s^2";
    const std::array<std::optional<std::size_t>, 6> columns = {
        csv.require("w_RS_S_x", kRate),  csv.require("w_RS_S_y", kRate),
        csv.require("w_RS_S_z", kRate),  csv.require("a_RS_S_x", kForce),
        csv.require("a_RS_S_y", kForce), csv.require("a_RS_S_z", kForce)};
    ColumnBound rate("w_RS_S_x, _y, _z", kMostTurnRate_rad_s,
                     "at most 10 rad/s, as a vehicle turns");
    ForceCheck force;
    while (csv.next()) {
      std::array<double, 6> v{};
      const auto t = csv.stamp(*t_column);
      if (!read_numbers(csv, columns, v) || !t || !stamps.add(*t, csv.line())) continue;
      visit({*t, {v[0], v[1], v[2]}, {v[3], v[4], v[5]}});
      rate.add(std::hypot(v[0], v[1], v[2]), csv.line());
      force.add(std::hypot(v[3], v[4], v[5]), csv.line());
    }
    rate.report(csv.file(), problems, degrees_cause(rate.largest(), kMostTurnRate_rad_s));
    force.report(csv.file(), problems);
  }
  return close_table(csv, stamps, "imu0", limits, problems);
}

StreamSummary read_friction_table(const std::filesystem::path& file,
                                  const StampLimits& limits,
                                  ProblemList& problems,
                                  const RowVisitor<FrictionReading>& visit) {
  CsvReader csv(file, CsvHeader::kRequired, problems);
  StampCheck stamps(file.string(), problems);
  if (csv.good()) {
    const auto t_column = csv.require("timestamp", "ns|");
    const std::array<std::optional<std::size_t>, 2> columns = {csv.require("friction", "-|"),
                                                               csv.require("sigma", "-|")};
    const auto surface_column = csv.find("surface");
    const auto temperature_column = csv.find("temperature");
    if (temperature_column) csv.require("temperature", "degC");
    ColumnBound coefficient("friction", 2.0, "a coefficient, at most 2");
    ColumnBound spread("sigma", 1000.0, "of a coefficient, at most 1000");
    ColumnBound warmth("temperature", 100.0, "degrees Celsius, at most 100");
    while (csv.next()) {
      std::array<double, 2> v{};
      FrictionReading reading;
      const auto t = csv.stamp(*t_column);
      if (!read_numbers(csv, columns, v) || !t) continue;
      if (surface_column && !read_surface(csv, *surface_column, reading, problems)) continue;
      if (temperature_column) {
        reading.temperature_c = csv.number(*temperature_column);
        if (!reading.temperature_c) continue;
      }
      if (!(v[1] > 0.0)) {
        problems.error(csv.file(), csv.line(), "sigma", std::to_string(v[1]), "a positive number");
        continue;
      }
      reading.t_ns = *t;
      reading.friction = v[0];
      coefficient.add(v[0], csv.line());
      spread.add(v[1], csv.line());
      if (reading.temperature_c) warmth.add(*reading.temperature_c, csv.line());
      reading.sigma = v[1];
      if (stamps.add(*t, csv.line())) visit(reading);
    }
    coefficient.report(csv.file(), problems, coefficient.largest() <= 100.0 ? "per cent?" : "");
    spread.report(csv.file(), problems, "");
    warmth.report(csv.file(), problems, warmth.largest() < 400.0 ? "kelvins?" : "");
  }
  return close_table(csv, stamps, "friction0", limits, problems);
}

StreamSummary read_range_table(const std::filesystem::path& file,
                               const StampLimits& limits,
                               ProblemList& problems,
                               const RowVisitor<RangeReading>& visit) {
  CsvReader csv(file, CsvHeader::kRequired, problems);
  StampCheck stamps(file.string(), problems);
  std::int64_t last_t = -1;
  std::int64_t last_beam = -1;
  if (csv.good()) {
    const auto t_column = csv.require("timestamp", "ns|");
    const auto beam_column = csv.require("beam", "|-");
    const auto range_column = csv.require("range", "m");
    ColumnBound distance("range", 1000.0, "at most 1000 m");
    while (csv.next()) {
      const auto t = csv.stamp(*t_column);
      const auto beam = parse_int(csv.fields()[*beam_column]);
      const auto range = csv.number(*range_column);
      if (!beam || *beam < 0)
        problems.error(csv.file(), csv.line(), "beam", printable(csv.fields()[*beam_column]),
                       "a whole number >= 0");
      if (!t || !range || !beam || *beam < 0) continue;
      const bool same_instant = *t == last_t && *beam > last_beam;
      if (!same_instant && !stamps.add(*t, csv.line())) continue;
      distance.add(*range, csv.line());
      last_t = *t;
      last_beam = *beam;
      visit({*t, *beam, *range});
    }
    distance.report(csv.file(), problems, distance.largest() < 1e6 ? "millimetres?" : "");
  }
  return close_table(csv, stamps, "range0", limits, problems);
}

}  // namespace roadbook
