#include "drive/wheel_counter.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace roadbook {
namespace {

constexpr double kHardBrake_m_s2 = 25.0;  // no tyre brakes or drives so hard
constexpr double kSlack_m = 0.5;          // noise of readings and stamps
constexpr double kMemory_s = 0.1;         // of the speed: rows may follow each other closely
constexpr double kLongestDropout_s = 2.0;

}  // namespace

std::vector<double> tick_ranges_rad(double ticks_per_turn) {
  const double radians = 2.0 * std::numbers::pi / ticks_per_turn;
  return {0x1p16 * radians, 0x1p32 * radians};
}

double WheelCounter::fastest_rad(double dt_s) const { return kFastestCar_m_s / radius_m_ * dt_s; }

WheelCounter::Step WheelCounter::explain(double now_rad, double dt_s) const {
  const double step = now_rad - before_rad_;
  const double predicted = speed_rad_s_ * dt_s;
  std::vector<Step> possible;
  const auto consider = [&](CounterEvent event, double turn_rad) {
    if (std::abs(turn_rad) <= fastest_rad(dt_s)) possible.push_back({event, turn_rad});
  };
  consider(CounterEvent::kNone, step);
  for (const double range : ranges_rad_)
    // All values of a counter lie within its range.
    if (highest_rad_ - lowest_rad_ < range)
      consider(CounterEvent::kWrap, step + std::copysign(range, -step));
  // From zero on the wheel has turned by `now` at least.
  if (std::abs(now_rad) <= fastest_rad(dt_s) && std::abs(now_rad) < std::abs(before_rad_))
    consider(CounterEvent::kReset, now_rad);
  const double slack = (kSlack_m + kHardBrake_m_s2 * dt_s * dt_s) / radius_m_;
  const auto agrees = std::find_if(possible.begin(), possible.end(), [&](const Step& s) {
    return !knows_speed_ || std::abs(s.turn_rad - predicted) <= slack;
  });
  if (agrees != possible.end()) {
    // A wrap and a reset may agree both: the nearer one is it.
    Step best = *agrees;
    for (const Step& s : possible)
      if (knows_speed_ && best.event != CounterEvent::kNone &&
          std::abs(s.turn_rad - predicted) < std::abs(best.turn_rad - predicted))
        best = s;
    return best;
  }
  return possible.empty() ? Step{CounterEvent::kJump, step} : possible.front();
}

bool WheelCounter::goes_on_from_before(double now_rad) const {
  return held_s_ > 0.0 && held_s_ <= kLongestDropout_s &&
         std::abs(now_rad - held_rad_) <= fastest_rad(held_s_);
}

void WheelCounter::remember_speed(double turn_rad, double dt_s) {
  if (!(dt_s > 0.0)) return;
  const double weight = knows_speed_ ? std::min(1.0, dt_s / kMemory_s) : 1.0;
  speed_rad_s_ += weight * (turn_rad / dt_s - speed_rad_s_);
  knows_speed_ = true;
}

double WheelCounter::add(double now_rad, double dt_s) {
  event_ = CounterEvent::kNone;
  if (first_) {
    first_ = false;
    before_rad_ = lowest_rad_ = highest_rad_ = now_rad;
    return now_rad;
  }
  lowest_rad_ = std::min(lowest_rad_, now_rad);
  highest_rad_ = std::max(highest_rad_, now_rad);
  if (held_s_ > 0.0) held_s_ += dt_s;
  const Step step = explain(now_rad, dt_s);
  const bool conspicuous = step.event == CounterEvent::kReset || step.event == CounterEvent::kJump;
  if (step.event != CounterEvent::kNone && goes_on_from_before(now_rad)) {
    event_ = CounterEvent::kReturn;
    added_rad_ = held_added_rad_;
    held_s_ = 0.0;
    before_rad_ = now_rad;
    return now_rad + added_rad_;
  }
  event_ = step.event;
  if (conspicuous) {
    held_rad_ = before_rad_;
    held_added_rad_ = added_rad_;
    held_s_ = dt_s;
  }
  const double angle_before = before_rad_ + added_rad_;
  if (step.event == CounterEvent::kWrap)
    added_rad_ += step.turn_rad - (now_rad - before_rad_);
  else if (step.event == CounterEvent::kReset)
    added_rad_ = angle_before + (knows_speed_ ? speed_rad_s_ * dt_s : now_rad) - now_rad;
  else if (step.event == CounterEvent::kNone)
    remember_speed(step.turn_rad, dt_s);
  before_rad_ = now_rad;
  return now_rad + added_rad_;
}

void CounterReport::add(CounterEvent event, std::int64_t line) {
  if (event == CounterEvent::kReset) {
    if (++resets_ == 1) first_line_ = line;
  } else if (event == CounterEvent::kReturn && last_ == CounterEvent::kReset) {
    --resets_;
    if (++dropouts_ == 1 && first_line_ == 0) first_line_ = line;
  }
  if (event == CounterEvent::kReset || event == CounterEvent::kJump) last_ = event;
}

std::optional<Problem> CounterReport::problem(const std::string& file,
                                              const std::string& wheel) const {
  if (resets_ + dropouts_ == 0) return std::nullopt;
  const auto times = [](std::size_t n) {
    return n == 1 ? std::string(" once") : " " + std::to_string(n) + " times";
  };
  std::string got;
  if (resets_ > 0) got = "a counter that begins again at zero" + times(resets_);
  if (dropouts_ > 0)
    got += (got.empty() ? "" : " and ") + std::string("zeros amid its count") + times(dropouts_);
  return Problem{
      Severity::kWarning,    file, first_line_, wheel, got + "; bridged with the speed before",
      "a count that goes on"};
}

bool is_faster_than_cars(double way_m, double dt_s) {
  constexpr double kNoise_m = 0.5;
  return std::abs(way_m) > kFastestCar_m_s * dt_s + kNoise_m;
}

}  // namespace roadbook
