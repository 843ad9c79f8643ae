#include "vo/own_car_mask.hpp"

#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "base/parallel.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kSamples = 24;
constexpr std::size_t kFewest = 8;     // fewer images tell nothing
constexpr double kStillLevels = 4.0;   // mean absolute change of a pixel of the car [grey levels]
constexpr double kMovingLevels = 8.0;  // the scene as a whole must change at least so much
constexpr double kEdgeLevels =
    6.0;  // structure of the mean image that marks a still patch as a body

cv::Mat mask_from_file(const std::filesystem::path& file, const cv::Size& half) {
  if (!std::filesystem::exists(file)) return {};
  cv::Mat mask = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  if (mask.empty()) return {};
  cv::resize(mask, mask, half, 0, 0, cv::INTER_NEAREST);
  return mask;
}

// Mean absolute deviation from the mean image, pixel by pixel, over images of the whole drive.
cv::Mat mask_from_images(const Drive& drive, std::size_t camera) {
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < drive.frame_count(); ++i)
    if (drive.has_image(i, camera)) frames.push_back(i);
  if (frames.size() < kFewest) return {};
  const std::size_t count = std::min(kSamples, frames.size());
  std::vector<cv::Mat> images;
  for (std::size_t k = 0; k < count; ++k) {
    cv::Mat image = drive.read_image_half(frames[k * (frames.size() - 1) / (count - 1)], camera);
    if (!image.empty() && (images.empty() || image.size() == images.front().size()))
      images.push_back(image);
  }
  if (images.size() < kFewest) return {};
  cv::Mat mean = cv::Mat::zeros(images.front().size(), CV_32F);
  for (const auto& image : images) cv::accumulate(image, mean);
  mean /= static_cast<double>(images.size());
  cv::Mat change = cv::Mat::zeros(mean.size(), CV_32F);
  for (const auto& image : images) {
    cv::Mat difference;
    image.convertTo(difference, CV_32F);
    cv::absdiff(difference, mean, difference);
    change += difference;
  }
  change /= static_cast<double>(images.size());
  cv::blur(change, change, {9, 9});
  if (cv::mean(change)[0] < kMovingLevels) return {};
  cv::Mat still = change < kStillLevels;
  cv::Mat dx;
  cv::Mat dy;
  cv::Sobel(mean, dx, CV_32F, 1, 0);
  cv::Sobel(mean, dy, CV_32F, 0, 1);
  cv::Mat edge = cv::abs(dx) + cv::abs(dy);
  cv::blur(edge, edge, {9, 9});
  // A still patch without structure may be sky or a plain floor: no feature lies there anyway.
  const cv::Mat body = still & (edge > kEdgeLevels);
  if (cv::countNonZero(body) < 200) return {};
  cv::Mat grown;
  cv::dilate(body, grown, cv::getStructuringElement(cv::MORPH_ELLIPSE, {9, 9}));
  return 255 - grown;
}

}  // namespace

std::vector<cv::Mat> own_car_masks(const Drive& drive, int num_threads) {
  const auto& cameras = drive.rig().cameras;
  std::vector<cv::Mat> masks(cameras.size());
  const bool mav0 = std::filesystem::is_directory(drive.folder() / "mav0");
  parallel_for(cameras.size(), num_threads, [&](std::size_t c) {
    const auto folder = (mav0 ? drive.folder() / "mav0" : drive.folder()) / cameras[c].name;
    const cv::Size half(cameras[c].camera.width / 2, cameras[c].camera.height / 2);
    masks[c] = mask_from_file(folder / "mask.png", half);
    if (masks[c].empty()) masks[c] = mask_from_images(drive, c);
  });
  return masks;
}

}  // namespace roadbook
