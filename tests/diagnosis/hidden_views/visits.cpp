#include "tests/diagnosis/hidden_views/visits.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <numbers>

#include "base/random.hpp"

namespace roadbook::test {
namespace {

Descriptor descriptor_of(const HiddenViewOptions& options, std::size_t landmark, bool again) {
  Random bits(options.seed, "descriptors", landmark);
  Descriptor d{};
  for (std::uint8_t& byte : d) byte = static_cast<std::uint8_t>(bits.below(256));
  for (int i = 0; again && i < 60; ++i) {
    const std::uint64_t bit = bits.below(8 * d.size());
    d[bit / 8] = static_cast<std::uint8_t>(d[bit / 8] ^ (1U << (bit % 8)));
  }
  return d;
}

// True if the later drive does not redetect the landmark.
bool is_lost(const HiddenViewOptions& options, const OwnLandmark& landmark, Random& random) {
  if (options.lost == 0.0) return false;
  Random phase(options.seed, "lost");
  const double along = phase.uniform(0.0, 6.3);
  const double across = phase.uniform(0.0, 6.3);
  const double wave =
      std::sin(landmark.place.x() / 5.0 + along) * std::sin(landmark.place.y() / 4.0 + across);
  return random.uniform() < options.lost + 0.1 * wave;
}

}  // namespace

void add_landmark(const OwnLandmark& own, const std::vector<const HiddenSight*>& sights, Map& map) {
  Landmark landmark;
  for (const HiddenSight* sight : sights) {
    for (Observation o : sight->views) {
      o.landmark = static_cast<int>(map.landmarks.size());
      map.observations.push_back(o);
    }
    if (sight->views.empty()) continue;
    landmark.map_frame = sight->views.front().keyframe;
    landmark.p_frame = map.T_map_vehicle(landmark.map_frame).inverse() * (own.place + sight->rough);
  }
  landmark.ground = own.ground;
  if (std::any_of(sights.begin(), sights.end(),
                  [](const HiddenSight* s) { return !s->views.empty(); }))
    map.landmarks.push_back(landmark);
}

void move_landmarks(const HiddenViewOptions& options, std::vector<OwnLandmark>& landmarks) {
  const auto wanted = static_cast<std::size_t>(std::lround(
      of(options.secret, "map.moved_landmarks") * static_cast<double>(landmarks.size())));
  Random random(options.seed, "moved");
  const std::vector<OwnLandmark> before = landmarks;
  std::vector<bool> moved(landmarks.size(), false);
  std::size_t count = 0;
  while (count < wanted) {
    const Eigen::Vector3d middle = before[random.below(before.size())].place;
    const double length = random.uniform(0.2, 0.6);
    const double course = random.uniform(0.0, 2.0 * std::numbers::pi);
    const Eigen::Vector3d shift(length * std::cos(course), length * std::sin(course), 0.0);
    for (std::size_t l = 0; l < landmarks.size() && count < wanted; ++l) {
      if (moved[l] || (before[l].place - middle).norm() > 2.0) continue;
      moved[l] = true;
      landmarks[l].place += shift;
      ++count;
    }
  }
}

std::vector<GoneClump> remove_landmarks(const HiddenViewOptions& options,
                                        const std::vector<OwnLandmark>& landmarks,
                                        const HiddenSights& then,
                                        HiddenSights& now) {
  std::size_t seen = 0;
  for (const HiddenSight& sight : then) seen += sight.views.empty() ? 0 : 1;
  const double wanted = of(options.secret, "map.landmarks_gone") * static_cast<double>(seen);
  Random random(options.seed, "gone");
  std::vector<GoneClump> clumps;
  std::vector<bool> gone(landmarks.size(), false);
  for (std::size_t count = 0; static_cast<double>(count) < wanted;) {
    const Eigen::Vector3d middle = landmarks[random.below(landmarks.size())].place;
    GoneClump clump{middle.x(), middle.y(), random.uniform(1.2, 2.2)};
    for (std::size_t l = 0; l < landmarks.size(); ++l) {
      if (gone[l] || (landmarks[l].place - middle).head<2>().norm() > clump.radius_m) continue;
      gone[l] = true;
      now[l].views.clear();
      clump.landmarks += then[l].views.empty() ? 0 : 1;
    }
    count += clump.landmarks;
    clump.share = static_cast<double>(clump.landmarks) / static_cast<double>(seen);
    clumps.push_back(clump);
  }
  return clumps;
}

void write_gone(const std::vector<GoneClump>& clumps, const std::filesystem::path& file) {
  std::ofstream out(file);
  for (const GoneClump& c : clumps)
    out << c.x << ' ' << c.y << ' ' << c.radius_m << ' ' << c.landmarks << ' ' << c.share << '\n';
}

std::vector<GoneClump> read_gone(const std::filesystem::path& file) {
  std::ifstream in(file);
  std::vector<GoneClump> clumps;
  GoneClump c;
  while (in >> c.x >> c.y >> c.radius_m >> c.landmarks >> c.share) clumps.push_back(c);
  return clumps;
}

void join_visits(const HiddenViewOptions& options,
                 const std::vector<OwnLandmark>& before,
                 const HiddenSights& then,
                 const std::vector<OwnLandmark>& after,
                 const HiddenSights& now,
                 Map& map) {
  Random random(options.seed, "joined");
  for (std::size_t l = 0; l < before.size(); ++l) {
    const bool lost = is_lost(options, before[l], random);
    const bool stands = before[l].place == after[l].place && !lost;
    const std::size_t first = map.landmarks.size();
    if (stands && random.uniform() < 0.8) {
      add_landmark(before[l], {&then[l], &now[l]}, map);
    } else {
      add_landmark(before[l], {&then[l]}, map);
      add_landmark(after[l], {&now[l]}, map);
    }
    for (std::size_t i = first; i < map.landmarks.size(); ++i)
      map.landmarks[i].descriptor =
          descriptor_of(options, lost && i > first ? l + before.size() : l, i > first);
  }
}

void bend_map(const HiddenViewOptions& options, Map& map) {
  const double grown = 1.0 + of(options.secret, "map.scale");
  const double bend = of(options.secret, "map.bend");
  std::size_t first = 0;
  while (map.sessions[static_cast<std::size_t>(map.keyframes[first].session)].name != "drive")
    ++first;
  const Eigen::Vector3d origin = map.T_map_vehicle(static_cast<int>(first)).translation();
  const auto bent = [&](const Eigen::Vector3d& p) -> Eigen::Vector3d {
    const Eigen::Vector3d d = p - origin;
    return origin + grown * Eigen::Vector3d(d.x(), d.y() + 0.5 * bend * d.x() * d.x(), d.z());
  };
  std::vector<Eigen::Vector3d> places;
  for (const Landmark& l : map.landmarks) places.push_back(bent(map.p_map(l)));
  for (MapFrame& frame : map.map_frames) {
    const double away = frame.T_map_frame.translation().x() - origin.x();
    frame.T_map_frame.translation() = bent(frame.T_map_frame.translation());
    const Eigen::Vector3d ahead = frame.T_map_frame.linear().col(0);
    const double turned = std::atan2(ahead.y() + bend * away * ahead.x(), ahead.x()) -
                          std::atan2(ahead.y(), ahead.x());
    frame.T_map_frame.linear() =
        Eigen::AngleAxisd(turned, Eigen::Vector3d::UnitZ()) * frame.T_map_frame.linear();
  }
  for (std::size_t l = 0; l < places.size(); ++l) {
    Landmark& landmark = map.landmarks[l];
    landmark.p_frame =
        map.map_frames[static_cast<std::size_t>(landmark.map_frame)].T_map_frame.inverse() *
        places[l];
  }
}

}  // namespace roadbook::test
