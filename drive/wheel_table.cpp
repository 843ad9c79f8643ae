#include <cmath>
#include <numbers>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "drive/csv.hpp"
#include "drive/plausible.hpp"
#include "drive/steering_check.hpp"
#include "drive/tables.hpp"
#include "drive/turn_check.hpp"
#include "drive/wheel_counter.hpp"
#include "drive/wheels/wheel_wraps.hpp"

namespace roadbook {
namespace {

// The meaning of one wheel's columns, and the conversion of a value to radians (or radians a
// second).
enum class WheelColumn { kAngle, kSpeed, kTicks };

struct Column {
  WheelColumn kind = WheelColumn::kAngle;
  std::optional<std::size_t> index;  ///< rear wheel
  std::optional<std::size_t> front;  ///< speed of the front wheel: where the rear one is absent
  double factor = 1.0;
};

// One wheel under the names it goes by: rear_left_speed, v_RL, v_FL, rear_left_ticks, ticks_RL.
struct WheelName {
  std::string long_name;
  std::string letters;  ///< "RL"
  std::string front;    ///< "FL"
  double side;          ///< +1 left, -1 right
};

double angle_factor(const std::string& unit) {
  return unit == "deg" ? std::numbers::pi / 180.0 : 1.0;
}

std::optional<Column> speed_column(CsvReader& csv, const WheelName& wheel, double radius_m) {
  Column column;
  column.kind = WheelColumn::kSpeed;
  if (csv.find(wheel.long_name + "_speed")) {
    column.index = csv.require(wheel.long_name + "_speed", "rad s^-1|m s^-1|rad/s|m/s");
    if (!column.index) return std::nullopt;
    if (csv.columns()[*column.index].unit.starts_with('m')) column.factor = 1.0 / radius_m;
    return column;
  }
  column.factor = 1.0 / radius_m;
  const bool rear = csv.find("v_" + wheel.letters).has_value();
  const bool front = csv.find("v_" + wheel.front).has_value();
  if (rear) column.index = csv.require("v_" + wheel.letters, "m s^-1|m/s");
  if (front) column.front = csv.require("v_" + wheel.front, "m s^-1|m/s");
  if ((rear && !column.index) || (front && !column.front)) return std::nullopt;
  return column;
}

std::optional<Column> tick_column(CsvReader& csv,
                                  const std::string& name,
                                  const WheelModel& model,
                                  ProblemList& problems) {
  Column column;
  column.kind = WheelColumn::kTicks;
  column.index = csv.require(name, "|-|1");
  if (!column.index) return std::nullopt;
  if (!(model.ticks_per_turn > 0.0)) {
    problems.error(csv.file(), 1, name, "ticks", "ticks_per_turn > 0 in the wheels' sensor.yaml");
    return std::nullopt;
  }
  column.factor = 2.0 * std::numbers::pi / model.ticks_per_turn;
  return column;
}

std::optional<Column> find_wheel(CsvReader& csv,
                                 const WheelName& wheel,
                                 double radius_m,
                                 const WheelModel& model,
                                 ProblemList& problems) {
  if (csv.find(wheel.long_name + "_speed") || csv.find("v_" + wheel.letters) ||
      csv.find("v_" + wheel.front))
    return speed_column(csv, wheel, radius_m);
  for (const std::string& name : {wheel.long_name + "_ticks", "ticks_" + wheel.letters})
    if (csv.find(name)) return tick_column(csv, name, model, problems);
  Column column;
  column.index = csv.require(wheel.long_name + "_angle", "rad|deg");
  if (!column.index) return std::nullopt;
  column.factor = angle_factor(csv.columns()[*column.index].unit);
  return column;
}

// Speed of the rear wheel over that of the front wheel on the same side. On a curve of curvature
// k = tan(steering) / wheelbase about a centre on the rear axle's line, the rear wheel's circle has
// the radius |1/k - side track/2| and the front wheel's is longer by the wheelbase (Pythagoras).
double rear_over_front(const WheelModel& model, double side, std::optional<double> steering_rad) {
  if (!steering_rad) return 1.0;
  const double curvature = std::tan(*steering_rad) / model.wheelbase_m;
  const double rear = 1.0 - side * 0.5 * model.track_width_m * curvature;
  const double front = std::hypot(rear, curvature * model.wheelbase_m);
  return front > 1e-9 ? rear / front : 1.0;
}

// The column of steering angles, and what its values are compared with.
struct Steering {
  std::optional<std::size_t> index;
  double factor = 1.0;
  std::string name;
  std::string unit;
  std::optional<ColumnBound> bound;
};

// `steering` and `steering_angle` are at the road wheels; `steering_wheel_angle` goes through the
// ratio.
Steering find_steering(CsvReader& csv, const WheelModel& model) {
  Steering steering;
  for (const char* const name : {"steering", "steering_angle", "steering_wheel_angle"}) {
    if (!csv.find(name) || steering.index) continue;
    steering.index = csv.require(name, "rad|deg");
    if (!steering.index) return steering;
    steering.name = name;
    steering.unit = csv.columns()[*steering.index].unit;
    steering.factor = angle_factor(steering.unit);
    if (steering.name == "steering_wheel_angle") steering.factor /= model.steering_ratio;
    std::ostringstream want;
    want.precision(3);
    want << "at most " << kMostSteering_rad / steering.factor << " " << steering.unit;
    want << " (" << kMostSteering_rad << " rad at the road wheels)";
    steering.bound.emplace(steering.name, kMostSteering_rad / steering.factor, want.str());
  }
  return steering;
}

// Says which angle the column may hold where it is not the one that it names; whether it did.
bool report_steering(const CsvReader& csv,
                     const Steering& steering,
                     const WheelModel& model,
                     ProblemList& problems) {
  if (!steering.bound) return false;
  const double largest = steering.bound->largest();
  const bool of_wheel = steering.name == "steering_wheel_angle";
  std::string cause;
  if (steering.unit == "rad") cause = degrees_cause(largest * steering.factor, kMostSteering_rad);
  if (of_wheel && model.steering_ratio == 1.0)
    cause += std::string(cause.empty() ? "" : " ") + "no steering_ratio in sensor.yaml?";
  else if (cause.empty() && !of_wheel)
    cause = "steering_wheel_angle?";
  return steering.bound->report(csv.file(), problems, cause);
}

// Angle of a wheel so far. Speeds are integrated between rows; counters that begin again are
// continued.
class Accumulator {
 public:
  Accumulator(const Column& column, const std::string& wheel, double radius_m, const WheelModel& m)
      : kind_(column.kind),
        wheel_(wheel),
        counter_(radius_m, ranges(column.kind, m)),
        turns_(wheel, radius_m) {}

