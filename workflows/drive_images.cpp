#include "workflows/drive_images.hpp"

namespace roadbook {

KeyframeImages images_of_drives(const Map* map, const std::vector<std::optional<Drive>>* drives) {
  return [map, drives](int keyframe, int camera) {
    const Keyframe& k = map->keyframes[static_cast<std::size_t>(keyframe)];
    const auto& drive = (*drives)[static_cast<std::size_t>(k.session)];
    const auto frame = static_cast<std::size_t>(k.drive_frame);
    const auto c = static_cast<std::size_t>(camera);
    if (!drive || k.drive_frame < 0 || frame >= drive->frame_count() || !drive->has_image(frame, c))
      return cv::Mat();
    return drive->read_image(frame, c);
  };
}

}  // namespace roadbook
