#include "tests/diagnosis/hidden_views/gone_world.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "base/random.hpp"

namespace roadbook::test {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kBend = 6.0;     // [m] radius at either end of the lap
constexpr double kSpacing = 0.4;  // [m] between keyframes
constexpr double kReach = 10.0;   // [m] beyond which nothing is seen
constexpr std::size_t kFewestViews = 4;

double logistic(double x) { return 1.0 / (1.0 + std::exp(-x)); }

// The lap: two straights and two half circles.
Eigen::Isometry3d pose_on_lap(double s, double aside, double length_m) {
  const double straight = 0.5 * length_m - kPi * kBend;
  s = std::fmod(s + length_m, length_m);
  const bool back = s >= 0.5 * length_m;
  if (back) s -= 0.5 * length_m;
  double x = std::min(s, straight);
  double y = -kBend;
  double heading = 0.0;
  if (s > straight) {
    heading = (s - straight) / kBend;
    x = straight + kBend * std::sin(heading);
    y = -kBend * std::cos(heading);
  }
  x -= 0.5 * straight;
  if (back) {
    x = -x;
    y = -y;
    heading += kPi;
  }
  Eigen::Isometry3d T(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()));
  T.translation() = Eigen::Vector3d(x, y, 0.0) + T.linear() * Eigen::Vector3d(0.0, aside, 0.0);
  return T;
}

