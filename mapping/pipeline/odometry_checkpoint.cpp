#include "mapping/pipeline/odometry_checkpoint.hpp"

#include "mapping/pipeline/checkpoint_blobs.hpp"

namespace roadbook {

namespace {

std::string keyframe_stage(const std::string& stage, std::size_t chunk) {
  return stage + ".keyframes" + std::to_string(chunk);
}

}  // namespace

void save_odometry(const VoResult& odometry, const std::string& stage, MapFileBuilder& build) {
  const std::size_t chunks = keyframe_chunks(odometry);
  for (std::size_t i = 0; i < chunks; ++i)
    build.save(keyframe_stage(stage, i), {{"keyframes", keyframes_to_blob(odometry, i)}});
  build.save(stage, {{"chunks", std::to_string(chunks)}, {"tracks", tracks_to_blob(odometry)}});
}

VoResult load_odometry(const std::string& stage, const MapFileBuilder& build) {
  VoResult odometry;
  const auto chunks = std::stoul(build.load(stage, "chunks"));
  for (std::size_t i = 0; i < chunks; ++i)
    append_keyframes(build.load(keyframe_stage(stage, i), "keyframes"), odometry);
  append_tracks(build.load(stage, "tracks"), odometry);
  return odometry;
}

}  // namespace roadbook
