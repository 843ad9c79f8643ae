#include "diagnosis/logs/plain_log.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/logs/local_enu.hpp"
#include "diagnosis/logs/plain_bounds.hpp"
#include "diagnosis/logs/plain_columns.hpp"
#include "diagnosis/logs/plain_readings.hpp"
#include "diagnosis/logs/plain_streams.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "diagnosis/streams/level_motion.hpp"

namespace roadbook {
namespace {

constexpr Range kPositive{1e-6, 1e4};

class LogReader {
 public:
  explicit LogReader(const std::filesystem::path& description)
      : yaml_(YamlMap::load(description)), folder_(description.parent_path()) {
    log_.name = description.stem().string();
  }

  PlainLog read(const std::filesystem::path& description) {
    yaml_.read("name", log_.name);
    if (std::string folder; yaml_.read("folder", folder)) folder_ /= folder;
    common_.read(yaml_, folder_);
    yaml_.read("drop_repeats", common_.drop_repeats);
    refuse_stream_keys(yaml_);
    vehicle();
    if (auto yaml = yaml_.map("poses"))
      poses(*yaml);
    else
      yaml_.report("poses", "nothing", "reference poses (needed for every diagnosis)");
    if (auto yaml = yaml_.map("steering")) steering(*yaml);
    if (auto yaml = yaml_.map("gyro")) gyro(*yaml);
    if (yaml_.has("wheels") && yaml_.has("speed"))
      yaml_.report("speed", "wheels and speed", "one of them");
    if (auto yaml = yaml_.map("wheels")) wheels(*yaml);
    if (auto yaml = yaml_.map("speed")) speed(*yaml);
    window();
    read_plain_readings(yaml_, common_, folder_, problems_, log_);
    read_plain_columns(yaml_, common_, folder_, problems_, log_);
    auto faults = yaml_.finish_problems();
    for (const Problem& p : problems_.problems()) faults.push_back(p);
    if (!faults.empty()) throw BadInput(faults);
    if (!attitudes_.empty()) level_motion(attitudes_, attitudes_, {}, log_.streams);
    shift_clock();
    for (auto& note : implausible_values(log_.streams)) log_.notes.push_back(std::move(note));
    columns_of_friction();
    log_.digest = digest_of(description, common_);
    return std::move(log_);
  }

 private:
  void vehicle() {
    auto yaml = yaml_.map("vehicle");
    if (!yaml)
      return yaml_.report(
          "vehicle", "nothing",
          "radius_m, track_width_m and, with steering, wheelbase_m of the nominal vehicle");
    WheelModel& m = log_.streams.wheel_model;
    if (yaml->read("radius_m", m.radius_left_m, kPositive))
      m.radius_right_m = m.radius_left_m;
    else if (yaml->require("radius_left_m", m.radius_left_m, kPositive))
      yaml->require("radius_right_m", m.radius_right_m, kPositive);
    has_track_ = yaml->read("track_width_m", m.track_width_m, kPositive);
    if (yaml_.has("steering") || yaml_.has("speed"))
      yaml->require("wheelbase_m", m.wheelbase_m, kPositive);
    else
      yaml->read("wheelbase_m", m.wheelbase_m, kPositive);
    yaml->read("steering_ratio", m.steering_ratio, {1e-3, 1e3});
    yaml->read("sigma_angle_rad", m.sigma_angle_rad, {1e-9, 10.0});
    if (yaml_.has("wheels") && !yaml->has("track_width_m"))
      yaml->report("track_width_m", "nothing", "a number (two wheels measure turns through it)");
  }

  // Values of `key`; empty if faulty, with the fault reported.
  std::vector<double> column(StreamReader& table,
                             YamlMap& yaml,
                             const std::string& key,
                             Quantity q) {
    return column(table, yaml, key, read_value_spec(yaml, key, q));
  }

  std::vector<double> column(StreamReader& table,
                             YamlMap& yaml,
                             const std::string& key,
                             const std::optional<ValueSpec>& spec) {
    if (!spec) yaml.report(key, "nothing", "its column");
    return spec ? table.values(*spec, key) : std::vector<double>{};
  }