Rig four_fisheyes() {
  Rig rig;
  for (int c = 0; c < 4; ++c) {
    MountedCamera mounted;
    mounted.name = "cam" + std::to_string(c);
    mounted.camera.model = CameraModel::kKannalaBrandt;
    mounted.camera.width = 1280;
    mounted.camera.height = 800;
    mounted.camera.parameters = {400.0, 400.0, 639.5, 399.5, 0.0, 0.0, 0.0, 0.0};
    mounted.camera.max_angle_rad = 1.5;
    Eigen::Matrix3d axes;  // right, down, forward in the vehicle
    axes << 0.0, 0.0, 1.0, -1.0, 0.0, 0.0, 0.0, -1.0, 0.0;
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(0.5 * kPi * c, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    mounted.T_vehicle_camera.linear() = turn * axes;
    mounted.T_vehicle_camera.translation() =
        Eigen::Vector3d(1.2, 0.0, 0.9) + turn * Eigen::Vector3d(0.9, 0.0, 0.0);
    rig.cameras.push_back(mounted);
  }
  return rig;
}

struct Thing {
  Eigen::Vector2d middle, along;
  double length_m, width_m;
  double at_m;                        // along the lap
  std::array<double, 2> hidden_from;  // by drive, along the lap
  std::array<double, 2> hidden_to;
  double luck;  // in log odds of being known again
};

struct Corner {
  Eigen::Vector3d place, faces;
  double strength;  // in log odds of being seen
  int thing;
};

// Random properties of a place and of the drive that observes it.
struct Habits {
  double sees, far_m, known, by_thing, by_place, wave_m, phase_x, phase_y, dull_from_m, dull_m;
  explicit Habits(Random& random)
      : sees(random.uniform(1.0, 3.0)),
        far_m(random.uniform(2.0, 5.0)),
        known(random.uniform(-0.3, 1.5)),
        by_thing(random.uniform(0.0, 0.4)),
        by_place(random.uniform(0.0, 0.4)),
        wave_m(random.uniform(1.5, 12.0)),
        phase_x(random.uniform(0.0, 2.0 * kPi)),
        phase_y(random.uniform(0.0, 2.0 * kPi)),
        dull_from_m(random.uniform(0.0, 200.0)),
        dull_m(random.uniform(0.0, 8.0)) {}
  // Unit variance over the place.
  [[nodiscard]] double wave(const Eigen::Vector3d& p) const {
    return 2.0 * std::sin(2.0 * kPi * p.x() / wave_m + phase_x) *
           std::sin(2.0 * kPi * p.y() / wave_m + phase_y);
  }
};

std::vector<Thing> park_things(const GoneWorldOptions& options, const Habits& habits) {
  Random random(options.seed, "things");
  std::vector<Thing> things;
  for (const double side : {-1.0, 1.0})
    for (double s = random.uniform(0.0, 3.0); s < options.length_m; s += random.uniform(2.2, 4.0)) {
      Thing t;
      const Eigen::Isometry3d at =
          pose_on_lap(s, side * random.uniform(3.0, 5.0), options.length_m);
      t.middle = at.translation().head<2>();
      t.along = at.linear().col(1).head<2>();
      t.length_m = random.uniform(1.5, 4.5);
      t.width_m = random.uniform(0.5, 1.9);
      t.at_m = s;
      for (std::size_t drive = 0; drive < 2; ++drive) {
        const double middle = s + random.uniform(-5.0, 5.0);
        const double half = random.uniform() < 0.3 ? 0.5 * random.uniform(0.5, 4.0) : 0.0;
        t.hidden_from[drive] = middle - half;
        t.hidden_to[drive] = middle + half;
      }
      t.luck = habits.by_thing * random.normal();
      things.push_back(t);
    }
  return things;
}

std::vector<Corner> corners_of(const GoneWorldOptions& options, const std::vector<Thing>& things) {
  Random random(options.seed, "corners");
  std::vector<Corner> corners;
  const auto add = [&](const Eigen::Vector3d& place, int thing) {
    const double course = random.uniform(0.0, 2.0 * kPi);
    const Eigen::Vector3d faces =
        thing < 0 ? Eigen::Vector3d(Eigen::Vector3d::UnitZ())
                  : Eigen::Vector3d(std::cos(course), std::sin(course), random.uniform(-0.3, 0.6));
    corners.push_back({place, faces.normalized(), 0.7 * random.normal(), thing});
  };
  for (std::size_t i = 0; i < things.size(); ++i) {
    const Thing& t = things[i];
    const double wanted = options.per_square * t.length_m * t.width_m / 4.0;
    const Eigen::Vector2d across(-t.along.y(), t.along.x());
    for (double k = random.uniform(); k < wanted; k += 1.0) {
      const Eigen::Vector2d p = t.middle + t.along * t.length_m * random.uniform(-0.5, 0.5) +
                                across * t.width_m * random.uniform(-0.5, 0.5);
      add({p.x(), p.y(), random.uniform(0.1, 2.0)}, static_cast<int>(i));
    }
  }
  const double on_ground = 0.1 * options.per_square * options.length_m;
  for (double k = 0.0; k < on_ground; k += 1.0)
    add(pose_on_lap(random.uniform(0.0, options.length_m), random.uniform(-3.0, 3.0),
                    options.length_m)
            .translation(),
        -1);
  return corners;
}

void add_session(const GoneWorldOptions& options, int session, Map& map) {
  Random random(options.seed, "drives", static_cast<std::uint64_t>(session));
  map.sessions.emplace_back().name = session == 0 ? "earlier" : "later";
  map.sessions.back().rig = four_fisheyes();
  const double aside = session == 0 ? 0.0 : random.uniform(-0.5, 0.5);
  const double phase = random.uniform(0.0, 2.0 * kPi);
  for (double s = random.uniform(0.0, kSpacing); s < options.length_m; s += kSpacing) {
    const double weave = aside + 0.2 * std::sin(2.0 * kPi * s / 25.0 + phase);
    Keyframe k;
    k.session = session;
    k.map_frame = static_cast<int>(map.map_frames.size());
    k.travelled_m = s;
    map.map_frames.push_back({pose_on_lap(s, weave, options.length_m)});
    map.keyframes.push_back(k);
  }
}

// Views of one corner by one drive.
std::vector<Observation> views_of(const Corner& corner,
                                  int session,
                                  const Map& map,
                                  const std::vector<Thing>& things,
                                  const Habits& habits,
                                  Random& random) {
  std::vector<Observation> views;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Keyframe& keyframe = map.keyframes[k];
    const Eigen::Isometry3d& T = map.map_frames[k].T_map_frame;
    if (keyframe.session != session || (T.translation() - corner.place).norm() > kReach) continue;
    const double s = keyframe.travelled_m;
    if (corner.thing >= 0) {
      const Thing& t = things[static_cast<std::size_t>(corner.thing)];
      const auto drive = static_cast<std::size_t>(session);
      if (s > t.hidden_from[drive] && s < t.hidden_to[drive]) continue;
    }
    const bool dull =
        session == 1 && s > habits.dull_from_m && s < habits.dull_from_m + habits.dull_m;
    const auto& cameras = map.sessions[static_cast<std::size_t>(session)].rig.cameras;
    for (std::size_t c = 0; c < cameras.size(); ++c) {
      const Eigen::Vector3d p = (T * cameras[c].T_vehicle_camera).inverse() * corner.place;
      const double range = p.norm();
      const Eigen::Vector3d towards = T * cameras[c].T_vehicle_camera.translation() - corner.place;
      const double facing = towards.dot(corner.faces) / range;
      const auto pixel = cameras[c].camera.project(p);
      if (range < 0.5 || facing < 0.15 || !pixel || !cameras[c].camera.contains(*pixel, 10.0))
        continue;
      const double odds =
          habits.sees + corner.strength + std::log(facing) - std::pow(range / habits.far_m, 1.3);
      if (random.uniform() > logistic(odds) * (dull ? 0.5 : 1.0)) continue;
      Observation o;
      o.keyframe = static_cast<int>(k);
      o.camera = static_cast<int>(c);
      o.pixel = pixel->cast<float>();
      views.push_back(o);
    }
  }
  if (views.size() < kFewestViews) views.clear();
  return views;
}

