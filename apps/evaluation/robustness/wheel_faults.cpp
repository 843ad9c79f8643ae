#include <array>
#include <cmath>
#include <numbers>

#include "apps/evaluation/robustness/drive_fault.hpp"
#include "apps/evaluation/robustness/recorded_table.hpp"
#include "base/format.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

constexpr double kNsPerS = 1e9;

enum class FaultySide { kLeft, kRight, kBoth };

/// The angles of both rear wheels in a `data.csv`.
class WheelAngles {
 public:
  explicit WheelAngles(const fs::path& drive)
      : table_(drive / "wheels0" / "data.csv"),
        columns_{table_.column("rear_left_angle"), table_.column("rear_right_angle")} {}

  [[nodiscard]] std::size_t rows() const { return table_.rows(); }
  [[nodiscard]] double time_s(std::size_t row) const {
    return static_cast<double>(table_.stamp_ns(row) - table_.stamp_ns(0)) / kNsPerS;
  }
  [[nodiscard]] double length_s() const { return time_s(rows() - 1); }
  [[nodiscard]] double at(std::size_t row, int wheel) const {
    return table_.number(row, columns_.at(static_cast<std::size_t>(wheel)));
  }
  void set(std::size_t row, int wheel, double angle) {
    table_.set(row, columns_.at(static_cast<std::size_t>(wheel)), angle);
  }
  void set_text(std::size_t row, int wheel, const std::string& text) {
    table_.cell(row, columns_.at(static_cast<std::size_t>(wheel))) = text;
  }
  void write() const { table_.write(); }

 private:
  RecordedTable table_;
  std::array<std::size_t, 2> columns_;
};

bool has(FaultySide side, int wheel) {
  return side == FaultySide::kBoth || (side == FaultySide::kLeft) == (wheel == 0);
}

FaultySide drawn_side(Random& random) {
  return random.below(2) == 0 ? FaultySide::kLeft : FaultySide::kRight;
}

// A start so that `seconds` fit into the drive, away from both ends where there is room.
double drawn_start(const WheelAngles& wheels, double seconds, Random& random) {
  const double last = std::max(1.0, wheels.length_s() - seconds - 1.0);
  return random.uniform(std::min(3.0, last), last);
}

// The counters of one side do not count for a time, and count on from there.
void stop_counting(WheelAngles& wheels, FaultySide side, double from_s, double to_s) {
  for (const int wheel : {0, 1}) {
    if (!has(side, wheel)) continue;
    double lost = 0.0;
    double before = wheels.at(0, wheel);
    for (std::size_t row = 1; row < wheels.rows(); ++row) {
      const double now = wheels.at(row, wheel);
      const double t = wheels.time_s(row);
      if (t > from_s && t <= to_s) lost += now - before;
      before = now;
      wheels.set(row, wheel, now - lost);
    }
  }
}

// The counters show an old value for a time, then the true value again.
void hold(WheelAngles& wheels, FaultySide side, double from_s, double to_s) {
  for (const int wheel : {0, 1}) {
    if (!has(side, wheel)) continue;
    double held = wheels.at(0, wheel);
    for (std::size_t row = 1; row < wheels.rows(); ++row) {
      const double t = wheels.time_s(row);
      if (t <= from_s || t > to_s)
        held = wheels.at(row, wheel);
      else
        wheels.set(row, wheel, held);
    }
  }
}

DriveFault stuck(double seconds, bool both) {
  return {"wheels: stuck " + fixed(seconds, 1) + " s, " + (both ? "both" : "one"),
          [=](const fs::path& drive, Random& random) {
            WheelAngles wheels(drive);
            const FaultySide side = both ? FaultySide::kBoth : drawn_side(random);
            const double start = drawn_start(wheels, seconds, random);
            stop_counting(wheels, side, start, start + seconds);
            wheels.write();
            return PlantedFault{{"wheels0"}};
          }};
}

DriveFault changed(const std::string& name,
                   const std::function<void(WheelAngles&, Random&)>& change) {
  return {"wheels: " + name, [=](const fs::path& drive, Random& random) {
            WheelAngles wheels(drive);
            change(wheels, random);
            wheels.write();
            return PlantedFault{{"wheels0"}};
          }};
}

