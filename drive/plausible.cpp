#include "drive/plausible.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <numbers>
#include <sstream>
#include <utility>

#include "drive/table_faults.hpp"

namespace roadbook {
namespace {

constexpr double kErrorShare = 0.05;  // of rows: fewer are single damaged readings

std::string shown_value(double value) {
  std::ostringstream text;
  text << std::setprecision(5) << value;
  return text.str();
}

struct SizeBound {
  const char* key;
  double usual_low, usual_high;        // beyond: a warning
  double possible_low, possible_high;  // beyond: an error
  bool metres;
};

// From the wheels of a kick scooter to those of a mining truck; usual: robots, cars, buses.
constexpr SizeBound kRadiusBound{"wheel_radius", 0.04, 0.6, 0.01, 2.0, true};
constexpr SizeBound kTrackBound{"track_width", 0.2, 3.0, 0.05, 10.0, true};
constexpr SizeBound kWheelbaseBound{"wheelbase", 0.2, 8.0, 0.05, 30.0, true};
constexpr SizeBound kRatioBound{"steering_ratio", 0.5, 40.0, 0.01, 1000.0, false};

// Units that would make the value a usual one.
std::string unit_cause(double value, const SizeBound& bound) {
  struct UnitGuess {
    const char* name;
    double metres;
  };
  constexpr std::array<UnitGuess, 4> kUnitGuesses{
      {{"millimetres", 1e-3}, {"centimetres", 1e-2}, {"inches", 0.0254}, {"kilometres", 1e3}}};
  std::string cause;
  for (const auto& [name, metres] : kUnitGuesses)
    if (bound.metres && value * metres >= bound.usual_low && value * metres <= bound.usual_high)
      cause += (cause.empty() ? "" : " or ") + std::string(name);
  return cause.empty() ? cause : cause + "?";
}

void check_size(const std::string& file,
                const std::string& key,
                double value,
                const SizeBound& bound,
                ProblemList& problems) {
  if (value >= bound.usual_low && value <= bound.usual_high) return;
  const bool possible = value >= bound.possible_low && value <= bound.possible_high;
  const std::string unit = bound.metres ? " m" : "";
  problems.add({possible ? Severity::kWarning : Severity::kError, file, 0, key,
                shown_value(value) + unit + in_brackets(unit_cause(value, bound)),
                shown_value(bound.usual_low) + " to " + shown_value(bound.usual_high) + unit +
                    " as vehicles have"});
}

// Focal length at the middle of the image and principal point.
struct LensShape {
  double fx, fy, cx, cy;
};

LensShape shape_of(const Camera& lens) {
  const auto& p = lens.parameters;
  switch (lens.model) {
    case CameraModel::kOmni:
      return {p[1] / (1.0 + p[0]), p[2] / (1.0 + p[0]), p[3], p[4]};
    case CameraModel::kDoubleSphere:
      return {p[2] / (1.0 + p[0]), p[3] / (1.0 + p[0]), p[4], p[5]};
    default:
      return {p[0], p[1], p[2], p[3]};
  }
}

std::string pair_text(double a, double b) {
  return "(" + shown_value(a) + ", " + shown_value(b) + ")";
}

// A pinhole's view is below 180 degrees whatever its focal length; a fisheye's grows with the
// angle.
void check_focal_lengths(const std::string& file,
                         const Camera& lens,
                         const LensShape& shape,
                         ProblemList& problems) {
  const bool fisheye = lens.model != CameraModel::kPinholeRadtan;
  const double longer = std::max(lens.width, lens.height);
  const double shorter = std::min(lens.width, lens.height);
  const double wide = std::max(shape.fx, shape.fy) / longer;
  const double narrow = std::min(shape.fx, shape.fy) / shorter;
  const double ratio = shape.fx / shape.fy;
  // Pinhole: 11 to 136 degrees over the longer side; fisheye: up to 280 over the shorter one.
  const bool likely = wide <= 5.0 && (fisheye ? narrow >= 0.2 : wide >= 0.2);
  if (likely && ratio >= 0.8 && ratio <= 1.25) return;
  const double half = 0.5 / std::max(wide, 1e-9);
  const double view_deg =
      360.0 / std::numbers::pi * (fisheye ? std::min(half, std::numbers::pi) : std::atan(half));
  problems.warning(file, 0, "intrinsics",
                   "focal lengths " + pair_text(shape.fx, shape.fy) + " for images of " +
                       std::to_string(lens.width) + "x" + std::to_string(lens.height) +
                       " (a view of " + shown_value(std::round(view_deg)) + " degrees)",
                   fisheye ? "alike, 0.2 times the shorter side to 5 times the longer one"
                           : "alike, 0.2 to 5 times the longer side");
}

// Size of the images that the calibration is of, in units of those that are there: from a principal
// point that lies in the middle of them, by both sides alike. 0: no such size.
double calibrated_scale(const LensShape& shape, const Camera& lens) {
  const double x = (shape.cx + 0.5) / (0.5 * lens.width);
  const double y = (shape.cy + 0.5) / (0.5 * lens.height);
  const bool alike = x > 0.0 && y > 0.0 && std::abs(x / y - 1.0) < 0.1;
  return alike && std::abs(0.5 * (x + y) - 1.0) > 0.2 ? 0.5 * (x + y) : 0.0;
}

}  // namespace

void ColumnBound::add(double value, std::int64_t line) {
  ++rows_;
  largest_ = std::max(largest_, std::abs(value));
  if (std::abs(value) <= most_) return;
  ++beyond_;
  if (std::abs(value) <= std::abs(worst_)) return;
  worst_ = value;
  worst_line_ = line;
}

bool ColumnBound::report(const std::string& file,
                         ProblemList& problems,
                         const std::string& cause) const {
  if (beyond_ == 0) return false;
  const bool most_rows =
      beyond_ > 1 && static_cast<double>(beyond_) > kErrorShare * static_cast<double>(rows_);
  problems.add({most_rows ? Severity::kError : Severity::kWarning, file, worst_line_, field_,
                shown_value(worst_) + ", beyond the bound in " + std::to_string(beyond_) + " of " +
                    std::to_string(rows_) + " rows" + in_brackets(cause),
                want_});
  return true;
}

std::string degrees_cause(double value, double most) {
  return std::abs(value) * std::numbers::pi / 180.0 <= most ? "degrees?" : "";
}

void check_mean_force(const std::string& file, double mean_m_s2, ProblemList& problems) {
  if (mean_m_s2 >= 7.0 && mean_m_s2 <= 13.0) return;
  std::string cause;
  if (mean_m_s2 < 0.5) cause = "gravity taken out?";
  for (const auto& [unit, gravity] :
       {std::pair{"g?", 1.0}, {"cm/s^2?", 980.7}, {"mm/s^2?", 9807.0}})
    if (std::abs(mean_m_s2 / gravity - 1.0) < 0.3) cause = unit;
  problems.warning(file, 0, "a_RS_S_x, _y, _z",
                   "a mean length of " + shown_value(mean_m_s2) + " m/s^2" + in_brackets(cause),
                   "about 9.8 m/s^2 (gravity)");
}

void check_wheel_sizes(const std::string& file, const WheelModel& wheels, ProblemList& problems) {
  check_size(file, "wheel_radius_left", wheels.radius_left_m, kRadiusBound, problems);
  check_size(file, "wheel_radius_right", wheels.radius_right_m, kRadiusBound, problems);
  check_size(file, "track_width", wheels.track_width_m, kTrackBound, problems);
  check_size(file, "wheelbase", wheels.wheelbase_m, kWheelbaseBound, problems);
  check_size(file, "steering_ratio", wheels.steering_ratio, kRatioBound, problems);
}

void check_camera_sizes(const std::string& file,
                        const MountedCamera& camera,
                        ProblemList& problems) {
  constexpr double kMostOff = 0.2;  // of the principal point from the middle, in image sides
  constexpr double kFarthestCamera_m = 12.0;  // the front of a bus, from its rear axle
  const Camera& lens = camera.camera;
  const LensShape shape = shape_of(lens);
  const std::string size = std::to_string(lens.width) + "x" + std::to_string(lens.height);
  const double off_x = std::abs((shape.cx + 0.5) / lens.width - 0.5);
  const double off_y = std::abs((shape.cy + 0.5) / lens.height - 0.5);
  const double scale = calibrated_scale(shape, lens);
  if (off_x > kMostOff || off_y > kMostOff || scale > 0.0) {
    std::string got = "principal point " + pair_text(shape.cx, shape.cy);
    got += std::max(off_x, off_y) > 0.5 ? " outside" : " far from the middle of";
    got += " images of " + size;
    if (scale > 0.0)
      got += in_brackets("a calibration of images " + shown_value(scale) + " times their size?");
    problems.warning(file, 0, "intrinsics", got,
                     "a point near " + pair_text(0.5 * lens.width, 0.5 * lens.height) +
                         ", or the resolution that was calibrated");
  }
  check_focal_lengths(file, lens, shape, problems);
  const double far_m = camera.T_vehicle_camera.translation().norm();
  if (far_m > kFarthestCamera_m)
    problems.warning(file, 0, "T_BS",
                     "a camera " + shown_value(far_m) + " m from the vehicle" +
                         in_brackets(far_m <= 1e4 ? "millimetres?" : ""),
                     "metres, at most " + shown_value(kFarthestCamera_m));
}

std::string size_cause(std::int64_t got_width,
                       std::int64_t got_height,
                       std::int64_t want_width,
                       std::int64_t want_height) {
  const double x = static_cast<double>(got_width) / static_cast<double>(want_width);
  const double y = static_cast<double>(got_height) / static_cast<double>(want_height);
  if (got_width == want_height && got_height == want_width) return "turned by 90 degrees?";
  if (!(std::abs(x / y - 1.0) < 0.01)) return "";
  const std::string factor = shown_value(x);
  return (factor == "0.5" ? "half"
          : factor == "2" ? "twice"
                          : factor + " times") +
         std::string(" the size: resolution and intrinsics times ") + factor + "?";
}

}  // namespace roadbook
