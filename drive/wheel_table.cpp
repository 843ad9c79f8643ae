#include <numbers>
#include <optional>
#include <string>

#include "drive/csv.hpp"
#include "drive/tables.hpp"

namespace roadbook {
namespace {

// What the columns of one wheel mean and how a value becomes radians (or radians a second).
enum class WheelColumn { kAngle, kSpeed, kTicks };

struct Column {
  WheelColumn kind = WheelColumn::kAngle;
  std::size_t index = 0;
  double factor = 1.0;
};

double angle_factor(const std::string& unit) {
  return unit == "deg" ? std::numbers::pi / 180.0 : 1.0;
}

std::optional<Column> find_wheel(CsvReader& csv,
                                 const std::string& wheel,
                                 double radius_m,
                                 const WheelModel& model,
                                 ProblemList& problems) {
  if (csv.find(wheel + "_speed")) {
    const auto index = csv.require(wheel + "_speed", "rad s^-1|m s^-1|rad/s|m/s");
    if (!index) return std::nullopt;
    const bool metres = csv.columns()[*index].unit.starts_with('m');
    return Column{WheelColumn::kSpeed, *index, metres ? 1.0 / radius_m : 1.0};
  }
  if (csv.find(wheel + "_ticks")) {
    const auto index = csv.require(wheel + "_ticks", "|-|1");
    if (!index) return std::nullopt;
    if (model.ticks_per_turn > 0.0)
      return Column{WheelColumn::kTicks, *index, 2.0 * std::numbers::pi / model.ticks_per_turn};
    problems.error(csv.file(), 1, wheel + "_ticks", "ticks",
                   "ticks_per_turn > 0 in the wheels' sensor.yaml");
    return std::nullopt;
  }
  const auto index = csv.require(wheel + "_angle", "rad|deg");
  if (!index) return std::nullopt;
  return Column{WheelColumn::kAngle, *index, angle_factor(csv.columns()[*index].unit)};
}

struct Steering {
  std::optional<std::size_t> index;
  double factor = 1.0;
};

// `steering_angle` is at the road wheels; `steering_wheel_angle` goes through the ratio.
Steering find_steering(CsvReader& csv, const WheelModel& model) {
  Steering steering;
  for (const char* const name : {"steering_angle", "steering_wheel_angle"}) {
    if (!csv.find(name) || steering.index) continue;
    steering.index = csv.require(name, "rad|deg");
    if (!steering.index) return steering;
    steering.factor = angle_factor(csv.columns()[*steering.index].unit);
    if (name == std::string_view("steering_wheel_angle")) steering.factor /= model.steering_ratio;
  }
  return steering;
}

// Angles so far; speeds are integrated between rows.
class Accumulator {
 public:
  double add(const Column& column, double value, double dt_s) {
    const double now = value * column.factor;
    if (column.kind != WheelColumn::kSpeed) return now;
    if (started_) angle_ += 0.5 * (before_ + now) * dt_s;
    started_ = true;
    before_ = now;
    return angle_;
  }

 private:
  bool started_ = false;
  double before_ = 0.0;
  double angle_ = 0.0;
};

}  // namespace

StreamSummary read_wheel_table(const std::filesystem::path& file,
                               const WheelModel& model,
                               const StampLimits& limits,
                               ProblemList& problems,
                               const RowVisitor<WheelReading>& visit) {
  CsvReader csv(file, CsvHeader::kRequired, problems);
  StampCheck stamps(file.string(), problems);
  if (!csv.good()) return stamps.finish("wheels0", limits);
  const auto t_column = csv.require("timestamp", "ns|");
  const auto left = find_wheel(csv, "rear_left", model.radius_left_m, model, problems);
  const auto right = find_wheel(csv, "rear_right", model.radius_right_m, model, problems);
  const Steering steering = find_steering(csv, model);
  if (!t_column || !left || !right || !csv.good()) return stamps.finish("wheels0", limits);
  Accumulator left_angle;
  Accumulator right_angle;
  std::int64_t before_ns = 0;
  bool first = true;
  while (csv.next()) {
    const auto t = csv.stamp(*t_column);
    const auto left_value = csv.number(left->index);
    const auto right_value = csv.number(right->index);
    std::optional<double> steering_value;
    bool good = t && left_value && right_value;
    if (steering.index && !csv.fields()[*steering.index].empty()) {
      steering_value = csv.number(*steering.index);
      good = good && steering_value;
    }
    if (!good || !stamps.add(*t, csv.line())) continue;
    const double dt_s = first ? 0.0 : static_cast<double>(*t - before_ns) * 1e-9;
    first = false;
    before_ns = *t;
    WheelReading reading;
    reading.t_ns = *t;
    reading.left_angle_rad = left_angle.add(*left, *left_value, dt_s);
    reading.right_angle_rad = right_angle.add(*right, *right_value, dt_s);
    if (steering_value) reading.steering_rad = *steering_value * steering.factor;
    visit(reading);
  }
  const StreamSummary summary = stamps.finish("wheels0", limits);
  if (csv.good() && summary.rows == 0) problems.error(csv.file(), 0, "", "no rows", "at least one");
  return summary;
}

}  // namespace roadbook
