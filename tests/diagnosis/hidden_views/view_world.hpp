#pragma once

#include <vector>

#include "tests/diagnosis/hidden_effects/vehicle.hpp"
#include "tests/diagnosis/hidden_views/lens.hpp"
#include "tests/diagnosis/hidden_views/view_injector.hpp"

namespace roadbook::test {

/// Pose of the car's body at any time, on flat ground with small waves and the hidden effects.
class OwnMotion {
 public:
  OwnMotion(const HiddenViewOptions& options,
            std::vector<Moment> drive,
            double wheelbase_m,
            double track_m);
  [[nodiscard]] Eigen::Isometry3d body(double t_s) const;
  /// Height of the ground [m], without the waves that shake the car.
  [[nodiscard]] double ground(double x, double y) const;
  [[nodiscard]] const std::vector<Moment>& drive() const { return drive_; }

 private:
  std::vector<Moment> drive_;
  double wheelbase_m_, track_m_;
  double slope_ = 0.0, hinge_ = 0.0;
  Eigen::Vector2d hinge_point_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d hinge_normal_ = Eigen::Vector2d::UnitX();
  struct Wave {
    double number, phase, size;
  };
  std::vector<Wave> pitch_, roll_, heave_;
};

struct OwnLandmark {
  Eigen::Vector3d place = Eigen::Vector3d::Zero();
  double near_m = 0.0;   ///< distance driven where it is nearest
  double reach_m = 0.0;  ///< visible within this distance
  bool ground = false;
};
[[nodiscard]] std::vector<OwnLandmark> scatter_landmarks(const HiddenViewOptions& options,
                                                         const OwnMotion& motion);

/// The four cameras by the nominal calibration, and with the hidden effects.
[[nodiscard]] std::vector<OwnCamera> nominal_cameras();
[[nodiscard]] std::vector<OwnCamera> hidden_cameras(const Secret& secret);

}  // namespace roadbook::test
