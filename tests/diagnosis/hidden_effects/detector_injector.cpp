#include "tests/diagnosis/hidden_effects/detector_injector.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "base/random.hpp"
#include "drive/writer.hpp"

namespace roadbook::test {
namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr int kSectors = 36;
constexpr double kLooked = 10.0;  // out to here people are looked for [m]

struct Place {
  double x = 0.0, y = 0.0;
};
struct DetectorPose {
  double x, y, heading;
};

// Four cameras on a car: place and azimuth of the axis.
struct Mount {
  double x, y, azimuth;
};
constexpr Mount kMounts[] = {{3.4, 0.0, 0.0},
                             {1.9, 0.9, 0.5 * kHalfTurn},
                             {-0.8, 0.0, kHalfTurn},
                             {1.9, -0.9, -0.5 * kHalfTurn}};

// Returns the nearest camera that has (x, y), in the vehicle frame, within 95 degrees of its axis;
// null if no camera does.
const Mount* seeing(double x, double y) {
  const Mount* best = nullptr;
  double nearest = kLooked;
  for (const Mount& m : kMounts) {
    const double dx = x - m.x, dy = y - m.y, r = std::hypot(dx, dy);
    const double off = std::remainder(std::atan2(dy, dx) - m.azimuth, 2.0 * kHalfTurn);
    if (r < 1.0 || r > nearest || std::abs(off) > 1.66) continue;
    nearest = r;
    best = &m;
  }
  return best;
}

// Lanes of a car park: straights joined by bends of 5 m radius, alternately left and right, at
// varying speed.
std::vector<DetectorPose> route(Random& random) {
  std::vector<DetectorPose> poses;
  DetectorPose p{0.0, 0.0, random.uniform(-kHalfTurn, kHalfTurn)};
  double s = 0.0, speed = random.uniform(1.5, 2.5), wanted = speed, bend = 0.0;
  double next = random.uniform(12.0, 30.0);
  while (s < 300.0) {
    poses.push_back(p);
    if (s > next) {
      bend = bend != 0.0 ? 0.0 : (random.uniform() < 0.5 ? 1.0 : -1.0);
      next = s + (bend != 0.0 ? 5.0 * 0.5 * kHalfTurn : random.uniform(12.0, 30.0));
      wanted = bend != 0.0 ? random.uniform(1.0, 1.8) : random.uniform(1.5, 3.5);
    }
    speed += 0.1 * std::clamp(wanted - speed, -1.0, 1.0);
    const double ds = 0.1 * speed;
    p.x += ds * std::cos(p.heading);
    p.y += ds * std::sin(p.heading);
    p.heading += ds * bend / 5.0;
    s += ds;
  }
  return poses;
}

// A pedestrian near the route: either stays in place, or walks to and fro along a line with rests.
struct Person {
  std::vector<Place> at;  // every 0.1 s
};

Person person(const std::vector<DetectorPose>& route, bool stands, Random& random) {
  const DetectorPose& near = route[random.below(route.size())];
  const double side = (random.uniform() < 0.5 ? 1.0 : -1.0) * random.uniform(1.8, 7.0);
  Place p{near.x - side * std::sin(near.heading), near.y + side * std::cos(near.heading)};
  const double way = random.uniform(0.0, 2.0 * kHalfTurn), speed = random.uniform(0.8, 1.6);
  const double length = random.uniform(4.0, 12.0);
  double along = random.uniform(0.0, length), direction = random.uniform() < 0.5 ? 1.0 : -1.0;
  double rest = 0.0;
  Person one;
  for (std::size_t k = 0; k < route.size(); ++k) {
    if (!stands && rest <= 0.0) {
      along += 0.1 * direction * speed;
      if (along < 0.0 || along > length) {
        direction = -direction;
        rest = random.uniform(0.0, 4.0);
      }
    }
    rest -= 0.1;
    one.at.push_back({p.x + along * std::cos(way) + (stands ? 0.01 * random.normal() : 0.0),
                      p.y + along * std::sin(way) + (stands ? 0.01 * random.normal() : 0.0)});
  }
  return one;
}

// The place in the vehicle frame at `pose`.
Place in_vehicle(const DetectorPose& pose, const Place& p) {
  const double c = std::cos(pose.heading), s = std::sin(pose.heading);
  const double dx = p.x - pose.x, dy = p.y - pose.y;
  return {c * dx + s * dy, c * dy - s * dx};
}

DetectorPose between(const std::vector<DetectorPose>& route, double k) {
  const double clamped = std::clamp(k, 0.0, static_cast<double>(route.size()) - 1.001);
  const auto i = static_cast<std::size_t>(clamped);
  const double f = clamped - static_cast<double>(i);
  const DetectorPose &a = route[i], &b = route[i + 1];
  return {a.x + f * (b.x - a.x), a.y + f * (b.y - a.y), a.heading + f * (b.heading - a.heading)};
}

struct Detector {
  double recall, along, across, false_alarms;
  const Secret& secret;