void add_landmark(const Corner& corner, std::vector<Observation> views, GoneWorld& world) {
  if (views.empty()) return;
  Landmark landmark;
  landmark.map_frame = views.front().keyframe;
  landmark.p_frame = world.map.T_map_vehicle(views.front().keyframe).inverse() * corner.place;
  landmark.ground = corner.thing < 0;
  for (Observation& o : views) {
    o.landmark = static_cast<int>(world.map.landmarks.size());
    world.map.observations.push_back(o);
  }
  world.map.landmarks.push_back(landmark);
  world.thing_of.push_back(corner.thing);
}

}  // namespace

GoneWorld make_gone_world(const GoneWorldOptions& options) {
  Random random(options.seed, "habits");
  const Habits habits(random);
  GoneWorld world;
  const std::vector<Thing> things = park_things(options, habits);
  Random taken(options.seed, "gone");
  for (const Thing& t : things) {
    world.gone.push_back(taken.uniform() < options.share_gone);
    world.middle.push_back(t.middle);
  }
  for (int session = 0; session < 2; ++session) add_session(options, session, world.map);
  Random sight(options.seed, "sight");
  for (const Corner& corner : corners_of(options, things)) {
    std::vector<Observation> then = views_of(corner, 0, world.map, things, habits, sight);
    std::vector<Observation> now = views_of(corner, 1, world.map, things, habits, sight);
    const bool gone = corner.thing >= 0 && world.gone[static_cast<std::size_t>(corner.thing)];
    double odds =
        habits.known + 0.5 * corner.strength + habits.by_place * habits.wave(corner.place);
    if (corner.thing >= 0) odds += things[static_cast<std::size_t>(corner.thing)].luck;
    // A few removed landmarks are matched to something else.
    const bool known = sight.uniform() < (gone ? 0.03 : logistic(odds));
    if (known) {
      if (then.empty()) continue;
      then.insert(then.end(), now.begin(), now.end());
    } else if (!gone) {
      add_landmark(corner, now, world);
    }
    add_landmark(corner, then, world);
  }
  return world;
}

}  // namespace roadbook::test