  double add(double now, double dt_s, std::int64_t line) {
    const double angle =
        kind_ == WheelColumn::kSpeed ? integrate(now, dt_s) : count(now, dt_s, line);
    turn_ = first_ ? 0.0 : angle - angle_;
    if (!first_) turns_.add(turn_, dt_s, line);
    first_ = false;
    return angle_ = angle;
  }
  /// Since the row before.
  [[nodiscard]] double turn() const { return turn_; }
  void report(const std::string& file, ProblemList& problems) const {
    if (auto problem = news_.problem(file, wheel_)) problems.add(*std::move(problem));
    turns_.report(file, problems);
  }

 private:
  static std::vector<double> ranges(WheelColumn kind, const WheelModel& model) {
    if (kind == WheelColumn::kTicks) return tick_ranges_rad(model.ticks_per_turn);
    return {2.0 * std::numbers::pi};
  }
  double integrate(double speed, double dt_s) {
    const double before = std::exchange(speed_, speed);
    return first_ ? 0.0 : angle_ + 0.5 * (before + speed) * dt_s;
  }
  double count(double now, double dt_s, std::int64_t line) {
    const double angle = counter_.add(now, dt_s);
    news_.add(counter_.event(), line);
    return angle;
  }
  WheelColumn kind_;
  std::string wheel_;
  WheelCounter counter_;
  CounterReport news_;
  TurnCheck turns_;
  bool first_ = true;
  double speed_ = 0.0;
  double angle_ = 0.0;
  double turn_ = 0.0;
};

// Cells of one row: an empty one is absent, which is no fault; one that is no number is.
class WheelRow {
 public:
  explicit WheelRow(CsvReader& csv) : csv_(csv) {}

