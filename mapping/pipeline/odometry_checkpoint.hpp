#pragma once

#include <cstddef>
#include <string>

#include "mapping/joined_tracks.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "vo/keyframe_track.hpp"

namespace roadbook {

/// Saves the odometry of a drive as checkpoint `stage`, with its keyframes in chunks of
/// bounded size.
void save_odometry(const VoResult& odometry, const std::string& stage, MapFileBuilder& build);

/// Returns the odometry that `save_odometry` saved as `stage`.
[[nodiscard]] VoResult load_odometry(const std::string& stage, const MapFileBuilder& build);

/// The checkpoint of a drive's odometry.
[[nodiscard]] std::string odometry_stage(std::size_t drive);

/// The descriptors of all keyframes, which are taken out of memory while nothing reads them and
/// come back from the checkpoints of the drives. Those of small maps stay.
class DescriptorMemory {
 public:
  /// `input`: joined from the drives, in order; outlives this object. Descriptors of less than
  /// `least_bytes` in all stay in memory.
  DescriptorMemory(const MapFileBuilder& build, std::size_t least_bytes, MappingInput& input);
  /// Makes sure that the descriptors are in memory, or that they are not.
  void need(bool needed);

 private:
  const MapFileBuilder& build_;
  MappingInput& input_;
  bool stays_;
  bool present_ = true;
};

}  // namespace roadbook