  void poses(YamlMap& yaml) {
    StreamReader table(read_stream_spec(yaml, "poses", common_, folder_), problems_, log_.notes);
    const bool geodetic = yaml.has("latitude");
    std::vector<double> x, y;
    if (geodetic)
      from_geodetic(table, yaml, x, y);
    else {
      x = column(table, yaml, "x", Quantity::kLength);
      y = column(table, yaml, "y", Quantity::kLength);
    }
    std::vector<double> heading;
    const bool derived = !yaml.has("heading");
    if (!derived) heading = column(table, yaml, "heading", Quantity::kAngle);
    measured_by(yaml);
    double chord = 1.0;
    yaml.read("course_chord_m", chord, {1e-3, 1e3});
    double forward = 0.0, left = 0.0;
    yaml.read("sensor_forward_m", forward, {-100.0, 100.0});
    yaml.read("sensor_left_m", left, {-100.0, 100.0});
    double drop_m = 0.0;
    yaml.read("drop_jumps_m_s", drop_m, {0.0, 1e3});
    const std::size_t n = table.stamps().size();
    if (x.size() != n || y.size() != n || (!derived && heading.size() != n)) return;
    auto& poses = log_.streams.poses;
    for (std::size_t i = 0; i < n; ++i)
      poses.push_back({table.stamps()[i], x[i], y[i], derived ? 0.0 : heading[i]});
    read_attitudes(table, yaml);
    if (drop_m > 0.0) drop_jumps(yaml, drop_m);
    if (derived) {
      derive_course(poses, chord);
      log_.streams.poses_have_heading = false;
      log_.notes.emplace_back("poses have no heading: it is estimated from positions and motion");
    }
    for (PoseSample& p : poses) {
      p.x -= std::cos(p.heading) * forward - std::sin(p.heading) * left;
      p.y -= std::sin(p.heading) * forward + std::cos(p.heading) * left;
    }
  }

  // Reads slope and bank at all poses, before jumps are dropped.
  void read_attitudes(StreamReader& table, YamlMap& yaml) {
    const auto& poses = log_.streams.poses;
    const auto of = [&](const std::string& key) {
      return yaml.has(key) ? column(table, yaml, key, Quantity::kAngle) : std::vector<double>();
    };
    const std::vector<double> pitch = of("pitch");
    const std::vector<double> roll = of("roll");
    if (heights_.empty() && yaml.has("height"))
      heights_ = column(table, yaml, "height", Quantity::kLength);
    if (heights_.size() == poses.size()) attitudes_ = slopes_of(poses, heights_);
    if (attitudes_.empty() && pitch.empty() && roll.empty()) return;
    attitudes_.resize(poses.size());
    for (std::size_t i = 0; i < poses.size(); ++i) {
      attitudes_[i].t_s = poses[i].t_s;
      if (pitch.size() == poses.size()) attitudes_[i].slope_rad = pitch[i];
      if (roll.size() == poses.size()) attitudes_[i].bank_rad = roll[i];
      log_.streams.bank_is_known = log_.streams.bank_is_known || roll.size() == poses.size();
    }
  }

  // Poses by satellite or tracker involve no map that could be scaled or bent, so these effects are
  // excluded.
  void measured_by(YamlMap& yaml) {
    std::string by = "map";
    yaml.read("measured_by", by);
    // A tracker hangs in a room, whose floor is level.
    if (by == "tracker") log_.streams.bank_is_known = true;
    if (by != "map" && by != "satellites" && by != "tracker")
      yaml.report("measured_by", by, "map, satellites or tracker");
    if (by == "map") return;
    log_.without.insert(log_.without.end(), {"map.scale", "map.bend"});
    log_.notes.push_back("poses were measured by " + by + ": map.scale and map.bend are left out");
  }

