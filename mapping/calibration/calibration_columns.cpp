#include "mapping/calibration/calibration_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/se3.hpp"

namespace roadbook {
namespace {

struct KindInfo {
  CalibrationKind kind;
  const char* effect;
  double prior_sigma;
  double widest;
  bool needed;
  const char* manoeuvre;
};

constexpr double kWidestTurn = 0.4 * std::numbers::pi / 180.0;
constexpr const char* kTurns = "turns of 90 degrees to both sides";
constexpr const char* kSpeeds = "turns, and starts and stops";

constexpr std::array kKinds{
    KindInfo{CalibrationKind::kPitch, "pitch", 0.1, kWidestTurn, true, kTurns},
    KindInfo{CalibrationKind::kYaw, "rotation", 0.1, kWidestTurn, true, kTurns},
    KindInfo{CalibrationKind::kRoll, "roll", 0.1, kWidestTurn, true, kTurns},
    KindInfo{CalibrationKind::kFocal, "focal", 0.02, 0.005, false, kTurns},
    KindInfo{CalibrationKind::kImageDelay, "latency", 0.1, 0.01, true, kSpeeds},
    KindInfo{CalibrationKind::kRadius, "radius", 0.2, 0.005, true,
             "a longer way with turns of 90 degrees to both sides"},
    KindInfo{CalibrationKind::kRadiusDifference, "radius_difference", 0.003, 0.004, false,
             "a longer way with straight parts"},
    KindInfo{CalibrationKind::kTrackWidth, "track_width", 0.02, 0.02, false, kTurns},
    KindInfo{CalibrationKind::kWheelDelay, "latency", 0.1, 0.02, true, kSpeeds},
};

const KindInfo& info_of(CalibrationKind kind) {
  return *std::find_if(kKinds.begin(), kKinds.end(),
                       [&](const KindInfo& info) { return info.kind == kind; });
}

Eigen::Matrix3d about(double angle, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

}  // namespace

std::vector<CalibrationColumn> calibration_columns(const Rig& rig, bool has_wheels) {
  std::vector<CalibrationColumn> columns;
  for (std::size_t c = 0; c < rig.cameras.size(); ++c)
    for (std::size_t k = 0; k < kColumnsOfCamera; ++k)
      columns.push_back(
          {rig.cameras[c].name + "." + kKinds[k].effect, kKinds[k].kind, static_cast<int>(c)});
  for (std::size_t k = kColumnsOfCamera; has_wheels && k < kKinds.size(); ++k)
    columns.push_back({std::string("wheels0.") + kKinds[k].effect, kKinds[k].kind, -1});
  return columns;
}

double prior_sigma(CalibrationKind kind) { return info_of(kind).prior_sigma; }
double widest_interval(CalibrationKind kind) { return info_of(kind).widest; }
bool is_needed(CalibrationKind kind) { return info_of(kind).needed; }
std::string manoeuvre_for(CalibrationKind kind) { return info_of(kind).manoeuvre; }

CameraTurn turn_of(const Eigen::Vector3d& rotation_vector) {
  // R = R_y(yaw) R_x(pitch) R_z(roll).
  const Eigen::Matrix3d R = so3_exp(rotation_vector);
  return {std::asin(std::clamp(-R(1, 2), -1.0, 1.0)), std::atan2(R(0, 2), R(2, 2)),
          std::atan2(R(1, 0), R(1, 1))};
}

Eigen::Vector3d rotation_vector_of(const CameraTurn& turn) {
  return so3_log(about(turn.yaw, Eigen::Vector3d::UnitY()) *
                 about(turn.pitch, Eigen::Vector3d::UnitX()) *
                 about(turn.roll, Eigen::Vector3d::UnitZ()));
}

}  // namespace roadbook
