#pragma once

#include <string>

#include "mapping/store/map_file_builder.hpp"
#include "vo/keyframe_track.hpp"

namespace roadbook {

/// Saves the odometry of a drive as checkpoint `stage`, with its keyframes in chunks of
/// bounded size.
void save_odometry(const VoResult& odometry, const std::string& stage, MapFileBuilder& build);

/// Returns the odometry that `save_odometry` saved as `stage`.
[[nodiscard]] VoResult load_odometry(const std::string& stage, const MapFileBuilder& build);

}  // namespace roadbook