  void from_geodetic(StreamReader& table,
                     YamlMap& yaml,
                     std::vector<double>& x,
                     std::vector<double>& y) {
    // Receivers write degrees; "unit: rad" overrides it.
    const auto angle = [&](const std::string& key) {
      auto spec = read_value_spec(yaml, key, Quantity::kAngle);
      if (spec && !yaml.is_map(key)) spec->unit = *find_unit(Quantity::kAngle, "deg");
      if (!spec) yaml.report(key, "nothing", "its column");
      return spec ? table.values(*spec, key) : std::vector<double>{};
    };
    const auto latitude = angle("latitude");
    const auto longitude = angle("longitude");
    std::vector<double> height(latitude.size(), 0.0);
    if (yaml.has("height"))
      heights_ = height = column(table, yaml, "height", Quantity::kLength);
    else
      log_.notes.emplace_back("poses have no height: 0 m above the ellipsoid is assumed");
    if (longitude.size() != latitude.size() || height.size() != latitude.size()) return;
    for (std::size_t i = 0; i < latitude.size(); ++i) {
      if (std::abs(latitude[i]) > 1.5708 || std::abs(longitude[i]) > 6.2832) {
        problems_.error(table.table().file, table.table().lines[i], "poses.latitude",
                        std::to_string(latitude[i]) + ", " + std::to_string(longitude[i]) + " rad",
                        "within 90 and 360 degrees");
        continue;
      }
      const Eigen::Vector3d enu =
          local_enu({latitude[i], longitude[i], height[i]}, {latitude[0], longitude[0], height[0]});
      x.push_back(enu.x());
      y.push_back(enu.y());
    }
  }

  // Drops jumps of the receiver: poses that no vehicle could reach from the last kept one.
  void drop_jumps(YamlMap& yaml, double max_speed) {
    auto& poses = log_.streams.poses;
    std::vector<PoseSample> kept;
    for (const PoseSample& p : poses)
      if (kept.empty() || std::hypot(p.x - kept.back().x, p.y - kept.back().y) <=
                              max_speed * (p.t_s - kept.back().t_s))
        kept.push_back(p);
    if (poses.size() > 1 && kept.size() < 2)
      yaml.report("drop_jumps_m_s",
                  std::to_string(max_speed) + " m/s, which leaves one pose of " +
                      std::to_string(poses.size()),
                  "a speed that the car reaches (check the units of time and positions)");
    if (kept.size() < poses.size())
      log_.notes.push_back("poses: " + std::to_string(poses.size() - kept.size()) +
                           " poses dropped that need a speed above drop_jumps_m_s");
    poses = std::move(kept);
  }

  void steering(YamlMap& yaml) {
    StreamReader table(read_stream_spec(yaml, "steering", common_, folder_), problems_, log_.notes);
    const auto angle = column(table, yaml, "angle", Quantity::kAngle);
    if (angle.size() != table.stamps().size()) return;
    for (std::size_t i = 0; i < angle.size(); ++i)
      log_.streams.steering.push_back(
          {table.stamps()[i], angle[i] / log_.streams.wheel_model.steering_ratio});
  }

  void gyro(YamlMap& yaml) {
    StreamReader table(read_stream_spec(yaml, "gyro", common_, folder_), problems_, log_.notes);
    const auto spec = read_value_spec(yaml, "rate", Quantity::kTurnRate);
    const auto rate = column(table, yaml, "rate", spec);
    const auto& t = table.stamps();
    if (!spec || rate.size() != t.size()) return;
    for (std::size_t i = spec->unit.per_row ? 1 : 0; i < rate.size(); ++i) {
      // An increment over a row gives the rate at the middle of the row.
      if (spec->unit.per_row)
        log_.streams.gyro.push_back({0.5 * (t[i - 1] + t[i]), rate[i] / (t[i] - t[i - 1])});
      else
        log_.streams.gyro.push_back({t[i], rate[i]});
    }
  }