  std::optional<double> number(std::optional<std::size_t> column) {
    if (!column || csv_.fields()[*column].empty()) return std::nullopt;
    const auto value = csv_.number(*column);
    if (!value) good_ = false;
    return value;
  }
  // Rotation (or its rate) of a rear wheel, from the front wheel where its own cell is absent.
  std::optional<double> wheel(const Column& column,
                              const WheelModel& model,
                              double side,
                              std::optional<double> steering_rad) {
    const auto rear = number(column.index);
    const auto front = number(column.front);
    if (rear) return *rear * column.factor;
    if (front) return *front * column.factor * rear_over_front(model, side, steering_rad);
    return std::nullopt;
  }
  [[nodiscard]] bool good() const { return good_; }

 private:
  CsvReader& csv_;
  bool good_ = true;
};

CounterColumn counter_of(const Column& column) {
  return {column.kind != WheelColumn::kSpeed, column.kind == WheelColumn::kTicks, column.factor};
}

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
  const WheelName left_name{"rear_left", "RL", "FL", 1.0};
  const WheelName right_name{"rear_right", "RR", "FR", -1.0};
  const auto left = find_wheel(csv, left_name, model.radius_left_m, model, problems);
  const auto right = find_wheel(csv, right_name, model.radius_right_m, model, problems);
  Steering steering = find_steering(csv, model);
  if (!t_column || !left || !right || !csv.good()) return stamps.finish("wheels0", limits);
  std::vector<WheelCells> rows;
  while (csv.next()) {
    WheelRow row(csv);
    const auto t = csv.stamp(*t_column);
    WheelCells cells;
    cells.line = csv.line();
    cells.steering_rad = row.number(steering.index);
    if (cells.steering_rad) {
      steering.bound->add(*cells.steering_rad, csv.line());
      *cells.steering_rad *= steering.factor;
    }
    const auto left_now = row.wheel(*left, model, left_name.side, cells.steering_rad);
    const auto right_now = row.wheel(*right, model, right_name.side, cells.steering_rad);
    if (!t || !row.good() || !stamps.add(*t, csv.line())) continue;
    // Without both wheels a row says nothing of the motion; the rows around it bridge it.
    if (!left_now || !right_now) continue;
    cells.t_ns = *t;
    cells.wheel = {*left_now, *right_now};
    rows.push_back(cells);
  }
  undo_wraps(csv.file(), {counter_of(*left), counter_of(*right)}, model, rows, problems);
  Accumulator left_angle(*left, left_name.long_name, model.radius_left_m, model);
  Accumulator right_angle(*right, right_name.long_name, model.radius_right_m, model);
  SteeringCheck against_wheels(model);
  std::optional<std::int64_t> before_ns;
  for (const WheelCells& cells : rows) {
    const double dt_s = before_ns ? static_cast<double>(cells.t_ns - *before_ns) * 1e-9 : 0.0;
    WheelReading reading;
    reading.t_ns = cells.t_ns;
    reading.steering_rad = cells.steering_rad;
    reading.left_angle_rad = left_angle.add(cells.wheel[0], dt_s, cells.line);
    reading.right_angle_rad = right_angle.add(cells.wheel[1], dt_s, cells.line);
    if (reading.steering_rad)
      against_wheels.add(left_angle.turn(), right_angle.turn(), *reading.steering_rad);
    before_ns = cells.t_ns;
    visit(reading);
  }
  if (!report_steering(csv, steering, model, problems))
    against_wheels.report(csv.file(), steering.name, problems);
  left_angle.report(csv.file(), problems);
  right_angle.report(csv.file(), problems);
  const StreamSummary summary = stamps.finish("wheels0", limits);
  if (csv.good() && !before_ns)
    problems.error(csv.file(), 0, "", summary.rows == 0 ? "no rows" : "no row with both wheels",
                   "at least one");
  return summary;
}

}  // namespace roadbook
