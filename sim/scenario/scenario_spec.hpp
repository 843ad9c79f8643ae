#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace roadbook {

// A place and a drive through it, as a scenario file describes them (docs/reference/simulation.md).
// World frame: z up, metres. Angles in radians, slopes in metres per metre.

/// A lane as its centre line in driving direction; corners are rounded when driven.
struct LaneSpec {
  std::string name;
  std::vector<Eigen::Vector2d> points;
  double width_m = 3.0;
  bool closed = false;  ///< the last point leads back to the first
};

/// A row of parking spaces side by side to the left of the line `from` - `to`, which is their open
/// front.
struct SpaceRowSpec {
  std::string name;
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  int count = 0;
  double depth_m = 5.0;
  double line_width_m = 0.12;
  double wear = 0.2;         ///< 0: fresh paint, 1: no paint left
  double paint = 0.8;        ///< brightness of the paint, 0 to 1
  double occupied = 0.5;     ///< probability that a space has a parked car
  int first_number = 0;      ///< painted number of the first space; 0: no numbers
  std::vector<int> columns;  ///< lines (0 to count) that are columns instead of paint
  int copy_of = -1;          ///< row of the first bay that this row looks like; -1: none
};

enum class CrossingStyle { kZebra, kHatching };

/// A pedestrian crossing: a strip along the way people walk.
struct CrossingSpec {
  std::string name;
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  double width_m = 2.5;
  double wear = 0.2;
  CrossingStyle style = CrossingStyle::kZebra;
};

enum class SurfaceTexture { kConcrete, kBrick, kPanel, kPlaster };

/// An upright box: pillar, cabin, building.
struct BlockSpec {
  Eigen::Vector2d at = Eigen::Vector2d::Zero();    ///< centre
  Eigen::Vector2d size = Eigen::Vector2d::Ones();  ///< along its own x and y [m]
  double height_m = 3.0;
  double heading = 0.0;
  SurfaceTexture texture = SurfaceTexture::kConcrete;
  bool pillar = false;
  int copy_of = -1;  ///< block of the first bay that this block looks like; -1: none
};

struct WallSpec {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  double height_m = 3.0;
  SurfaceTexture texture = SurfaceTexture::kConcrete;
  int posters = 0;
  int copy_of = -1;  ///< wall of the first bay that this wall looks like; -1: none
};

/// The floor falls (or rises) away from a line to both sides.
struct HingeSpec {
  Eigen::Vector2d from = Eigen::Vector2d::Zero();
  Eigen::Vector2d to = Eigen::Vector2d::Zero();
  double slope = 0.0;          ///< rise per metre away from the line, on both sides
  double drain_width_m = 0.0;  ///< 0: no drain
};

/// Storeys that look the same, one above another, and the straight ramps that join them.
struct StoreySpec {
  int count = 2;
  double height_m = 3.2;                                ///< from floor to floor
  Eigen::Vector2d ramp_from = Eigen::Vector2d::Zero();  ///< middle of the ramp's low end
  Eigen::Vector2d ramp_to = Eigen::Vector2d::Zero();    ///< of its high end; along x or y
  double ramp_width_m = 4.0;
};

struct GroundSpec {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();   ///< corner of the painted area
  Eigen::Vector2d high = Eigen::Vector2d::Zero();  ///< opposite corner
  double texel_m = 0.01;                           ///< of the painted ground
  double brightness = 0.42;                        ///< 0 to 1, as displayed
  double roughness = 1.0;                          ///< contrast of stones and spots
  double cracks_per_are = 6.0;   ///< per 100 m^2; also seams and patches in proportion
  double stains_per_are = 25.0;  ///< per 100 m^2: oil, gum, leaves
  double glare = 0.0;            ///< mirror share of the floor, 0 to 1
  double gravel_edge_m = 0.0;    ///< width of gravel on both sides of every lane
  double wet_per_are = 0.0;      ///< wet patches per 100 m^2 of lane
  std::optional<HingeSpec> hinge;
  std::optional<StoreySpec> storeys;
};

struct CeilingSpec {
  double height_m = 2.8;  ///< over z = 0
  double lamp_spacing_m = 5.0;
  double lamp_brightness = 1.0;
};

/// A part of the place that looks the same `count` times, side by side along x.
struct BaySpec {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();   ///< corner of the first bay
  Eigen::Vector2d high = Eigen::Vector2d::Zero();  ///< opposite corner
  int count = 2;

  [[nodiscard]] double step_m() const { return high.x() - low.x(); }
  /// Index of the bay that holds a place; -1: none.
  [[nodiscard]] int bay_of(const Eigen::Vector2d& place) const;
};

/// People who walk back and forth along a crossing.
struct PedestrianSpec {
  std::string crossing;
  int count = 1;
  double speed = 1.3;  ///< [m/s]
  std::vector<int> visits;
};

/// Cars that drive a route over and over.
struct TrafficSpec {
  std::vector<std::string> route;
  double speed = 2.5;
  double start_m = 0.0;  ///< along the route at the beginning
  std::vector<int> visits;
};

/// The measuring car: size, limits of the driver, wheels.
struct VehicleSpec {
  double wheelbase_m = 2.58;
  double track_width_m = 1.52;
  double wheel_radius_m = 0.31;
  double max_speed = 2.8;                 ///< [m/s]
  double max_acceleration = 1.0;          ///< [m/s^2]
  double max_braking = 1.5;               ///< [m/s^2]
  double max_lateral_acceleration = 1.2;  ///< [m/s^2]
  double max_steering = 0.60;             ///< [rad] at the road wheels
  double max_steering_rate = 0.6;         ///< [rad/s]
  double turn_radius_m = 5.0;             ///< corners of lanes are rounded to this
  double wander_m = 0.08;                 ///< deviation of the driver from the lane's centre
  double nose_down_rad = 0.0;             ///< pitch of the body against the ground under the wheels
  // Random slip of the wheels: standard deviations after a metre.
  double distance_scatter_m = 0.01;
  double heading_scatter_rad = 0.003;
};

struct StopSpec {
  double at_m = 0.0;  ///< along the route of one lap
  double seconds = 1.0;
};

struct CameraSpec {
  int width = 1280;
  int height = 960;
  double rate_hz = 12.5;
};

struct Scenario {
  std::string name;
  std::string file;           ///< file that it was read from
  std::string size = "full";  ///< chosen when loading
  std::uint64_t seed = 1;     ///< of the place: its texture and the cars that stand in it
  int visit = 0;              ///< chosen when loading
  GroundSpec ground;
  std::optional<CeilingSpec> ceiling;
  std::optional<BaySpec> bays;  ///< `rows`, `blocks` and `walls` hold their copies too
  std::vector<LaneSpec> lanes;
  std::vector<SpaceRowSpec> rows;
  std::vector<CrossingSpec> crossings;
  std::vector<BlockSpec> blocks;
  std::vector<WallSpec> walls;
  std::vector<PedestrianSpec> pedestrians;
  std::vector<TrafficSpec> traffic;
  VehicleSpec vehicle;
  CameraSpec cameras;
  std::vector<std::string> route;  ///< lanes of one lap, in driving order
  std::vector<StopSpec> stops;
  std::vector<int> laps;  ///< laps by visit
  bool imu = false;
  bool friction = false;

  [[nodiscard]] const LaneSpec& lane(const std::string& lane_name) const;
  [[nodiscard]] const CrossingSpec& crossing(const std::string& crossing_name) const;
};

}  // namespace roadbook
