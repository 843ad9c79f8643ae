#include "workflows/localisation/localisation_files.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "base/format.hpp"
#include "base/index.hpp"
#include "exchange/export/tum_line.hpp"

namespace roadbook {
namespace {

// Names of the components of the perturbation: translation along, and rotation about, the axes of
// the vehicle.
constexpr std::array<const char*, 6> kComponent{"x", "y", "z", "rx", "ry", "rz"};

std::string header() {
  std::string text = "#timestamp [ns],status,x [m],y [m],z [m],qw [],qx [],qy [],qz []";
  for (std::size_t i = 0; i < 6; ++i)
    for (std::size_t j = i; j < 6; ++j)
      text += std::string(",cov_") + kComponent[i] + "_" + kComponent[j];
  return text +
         ",map_frame,landmarks,matched,inliers,cameras,chi2,since_fix [m],cpu [ms]"
         ",local_sigma_x [m],local_sigma_y [m],local_sigma_heading [rad]\n";
}

std::string value(double x, int decimals) { return std::isfinite(x) ? fixed(x, decimals) : ""; }

std::string scientific(double x) {
  if (!std::isfinite(x)) return "";
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), "%.6e", x);
  return text.data();
}

std::string pose_columns(const LocalisedFrame& pose) {
  constexpr int kPlace = 6;
  constexpr int kTurn = 9;
  std::string text;
  const bool is_known_pose = pose.status != LocalisationStatus::kLost;
  const Eigen::Vector3d p = pose.T_map_vehicle.translation();
  const Eigen::Quaterniond q = Eigen::Quaterniond(pose.T_map_vehicle.linear()).normalized();
  for (const double x : {p.x(), p.y(), p.z()})
    text += "," + (is_known_pose ? fixed(x, kPlace) : std::string());
  for (const double x : {q.w(), q.x(), q.y(), q.z()})
    text += "," + (is_known_pose ? fixed(x, kTurn) : std::string());
  for (int i = 0; i < 6; ++i)
    for (int j = i; j < 6; ++j) text += "," + scientific(pose.covariance(i, j));
  return text;
}

}  // namespace

std::string localised_tum(const std::vector<TimedFrame>& frames, bool with_predicted) {
  std::string text;
  for (const TimedFrame& frame : frames) {
    const LocalisationStatus status = frame.pose.status;
    if (status == LocalisationStatus::kLost) continue;
    if (status == LocalisationStatus::kPredicted && !with_predicted) continue;
    text += tum_line(frame.pose.t_ns, frame.pose.T_map_vehicle);
  }
  return text;
}

std::string localised_csv(const std::vector<TimedFrame>& frames, const Map& map) {
  std::string text = header();
  for (const TimedFrame& frame : frames) {
    const LocalisedFrame& pose = frame.pose;
    text += std::to_string(pose.t_ns) + "," + std::string(name_of(pose.status));
    text += pose_columns(pose);
    const bool is_lost = pose.status == LocalisationStatus::kLost;
    text += ",";
    if (!is_lost && pose.keyframe >= 0)
      text += std::to_string(map.keyframes[at(pose.keyframe)].map_frame);
    if (is_lost)
      text += ",,,,";
    else
      text += "," + std::to_string(pose.landmarks) + "," + std::to_string(pose.matched) + "," +
              std::to_string(pose.inliers) + "," + std::to_string(pose.cameras);
    text +=
        "," + value(pose.chi2, 2) + "," + value(pose.since_fix_m, 3) + "," + value(frame.cpu_ms, 2);
    for (const int i : {0, 1, 5}) text += "," + value(std::sqrt(pose.local_covariance(i, i)), 6);
    text += "\n";
  }
  return text;
}

}  // namespace roadbook
