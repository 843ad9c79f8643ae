#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/loop_closure.hpp"
#include "vo/keyframe_track.hpp"

namespace roadbook {

// Results of stages as bytes, so that a build that was killed goes on where it stood. The bytes are
// read only by the program that wrote them (the build's key contains its version).

/// Keyframes come in pieces of bounded size.
[[nodiscard]] std::map<std::string, std::string> to_blobs(const VoResult& odometry);
/// `load(name)` returns a blob saved under that name.
template <typename Load>
VoResult odometry_from_blobs(const Load& load);

[[nodiscard]] std::string loops_to_blob(const std::vector<LoopClosure>& loops);
[[nodiscard]] std::vector<LoopClosure> loops_from_blob(std::string_view blob);

/// Adds what one blob of `to_blobs` holds.
void append_keyframes(std::string_view blob, VoResult& odometry);
void append_tracks(std::string_view blob, VoResult& odometry);

template <typename Load>
VoResult odometry_from_blobs(const Load& load) {
  VoResult odometry;
  const int pieces = std::stoi(load("pieces"));
  for (int i = 0; i < pieces; ++i)
    append_keyframes(load("keyframes" + std::to_string(i)), odometry);
  append_tracks(load("tracks"), odometry);
  return odometry;
}

}  // namespace roadbook
