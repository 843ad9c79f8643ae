#include "vo/wheels/wheel_correction.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <utility>

namespace roadbook {
namespace {

// Share of the way, and of the turn. The cameras alone drift, and then doubt sound wheels; a wrong
// wiring is doubted nearly everywhere.
constexpr double kMostDoubted = 0.35;

struct Candidate {
  WheelCorrection correction;
  WheelComparison comparison;
  double doubted = 1.0;  // share, the larger of way and turn
};

double share(double part, double whole) { return whole > 0.0 ? part / whole : 0.0; }

Candidate judged(const WheelCorrection& correction,
                 const VoResult& sight,
                 const WheelModel& model,
                 const std::vector<WheelReading>& readings,
                 std::optional<double> ground) {
  Candidate c;
  c.correction = correction;
  c.comparison = compare_wheels(
      sight, WheelOdometry(corrected(model, correction), corrected(readings, correction)), ground);
  c.doubted = std::max(share(c.comparison.doubted_m, c.comparison.compared_m),
                       share(c.comparison.doubted_rad, c.comparison.compared_rad));
  return c;
}

// The track width that gives the turns of the cameras. What a user mistakes is half and whole.
std::optional<double> track_factor(const WheelComparison& comparison) {
  constexpr double kUsual = 0.12;  // as a logarithm: the usual difference of wheels and cameras
  constexpr double kSame = 0.08;
  if (!comparison.turn_factor || !(*comparison.turn_factor > 0.0)) return std::nullopt;
  const double factor = std::log(*comparison.turn_factor);
  if (std::abs(factor) < kUsual) return std::nullopt;
  for (const double common : {0.5, 2.0})
    if (std::abs(factor - std::log(common)) < kSame) return common;
  return *comparison.turn_factor;
}

// Without ground only the sign of the scale can be checked.
bool has_right_scale(const Candidate& c) {
  constexpr double kScale = 0.18;  // as a logarithm
  const WheelComparison& found = c.comparison;
  if (!found.way_factor)
    return c.correction.radius_factor == 1.0 && found.way_ratio && *found.way_ratio > 0.0;
  return *found.way_factor > 0.0 && std::abs(std::log(*found.way_factor)) < kScale;
}

std::vector<WheelCorrection> wirings() {
  std::vector<WheelCorrection> all;
  for (const bool exchange : {false, true})
    for (const double left : {1.0, -1.0})
      for (const double right : {1.0, -1.0})
        for (const double radius : {1.0, 0.5, 2.0})
          all.push_back({exchange, left, right, radius, 1.0});
  return all;
}

int mistakes(const WheelCorrection& c) {
  return (c.exchange ? 1 : 0) + (c.left_sign < 0.0 || c.right_sign < 0.0 ? 1 : 0) +
         (c.radius_factor != 1.0 ? 1 : 0) + (c.track_factor != 1.0 ? 1 : 0);
}

std::string factor_text(double factor) {
  std::ostringstream text;
  text.precision(2);
  text << std::fixed << factor;
  return text.str();
}

}  // namespace

bool WheelCorrection::is_needed() const { return mistakes(*this) > 0; }

std::string WheelCorrection::text() const {
  std::vector<std::string> parts;
  if (exchange) parts.emplace_back("left and right exchanged");
  if (left_sign < 0.0 && right_sign < 0.0)
    parts.emplace_back("both wheels counting backwards");
  else if (left_sign < 0.0 || right_sign < 0.0)
    parts.emplace_back(left_sign < 0.0 ? "the left wheel counting backwards"
                                       : "the right wheel counting backwards");
  if (radius_factor != 1.0)
    parts.push_back("radii " + factor_text(1.0 / radius_factor) + " times the true ones");
  if (track_factor != 1.0)
    parts.push_back("a track width " + factor_text(1.0 / track_factor) + " times the true one");
  std::string text;
  for (std::size_t i = 0; i < parts.size(); ++i) text += (i > 0 ? " and " : "") + parts[i];
  return text;
}

WheelModel corrected(WheelModel model, const WheelCorrection& correction) {
  model.radius_left_m *= correction.radius_factor;
  model.radius_right_m *= correction.radius_factor;
  model.track_width_m *= correction.track_factor;
  return model;
}

std::vector<WheelReading> corrected(std::vector<WheelReading> readings,
                                    const WheelCorrection& correction) {
  for (WheelReading& reading : readings) {
    if (correction.exchange) std::swap(reading.left_angle_rad, reading.right_angle_rad);
    reading.left_angle_rad *= correction.left_sign;
    reading.right_angle_rad *= correction.right_sign;
  }
  return readings;
}

std::optional<WheelCorrection> find_wheel_correction(const VoResult& sight,
                                                     const WheelModel& model,
                                                     const std::vector<WheelReading>& readings,
                                                     std::optional<double> ground) {
  constexpr double kOfEach = 0.02;  // that a mistake must explain, as a share of the drive
  std::optional<Candidate> best;
  double least = kMostDoubted + 4.0 * kOfEach;
  const auto offer = [&](const WheelCorrection& correction) {
    Candidate c = judged(correction, sight, model, readings, ground);
    if (!has_right_scale(c)) return;
    if (const auto track = track_factor(c.comparison)) {
      WheelCorrection wider = correction;
      wider.track_factor = *track;
      c = judged(wider, sight, model, readings, ground);
      if (!has_right_scale(c)) return;
    }
    const double cost = c.doubted + kOfEach * mistakes(c.correction);
    if (c.doubted > kMostDoubted || cost >= least) return;
    least = cost;
    best = std::move(c);
  };
  for (const WheelCorrection& wiring : wirings()) offer(wiring);
  if (!best) return std::nullopt;
  return best->correction;
}

}  // namespace roadbook
