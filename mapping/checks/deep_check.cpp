#include "mapping/checks/deep_check.hpp"

#include <algorithm>
#include <limits>

#include "base/index.hpp"
#include "mapping/checks/covariance_check.hpp"
#include "mapping/checks/finding.hpp"
#include "mapping/checks/join_check.hpp"
#include "mapping/checks/view_check.hpp"
#include "vo/odometry_run.hpp"
#include "vo/track_options.hpp"

namespace roadbook {
namespace {

constexpr double kSameKeyPointPx = 0.5;  // full-size image
// Bits of 512 in which a descriptor differs from another view of its corner: up to 190 in sound
// maps. Random ones differ in 256 +- 11.
constexpr int kMostBits = 205;
constexpr std::size_t kImagesAtOnce = 8;

// Least distance of each landmark's descriptor to those of its key points in one session.
void compare_session(const Map& map,
                     int session,
                     const Drive& drive,
                     int num_threads,
                     std::vector<int>& least_bits) {
  std::vector<std::vector<const Observation*>> seen(map.keyframes.size());
  for (const Observation& o : map.observations) seen[at(o.keyframe)].push_back(&o);
  std::vector<std::size_t> frames;
  std::vector<std::size_t> keyframes;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    if (map.keyframes[k].session == session) {
      frames.push_back(static_cast<std::size_t>(map.keyframes[k].drive_frame));
      keyframes.push_back(k);
    }
  TrackDriveOptions options;
  options.num_threads = num_threads;
  const std::vector<cv::Mat> no_masks(drive.rig().cameras.size());
  for (std::size_t begin = 0; begin < frames.size(); begin += kImagesAtOnce) {
    const auto described = describe_frames(drive, frames, begin, kImagesAtOnce, no_masks, options);
    for (std::size_t i = 0; i < described.size(); ++i)
      for (const Observation* o : seen[keyframes[begin + i]]) {
        const Features& features = described[i][at(o->camera)];
        for (std::size_t f = 0; f < features.size(); ++f) {
          const Eigen::Vector2d pixel = full_size_pixel(features.pixels[f].cast<double>());
          if ((pixel - o->pixel.cast<double>()).norm() > kSameKeyPointPx) continue;
          int& bits = least_bits[at(o->landmark)];
          bits = std::min(
              bits, hamming(features.descriptors[f], map.landmarks[at(o->landmark)].descriptor));
        }
      }
  }
}

}  // namespace

std::vector<Problem> deep_map_problems(const Map& map) {
  std::vector<Problem> problems = view_problems(map);
  for (const auto& more : {join_problems(map), covariance_problems(map)})
    problems.insert(problems.end(), more.begin(), more.end());
  return problems;
}

std::vector<Problem> descriptor_problems(const Map& map,
                                         const std::vector<const Drive*>& drives,
                                         int num_threads) {
  constexpr int kNotSeen = std::numeric_limits<int>::max();
  std::vector<int> least_bits(map.landmarks.size(), kNotSeen);
  for (std::size_t s = 0; s < drives.size(); ++s)
    if (drives[s] != nullptr)
      compare_session(map, static_cast<int>(s), *drives[s], num_threads, least_bits);
  // The descriptor may be that of a view whose recording is not there.
  for (const Observation& o : map.observations)
    if (drives[at(map.keyframes[at(o.keyframe)].session)] == nullptr)
      least_bits[at(o.landmark)] = kNotSeen;
  std::vector<int> wrong;
  for (std::size_t l = 0; l < least_bits.size(); ++l)
    if (least_bits[l] != kNotSeen && least_bits[l] > kMostBits)
      wrong.push_back(static_cast<int>(l));
  if (wrong.empty()) return {};
  return {finding("landmarks " + first_of(wrong),
                  std::to_string(wrong.size()) + " descriptors unlike all their views",
                  "the descriptor of one of their key points")};
}

}  // namespace roadbook
