#include "mapping/pipeline/odometry_checkpoint.hpp"

#include <malloc.h>

#include <utility>

#include "base/error.hpp"
#include "base/index.hpp"
#include "mapping/pipeline/checkpoint_blobs.hpp"

namespace roadbook {

namespace {

std::string keyframe_stage(const std::string& stage, std::size_t chunk) {
  return stage + ".keyframes" + std::to_string(chunk);
}

std::size_t chunks_of(const std::string& stage, const MapFileBuilder& build) {
  return std::stoul(build.load(stage, "chunks"));
}

// Moves the descriptors of checkpointed keyframes to those that are left of a drive. Both ascend by
// their frame in the drive.
void give_descriptors(VoResult& stored, int session, MappingInput& input, std::size_t& next) {
  auto& keyframes = input.odometry.keyframes;
  for (VoKeyframe& from : stored.keyframes) {
    if (next == keyframes.size() || input.session[next] != session) return;
    if (keyframes[next].frame != from.frame) continue;  // taken away with a short segment
    for (std::size_t c = 0; c < from.features.size(); ++c)
      keyframes[next].features[c].descriptors = std::move(from.features[c].descriptors);
    ++next;
  }
}

}  // namespace

std::string odometry_stage(std::size_t drive) { return "odometry" + std::to_string(drive); }

void save_odometry(const VoResult& odometry, const std::string& stage, MapFileBuilder& build) {
  const std::size_t chunks = keyframe_chunks(odometry);
  for (std::size_t i = 0; i < chunks; ++i)
    build.save(keyframe_stage(stage, i), {{"keyframes", keyframes_to_blob(odometry, i)}});
  build.save(stage, {{"chunks", std::to_string(chunks)}, {"tracks", tracks_to_blob(odometry)}});
}

VoResult load_odometry(const std::string& stage, const MapFileBuilder& build) {
  VoResult odometry;
  const std::size_t chunks = chunks_of(stage, build);
  for (std::size_t i = 0; i < chunks; ++i)
    append_keyframes(build.load(keyframe_stage(stage, i), "keyframes"), odometry);
  append_tracks(build.load(stage, "tracks"), odometry);
  return odometry;
}

DescriptorMemory::DescriptorMemory(const MapFileBuilder& build,
                                   std::size_t least_bytes,
                                   MappingInput& input)
    : build_(build), input_(input) {
  std::size_t bytes = 0;
  for (const VoKeyframe& keyframe : input.odometry.keyframes)
    for (const Features& features : keyframe.features)
      bytes += features.size() * sizeof(Descriptor);
  stays_ = bytes < least_bytes;
}

void DescriptorMemory::need(bool needed) {
  if (stays_ || needed == present_) return;
  present_ = needed;
  if (!needed) {
    for (VoKeyframe& keyframe : input_.odometry.keyframes)
      for (Features& features : keyframe.features) features.descriptors = {};
    malloc_trim(0);  // else the heap keeps the pages
    return;
  }
  std::size_t next = 0;
  for (std::size_t drive = 0; drive < input_.half_rigs.size(); ++drive) {
    const std::string stage = odometry_stage(drive);
    for (std::size_t i = 0; i < chunks_of(stage, build_); ++i) {
      VoResult stored;
      append_keyframes(build_.load(keyframe_stage(stage, i), "keyframes"), stored);
      give_descriptors(stored, static_cast<int>(drive), input_, next);
    }
  }
  ROADBOOK_ASSERT(next == input_.odometry.keyframes.size());
}

}  // namespace roadbook
