#pragma once

#include "vo/keyframe_track.hpp"

namespace roadbook {

/// Removes the keyframes of segments (between gaps) with fewer than `fewest` keyframes, with their
/// key points. Nothing but a loop could join them, and their images see no landmark often enough.
/// Returns the number of keyframes removed.
int remove_short_segments(VoResult& odometry, int fewest);

}  // namespace roadbook