std::vector<DriveFault> faults_in_time() {
  std::vector<DriveFault> faults;
  for (const double seconds : {0.5, 2.0, 10.0})
    for (const bool both : {false, true}) faults.push_back(stuck(seconds, both));
  faults.push_back(changed("stuck from half way, one", [](WheelAngles& w, Random& random) {
    stop_counting(w, drawn_side(random), 0.5 * w.length_s(), w.length_s());
  }));
  faults.push_back(changed("stuck from half way, both", [](WheelAngles& w, Random&) {
    stop_counting(w, FaultySide::kBoth, 0.5 * w.length_s(), w.length_s());
  }));
  faults.push_back(changed("old value 2 s, both", [](WheelAngles& w, Random& random) {
    const double start = drawn_start(w, 2.0, random);
    hold(w, FaultySide::kBoth, start, start + 2.0);
  }));
  faults.push_back(changed("step", [](WheelAngles& w, Random& random) {
    const FaultySide side = drawn_side(random);
    const double start = drawn_start(w, 0.0, random);
    const double step = (random.below(2) == 0 ? 1.0 : -1.0) * random.uniform(2.0, 20.0);
    for (std::size_t row = 0; row < w.rows(); ++row)
      for (const int wheel : {0, 1})
        if (has(side, wheel) && w.time_s(row) > start) w.set(row, wheel, w.at(row, wheel) + step);
  }));
  faults.push_back(changed("spike", [](WheelAngles& w, Random& random) {
    const int wheel = static_cast<int>(random.below(2));
    const std::size_t row = 1 + random.below(w.rows() - 2);
    w.set(row, wheel, w.at(row, wheel) + random.uniform(-50.0, 50.0));
  }));
  faults.push_back(changed("NaN, 0.5 s", [](WheelAngles& w, Random& random) {
    const double start = drawn_start(w, 0.5, random);
    for (std::size_t row = 0; row < w.rows(); ++row)
      if (w.time_s(row) > start && w.time_s(row) < start + 0.5)
        for (const int wheel : {0, 1}) w.set_text(row, wheel, "nan");
  }));
  return faults;
}

// A counter that wraps at `period` radians, with a wrap at a drawn moment of the drive.
DriveFault wrapped(const std::string& name, double period) {
  return changed("wraps at " + name, [=](WheelAngles& w, Random& random) {
    for (const int wheel : {0, 1}) {
      const std::size_t moment = w.rows() / 4 + random.below(w.rows() / 2);
      const double offset = -w.at(moment, wheel);
      for (std::size_t row = 0; row < w.rows(); ++row) {
        const double angle = w.at(row, wheel) + offset;
        w.set(row, wheel, angle - period * std::floor(angle / period));
      }
    }
  });
}

DriveFault scaled(const std::string& name, const std::vector<std::string>& keys, double factor) {
  return {"wheels: " + name, [=](const fs::path& drive, Random&) {
            const fs::path yaml = drive / "wheels0" / "sensor.yaml";
            for (const std::string& key : keys)
              set_value(yaml, key,
                        std::to_string(factor * numbers_of(value_of(yaml, key)).front()));
            return PlantedFault{{"wheels0"}};
          }};
}

std::vector<DriveFault> faults_of_counters() {
  std::vector<DriveFault> faults;
  const double turn = 2.0 * std::numbers::pi;
  constexpr double kTicks = 1024.0;  // of a turn
  faults.push_back(wrapped("one turn", turn));
  faults.push_back(wrapped("900 of 90 a turn", 10.0 * turn));
  for (const int bits : {12, 16, 24, 32})
    faults.push_back(wrapped("2^" + std::to_string(bits), std::ldexp(turn, bits) / kTicks));
  return faults;
}

std::vector<DriveFault> faults_of_wiring() {
  const auto reversed = [](WheelAngles& w, FaultySide side) {
    for (std::size_t row = 0; row < w.rows(); ++row)
      for (const int wheel : {0, 1})
        if (has(side, wheel)) w.set(row, wheel, -w.at(row, wheel));
  };
  return {
      changed("reversed, one",
              [=](WheelAngles& w, Random& random) { reversed(w, drawn_side(random)); }),
      changed("reversed, both", [=](WheelAngles& w, Random&) { reversed(w, FaultySide::kBoth); }),
      changed("left and right swapped",
              [](WheelAngles& w, Random&) {
                for (std::size_t row = 0; row < w.rows(); ++row) {
                  const double left = w.at(row, 0);
                  w.set(row, 0, w.at(row, 1));
                  w.set(row, 1, left);
                }
              }),
      scaled("radius x 2", {"wheel_radius_left", "wheel_radius_right"}, 2.0),
      scaled("radius / 2", {"wheel_radius_left", "wheel_radius_right"}, 0.5),
      scaled("radius in mm", {"wheel_radius_left", "wheel_radius_right"}, 1000.0),
      scaled("track width / 2", {"track_width"}, 0.5)};
}

}  // namespace

std::vector<DriveFault> wheel_faults() {
  std::vector<DriveFault> faults = faults_in_time();
  for (auto& list : {faults_of_counters(), faults_of_wiring()})
    faults.insert(faults.end(), list.begin(), list.end());
  return faults;
}

}  // namespace roadbook