  // The detection of a pedestrian at p (vehicle frame) as a row of the table; empty: missed.
  std::string row(const Place& p, const Mount& eye, std::int64_t t_ns, Random& random) const {
    const double dx = p.x - eye.x, dy = p.y - eye.y, r = std::hypot(dx, dy);
    const double ux = dx / r, uy = dy / r;
    const double odds = std::log(recall / (1.0 - recall)) - of(secret, "detector.range") * r -
                        of(secret, "side") * std::sin(std::atan2(dy, dx));
    const double found = random.uniform(), n1 = random.normal(), n2 = random.normal();
    if (found > 1.0 / (1.0 + std::exp(-odds))) return {};
    const double sigma = along * r + 0.02;
    constexpr double kCamera = 0.9;  // height [m]
    const double far =
        of(secret, "detector.foot_point") + of(secret, "pitch") * r * r / kCamera + sigma * n1;
    const double x = p.x + far * ux - across * n2 * uy, y = p.y + far * uy + across * n2 * ux;
    // The stated uncertainty is wrong by a quarter.
    const double a = 1.25 * sigma, b = 0.8 * across;
    char text[240];
    std::snprintf(text, sizeof text, "%lld,%.4f,%.4f,%.4f,%.3f,%.3f,%.3f,%.6f,%.6f,%.6f\n",
                  static_cast<long long>(t_ns), x, y, std::hypot(a, b) / std::sqrt(2.0), 0.9, eye.x,
                  eye.y, a * a * ux * ux + b * b * uy * uy, (a * a - b * b) * ux * uy,
                  a * a * uy * uy + b * b * ux * ux);
    return text;
  }
};

std::string reach_columns() {
  std::string text;
  for (int k = 0; k < kSectors; ++k) {
    const double angle = 2.0 * kHalfTurn * (k + 0.5) / kSectors;
    double reach = 0.0;
    for (double r = 0.2; r < 16.0; r += 0.1) {
      if (seeing(r * std::cos(angle), r * std::sin(angle)) != nullptr)
        reach = r;
      else if (reach > 0.0)
        break;
    }
    char one[16];
    std::snprintf(one, sizeof one, ",%.1f", reach);
    text += one;
  }
  return text + "\n";
}

}  // namespace

void write_detector_drive(const DetectorSecret& hidden, const std::filesystem::path& folder) {
  Random random(hidden.seed, "detector drive");
  const std::vector<DetectorPose> way = route(random);
  std::vector<Person> people;
  const std::uint64_t noon = 30 + random.below(21);
  const std::uint64_t there = hidden.people > 0 ? hidden.people : noon;
  // Six in ten stand: at a boot, by a door, waiting.
  for (std::uint64_t i = 0; i < there; ++i)
    people.push_back(person(way, 10 * i < 6 * there, random));
  const Detector detector{random.uniform(0.9, 0.98), random.uniform(0.03, 0.06),
                          random.uniform(0.03, 0.07), random.uniform(0.01, 0.08), hidden.secret};
  const int every = 2 + static_cast<int>(random.below(2));  // tenths of a second
  DriveWriterOptions options;
  options.overwrite = true;
  DriveWriter writer(folder, {}, std::nullopt, options);
  std::vector<TimedPose> poses;
  std::string rows =
      "#timestamp [ns],x [m],y [m],sigma [m],probability [-],eye_x [m],eye_y [m],xx [m^2],xy "
      "[m^2],yy [m^2]\n";
  std::string looks = "#timestamp [ns]";
  for (int k = 0; k < kSectors; ++k) looks += ",reach_" + std::to_string(k) + " [m]";
  looks += "\n";
  const std::string reach = reach_columns();
  Random noise(hidden.seed, "detector");
  for (std::size_t k = 0; k < way.size(); ++k) {
    const std::int64_t t_ns = kHiddenStart + static_cast<std::int64_t>(k) * 100'000'000;
    poses.push_back({t_ns, Eigen::Translation3d(way[k].x + 0.01 * noise.normal(),
                                                way[k].y + 0.01 * noise.normal(), 0.0) *
                               Eigen::AngleAxisd(way[k].heading + 0.001 * noise.normal(),
                                                 Eigen::Vector3d::UnitZ())});
    if (k % static_cast<std::size_t>(every) != 0) continue;
    looks += std::to_string(t_ns) + reach;
    // Late stamps: the image shows an earlier time.
    const DetectorPose seen =
        between(way, static_cast<double>(k) - 10.0 * of(hidden.secret, "late"));
    for (const Person& one : people) {
      const Place p = in_vehicle(seen, one.at[k]);
      if (const Mount* eye = seeing(p.x, p.y)) rows += detector.row(p, *eye, t_ns, noise);
    }
    if (noise.uniform() < detector.false_alarms) {
      const Place p{noise.uniform(-9.0, 11.0), noise.uniform(-9.0, 9.0)};
      if (const Mount* eye = seeing(p.x, p.y)) rows += detector.row(p, *eye, t_ns, noise);
    }
  }
  writer.write_truth(poses);
  writer.finish();
  std::filesystem::create_directories(folder / "detector0");
  std::ofstream(folder / "detector0" / "data.csv") << rows;
  if (hidden.looks) std::ofstream(folder / "detector0" / "looks.csv") << looks;
}

const std::vector<EffectRange>& detector_ranges() {
  static const std::vector<EffectRange> kRanges{
      {"detector.range", 0.1, 0.4, true},
      {"detector.foot_point", 0.05, 0.4, false},
  };
  return kRanges;
}

const std::vector<EffectRange>& outside_detector_ranges() {
  static const std::vector<EffectRange> kRanges{
      {"pitch", 0.01, 0.03, false},
      {"late", 0.08, 0.3, true},
      {"side", 1.0, 2.5, false},
  };
  return kRanges;
}

}  // namespace roadbook::test
