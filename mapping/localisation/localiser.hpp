#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "mapping/localisation/relocaliser.hpp"
#include "sensors/wheels.hpp"

namespace roadbook {

// Localisation of a vehicle in a map that does not change, frame by frame [metric-semantic maps,
// section IV-C].

enum class LocalisationStatus {
  kLocalised,    ///< landmarks give the pose
  kRelocalised,  ///< the same, found without a prediction
  kPredicted,    ///< only the motion since the last fix gives the pose
  kLost,         ///< the pose is not known
};

/// "localised", "relocalised", "predicted" or "lost".
[[nodiscard]] std::string_view name_of(LocalisationStatus status);

struct LocaliserOptions {
  FrameFixOptions fix;
  RelocaliseOptions relocalise;
  bool may_relocalise = true;    ///< false: a lost vehicle stays lost
  double max_jump_chi2 = 27.86;  ///< of a fix against the prediction: 6 degrees, p = 1e-4
  int max_jumps = 5;             ///< contradicting frames in a row after which the pose is lost
  double lost_m = 1.0;           ///< standard deviation of the place beyond which it is lost
  double lost_rad = 0.0873;      ///< the same, of the heading: 5 degrees
  double lost_after_m = 20.0;    ///< driven since the last fix
  double confirm_m = 2.0;        ///< driven before a pose without prediction is believed
  double confirm_share = 0.6;    ///< of the frames meanwhile, that must have a fix
  double retry_s = 0.08;         ///< between two tries to relocalise
  /// Errors of the wheels that do not average out, relative to way and turn since the last fix.
  double wheel_error = 0.02;
  /// Without wheels the car is expected to keep its velocity; these accelerations, for all of the
  /// time since the last fix, are the standard deviations of what it does instead.
  double acceleration_m_s2 = 4.0;
  double angular_acceleration_rad_s2 = 1.5;

  /// Throws InvalidOption.
  void check() const;
};

/// One frame as `Localiser` receives it.
struct LocaliserFrame {
  std::size_t frame = 0;  ///< index in the drive
  std::int64_t t_ns = 0;
  std::vector<Features> features;      ///< per camera, of the half-size images
  std::optional<PlanarMotion> wheels;  ///< since the frame before; empty: not known
};

struct LocalisedFrame {
  std::size_t frame = 0;  ///< index in the drive
  std::int64_t t_ns = 0;
  LocalisationStatus status = LocalisationStatus::kLost;
  /// A pose without prediction that driving has not confirmed yet; `status` is kLost.
  bool tentative = false;
  Eigen::Isometry3d T_map_vehicle = Eigen::Isometry3d::Identity();  ///< meaningless when lost
  /// Of the right perturbation, in the map frame: `local_covariance` and that of the map's nearest
  /// pose; NaN: unknown, as in a map without covariances.
  Matrix6d covariance = unknown_covariance<Matrix6d>();
  /// The same against the landmarks around, and so against lanes and labels that lie there.
  Matrix6d local_covariance = unknown_covariance<Matrix6d>();
  int keyframe = -1;                ///< nearest of the map; -1: lost
  std::vector<LandmarkView> views;  ///< inliers
  std::vector<int> in_view;         ///< landmarks that project into an image, ascending
  int landmarks = 0;                ///< number of `in_view`
  int matched = 0;                  ///< of them with a partner among the corners
  int inliers = 0;                  ///< number of `views`
  int cameras = 0;                  ///< that have inliers
  double chi2 = std::numeric_limits<double>::quiet_NaN();  ///< of the inliers
  double since_fix_m = std::numeric_limits<double>::quiet_NaN();
  /// Distance between this pose and the last one moved by the wheels; NaN without either.
  double jump_m = std::numeric_limits<double>::quiet_NaN();
};

/// Localises frames in ascending order of time. Keeps a reference to the index. Deterministic. Not
/// for concurrent use.
class Localiser {
 public:
  Localiser(const LandmarkIndex& index, Rig half_rig, const LocaliserOptions& options);
  ~Localiser();
  Localiser(Localiser&&) noexcept;
  Localiser& operator=(Localiser&&) noexcept;

  /// The vehicle stands near this pose, within 5 m and 30 degrees. The start is tried for 2 s, then
  /// it is forgotten. Throws InvalidOption if the map has no keyframe within 10 m.
  void start_near(double x_m, double y_m, double heading_rad);

  /// Builds the search for places without a guess; otherwise the first frame that needs it does.
  void prepare();

  /// Predicts, searches and solves for the pose of one frame.
  [[nodiscard]] LocalisedFrame add(LocaliserFrame frame);

  /// True directly after `add` has confirmed a pose that was found without a prediction. The
  /// unbroken run of `tentative` frames before this one is then right.
  [[nodiscard]] bool confirmed() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace roadbook