  void wheels(YamlMap& yaml) {
    StreamReader table(read_stream_spec(yaml, "wheels", common_, folder_), problems_, log_.notes);
    const auto side = [&](const std::string& key, double radius) {
      const auto spec = read_value_spec(yaml, key, Quantity::kWheel);
      const auto values = column(table, yaml, key, spec);
      return spec && values.size() == table.stamps().size()
                 ? cumulative_angle(table.stamps(), values, spec->unit.wheel, radius)
                 : std::vector<double>{};
    };
    const WheelModel& m = log_.streams.wheel_model;
    const auto left = side("left", m.radius_left_m);
    const auto right = side("right", m.radius_right_m);
    for (std::size_t i = 0; i < std::min(left.size(), right.size()); ++i)
      log_.streams.wheels.push_back({table.stamps()[i], left[i], right[i]});
  }

  void speed(YamlMap& yaml) {
    StreamReader table(read_stream_spec(yaml, "speed", common_, folder_), problems_, log_.notes);
    const auto spec = read_value_spec(yaml, "value", Quantity::kWheel);
    const auto values = column(table, yaml, "value", spec);
    std::string of = "middle";
    yaml.read("of", of);
    if (of != "middle" && of != "front_wheel" && of != "left" && of != "right")
      yaml.report("of", of, "middle, front_wheel, left or right");
    if ((of == "left" || of == "right") && !has_track_)
      yaml_.report("vehicle.track_width_m", "nothing",
                   "a number (the distance between the wheels)");
    if (!spec || values.size() != table.stamps().size()) return;
    MotionStreams& streams = log_.streams;
    streams.wheels_read = of == "middle"  ? WheelsRead::kMiddle
                          : of == "left"  ? WheelsRead::kLeft
                          : of == "right" ? WheelsRead::kRight
                                          : WheelsRead::kFront;
    const WheelModel& m = streams.wheel_model;
    const double radius = of == "right" ? m.radius_right_m : m.radius_left_m;
    const auto angle = cumulative_angle(table.stamps(), values, spec->unit.wheel, radius);
    for (std::size_t i = 0; i < angle.size(); ++i)
      streams.wheels.push_back({table.stamps()[i], angle[i], angle[i]});
    log_.notes.push_back("one speed (" + of +
                         "): differences between the wheels are not observable");
  }

  void window() {
    auto yaml = yaml_.map("window");
    if (!yaml) return;
    double from = 0.0, to = 1e12;
    yaml->read("from_s", from);
    yaml->read("to_s", to);
    auto& poses = log_.streams.poses;
    if (poses.empty()) return;
    const double origin = poses.front().t_s;
    std::erase_if(
        poses, [&](const PoseSample& p) { return p.t_s - origin < from || p.t_s - origin > to; });
    if (poses.empty()) yaml->report("from_s", "no pose left", "a window within the log");
  }

  void shift_clock() {
    MotionStreams& s = log_.streams;
    const double origin = s.poses.front().t_s;
    const auto shift = [&](auto& samples) {
      for (auto& sample : samples) sample.t_s -= origin;
    };
    shift(s.poses);
    shift(s.wheels);
    shift(s.steering);
    shift(s.gyro);
    for (auto& c : s.columns)
      for (double& t : c.t_s) t -= origin;
    shift(log_.readings.ranges.samples);
    shift(log_.readings.beacons.samples);
    shift(log_.readings.friction.samples);
  }

  // Unusable columns are reported with the motion streams, if those are recorded.
  void columns_of_friction() {
    const MotionStreams& s = log_.streams;
    FrictionReadings& friction = log_.readings.friction;
    const bool motion = records_motion(s);
    friction.columns = column_covariates(s.columns, s.poses.front().t_s, s.poses.back().t_s,
                                         motion ? nullptr : &log_.notes);
    if (!motion && friction.samples.empty() && !s.columns.empty())
      log_.notes.emplace_back(
          "covariates: not used, because this log records neither motion nor friction");
  }

  YamlMap yaml_;
  std::filesystem::path folder_;
  TableFormat common_;
  ProblemList problems_;
  PlainLog log_;
  bool has_track_ = false;
  std::vector<double> heights_;      // of the poses; empty: not logged
  std::vector<Attitude> attitudes_;  // of the poses; empty: not logged
};

}  // namespace

PlainLog read_plain_log(const std::filesystem::path& description) {
  return LogReader(description).read(description);
}

}  // namespace roadbook
