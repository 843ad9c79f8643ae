#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/loops/loop_closure.hpp"
#include "vo/keyframe_track.hpp"

namespace roadbook {

// Results of stages as bytes, so that a build that was killed goes on where it stood. The bytes are
// read only by the program that wrote them (the build's key contains its version).

/// Keyframes come in pieces of bounded size, so that no copy of all of them is needed.
[[nodiscard]] std::size_t keyframe_pieces(const VoResult& odometry);
[[nodiscard]] std::string keyframes_to_blob(const VoResult& odometry, std::size_t piece);
[[nodiscard]] std::string tracks_to_blob(const VoResult& odometry);

[[nodiscard]] std::string loops_to_blob(const std::vector<LoopClosure>& loops);
[[nodiscard]] std::vector<LoopClosure> loops_from_blob(std::string_view blob);

/// Adds what one blob holds.
void append_keyframes(std::string_view blob, VoResult& odometry);
void append_tracks(std::string_view blob, VoResult& odometry);

}  // namespace roadbook
