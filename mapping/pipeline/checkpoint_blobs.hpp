#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "mapping/loops/loop_closure.hpp"
#include "vo/keyframe_track.hpp"

namespace roadbook {

// Checkpoints: results of stages as bytes, so that an interrupted build can resume. Only the same
// version of the program reads the bytes (the version is part of the key of the build).

/// Number of chunks in which keyframes are saved. A chunk has a bounded size, so that saving needs
/// no copy of all keyframes.
[[nodiscard]] std::size_t keyframe_chunks(const VoResult& odometry);
/// Bytes of chunk number `chunk`, counted from 0.
[[nodiscard]] std::string keyframes_to_blob(const VoResult& odometry, std::size_t chunk);
[[nodiscard]] std::string tracks_to_blob(const VoResult& odometry);

[[nodiscard]] std::string loops_to_blob(const std::vector<LoopClosure>& loops);
[[nodiscard]] std::vector<LoopClosure> loops_from_blob(std::string_view blob);

/// Appends the keyframes or tracks in `blob` to `odometry`.
void append_keyframes(std::string_view blob, VoResult& odometry);
void append_tracks(std::string_view blob, VoResult& odometry);

}  // namespace roadbook
