#include "tests/diagnosis/hidden_views/view_world.hpp"

#include <algorithm>
#include <numbers>

#include "base/random.hpp"

namespace roadbook::test {
namespace {

Eigen::Matrix3d looking(double heading, double down) {
  const Eigen::Vector3d forward(std::cos(heading) * std::cos(down),
                                std::sin(heading) * std::cos(down), -std::sin(down));
  const Eigen::Vector3d right(std::sin(heading), -std::cos(heading), 0.0);
  Eigen::Matrix3d axes;
  axes.col(0) = right;
  axes.col(1) = forward.cross(right);
  axes.col(2) = forward;
  return axes;
}

// Turns two of the axes: `one` goes towards `other` by an angle.
void lean(Eigen::Matrix3d& axes, int one, int other, double angle) {
  const Eigen::Vector3d a = axes.col(one);
  const Eigen::Vector3d b = axes.col(other);
  axes.col(one) = std::cos(angle) * a + std::sin(angle) * b;
  axes.col(other) = std::cos(angle) * b - std::sin(angle) * a;
}

// The axes ahead, left and up of a body that is turned to the right, then lifts its front, then
// leans to its right.
Eigen::Matrix3d turned_body(double right, double up, double clockwise) {
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  constexpr int kAhead = 0, kLeft = 1, kUp = 2;
  lean(axes, kLeft, kAhead, right);
  lean(axes, kAhead, kUp, up);
  lean(axes, kLeft, kUp, clockwise);
  return axes;
}

}  // namespace

OwnMotion::OwnMotion(const HiddenViewOptions& options,
                     std::vector<Moment> drive,
                     double wheelbase_m,
                     double track_m)
    : drive_(std::move(drive)),
      wheelbase_m_(wheelbase_m),
      track_m_(track_m),
      slope_(of(options.secret, "ground.slope")),
      hinge_(of(options.secret, "ground.hinge")) {
  Random random(options.seed, "waves");
  for (auto* waves : {&pitch_, &roll_, &heave_})
    for (int i = 0; i < 6; ++i)
      waves->push_back({2.0 * std::numbers::pi / random.uniform(2.0, 12.0),
                        random.uniform(0.0, 6.3),
                        random.uniform(0.2, 1.0) * (waves == &heave_ ? 1e-3 : 0.8e-3)});
  // The hinge crosses the route near its middle at an angle.
  Random place(options.seed, "hinge");
  const Moment& at = drive_[static_cast<std::size_t>(place.uniform(0.3, 0.7) *
                                                     static_cast<double>(drive_.size()))];
  hinge_point_ = {at.x, at.y};
  const double angle = at.heading + place.uniform(-0.8, 0.8);
  hinge_normal_ = {std::cos(angle), std::sin(angle)};
}

double OwnMotion::ground(double x, double y) const {
  const double beyond = hinge_normal_.dot(Eigen::Vector2d(x, y) - hinge_point_);
  return beyond > 0.0 ? std::tan(hinge_) * beyond : 0.0;
}

Eigen::Isometry3d OwnMotion::body(double t_s) const {
  const Moment m = moment_at(drive_, t_s);
  // The plane through the four wheels by least squares, solved as such.
  Eigen::Matrix<double, 4, 3> A;
  Eigen::Vector4d z;
  int row = 0;
  for (const double ahead : {0.0, wheelbase_m_})
    for (const double aside : {-0.5 * track_m_, 0.5 * track_m_}) {
      A.row(row) << 1.0, ahead, aside;
      z[row++] = ground(m.x + ahead * std::cos(m.heading) - aside * std::sin(m.heading),
                        m.y + ahead * std::sin(m.heading) + aside * std::cos(m.heading));
    }
  const Eigen::Vector3d plane = A.colPivHouseholderQr().solve(z);
  const auto sum = [&](const std::vector<Wave>& waves) {
    double value = 0.0;
    for (const Wave& w : waves) value += w.size * std::sin(w.number * m.distance + w.phase);
    return value;
  };
  const Eigen::Vector3d x =
      Eigen::Vector3d(std::cos(m.heading), std::sin(m.heading), plane[1]).normalized();
  Eigen::Vector3d y(-std::sin(m.heading), std::cos(m.heading), plane[2]);
  const Eigen::Vector3d up = x.cross(y).normalized();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear().col(0) = x;
  T.linear().col(1) = up.cross(x);
  T.linear().col(2) = up;
  T.translation() = Eigen::Vector3d(m.x, m.y, plane[0] + sum(heave_));
  // `ground.slope`: the car's nose is low, so level ground rises ahead of it.
  return T * Eigen::AngleAxisd(slope_ + sum(pitch_), Eigen::Vector3d::UnitY()) *
         Eigen::AngleAxisd(sum(roll_), Eigen::Vector3d::UnitX());
}

std::vector<OwnLandmark> scatter_landmarks(const HiddenViewOptions& options,
                                           const OwnMotion& motion) {
  Random random(options.seed, "landmarks");
  std::vector<OwnLandmark> landmarks;
  const double lift = of(options.secret, "ground.height");
  const double length = motion.drive().back().distance;
  const auto count = static_cast<std::size_t>(options.landmarks_per_m * length);
  for (std::size_t i = 0; i < count; ++i) {
    OwnLandmark l;
    l.near_m = random.uniform(-6.0, length + 6.0);
    const auto by_distance = [](const Moment& m, double s) { return m.distance < s; };
    const auto found = std::lower_bound(motion.drive().begin(), motion.drive().end(),
                                        std::clamp(l.near_m, 0.0, length - 1e-6), by_distance);
    const Moment& m = *found;
    l.ground = random.uniform() < 0.3;
    const double side = random.uniform() < 0.5 ? -1.0 : 1.0;
    const double aside = side * (l.ground ? random.uniform(0.0, 3.5) : random.uniform(2.5, 10.0));
    const double ahead = l.near_m - m.distance;
    const double x = m.x + ahead * std::cos(m.heading) - aside * std::sin(m.heading);
    const double y = m.y + ahead * std::sin(m.heading) + aside * std::cos(m.heading);
    const double rough = 0.006 * random.normal();
    const double z = l.ground ? lift + rough : random.uniform(0.2, 3.0);
    l.place = {x, y, motion.ground(x, y) + z};
    l.reach_m = l.ground ? random.uniform(1.5, 5.0) : random.uniform(2.0, 7.0);
    landmarks.push_back(l);
  }
  return landmarks;
}

std::vector<OwnCamera> nominal_cameras() {
  const double quarter = 0.5 * std::numbers::pi;
  std::vector<OwnCamera> cameras(4);
  const Eigen::Vector3d places[4] = {
      {3.6, 0.01, 0.70}, {1.9, 0.95, 1.00}, {-0.9, -0.02, 0.90}, {1.9, -0.96, 1.01}};
  for (std::size_t c = 0; c < 4; ++c) {
    const double d = static_cast<double>(c);
    cameras[c].place = places[c];
    cameras[c].axes = looking(quarter * d + 0.01 * (d - 1.5), 0.30 + 0.03 * d);
    cameras[c].lens = {409.0 + d, 641.0 + d, 398.0 - d, -0.010 + 0.001 * d, 0.002, -0.001, 0.0001};
  }
  return cameras;
}

std::vector<OwnCamera> hidden_cameras(const Secret& secret) {
  std::vector<OwnCamera> cameras = nominal_cameras();
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const auto size = [&](const std::string& effect) {
      return of(secret, "cam." + effect) + of(secret, "cam" + std::to_string(c) + "." + effect);
    };
    OwnCamera& camera = cameras[c];
    camera.lens.focal *= 1.0 + size("focal");
    camera.lens.stretch += 0.5 * size("aspect");
    camera.lens.centre_u += size("centre") + size("centre_x");
    camera.lens.centre_v += size("centre") + size("centre_y");
    camera.lens.k1 += size("distortion");
    camera.lens.k2 += size("distortion2");
    constexpr int kRight = 0, kDown = 1, kForward = 2;
    lean(camera.axes, kForward, kRight, size("rotation"));
    lean(camera.axes, kDown, kForward, size("pitch"));
    lean(camera.axes, kRight, kDown, size("roll"));
    camera.place += Eigen::Vector3d(size("position"), size("lateral"), size("height"));
    // The whole rig: about the vehicle's own axes.
    const Eigen::Matrix3d turned =
        turned_body(of(secret, "rig.rotation"), of(secret, "rig.pitch"), of(secret, "rig.roll"));
    camera.axes = turned * camera.axes;
    camera.place = turned * camera.place;
    camera.latency_s = size("latency");
    camera.shutter_s = size("rolling_shutter");
  }
  return cameras;
}

}  // namespace roadbook::test
