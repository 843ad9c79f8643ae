#include "semantics/overhead/view_images.hpp"

#include <string>
#include <utility>

#include "base/error.hpp"

namespace roadbook {
namespace {

std::int64_t bytes_of(const cv::Mat& image) {
  return static_cast<std::int64_t>(image.total() * image.elemSize());
}

}  // namespace

ViewImages::ViewImages(const OverheadInput& input, std::size_t most_bytes)
    : input_(input), room_(static_cast<std::int64_t>(most_bytes)) {
  for (const OverheadView& view : input.views)
    kept_.emplace_back(input.rigs[static_cast<std::size_t>(view.rig)].cameras.size());
}

cv::Mat ViewImages::first(std::size_t view, std::size_t camera) {
  cv::Mat image = read(view, camera);
  const std::int64_t bytes = bytes_of(image);
  if (room_.fetch_sub(bytes) >= bytes) {
    kept_[view][camera] = image;
  } else {
    room_ += bytes;
  }
  return image;
}

cv::Mat ViewImages::last(std::size_t view, std::size_t camera) {
  cv::Mat kept = std::exchange(kept_[view][camera], {});
  if (kept.empty()) return read(view, camera);
  room_ += bytes_of(kept);
  return kept;
}

cv::Mat ViewImages::read(std::size_t view, std::size_t camera) const {
  const OverheadView& v = input_.views[view];
  if (camera >= v.images.size() || !v.images[camera]) return {};
  cv::Mat image = v.images[camera]();
  if (image.empty()) return {};
  const MountedCamera& mounted = input_.rigs[static_cast<std::size_t>(v.rig)].cameras[camera];
  const auto size = [](int width, int height) {
    return std::to_string(width) + "x" + std::to_string(height);
  };
  if (image.type() != CV_8UC1 || image.cols != mounted.camera.width ||
      image.rows != mounted.camera.height)
    throw BadInput({Severity::kError, mounted.name, 0,
                    "image of keyframe " + std::to_string(v.keyframe),
                    size(image.cols, image.rows) + " of type " + std::to_string(image.type()),
                    size(mounted.camera.width, mounted.camera.height) + " grey 8 bit"});
  return image;
}

}  // namespace roadbook
