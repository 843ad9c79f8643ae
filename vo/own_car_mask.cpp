#include "vo/own_car_mask.hpp"

#include <algorithm>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "drive/images/image_header.hpp"
#include "vo/still_parts.hpp"

namespace roadbook {
namespace {

cv::Mat mask_from_file(const std::filesystem::path& file, const cv::Size& half) {
  const auto refuse = [&](const std::string& got) {
    throw BadInput({Severity::kError, file.string(), 0, "mask", got,
                    "a grey PNG image with 0 at the own vehicle and 255 elsewhere"});
  };
  // libpng would print a line of its own about a damaged file.
  const ImageState state = inspect_image(file).state;
  if (state != ImageState::kGood && state != ImageState::kUnknown) refuse(to_text(state));
  cv::Mat mask = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
  if (mask.empty()) refuse("no image that can be read");
  if (cv::countNonZero(mask) == 0) refuse("an image with 0 everywhere");
  cv::resize(mask, mask, half, 0, 0, cv::INTER_NEAREST);
  return mask;
}

// The camera of what Drive::read_image_half gives: an odd row or column is dropped.
MountedCamera camera_of_half_images(const MountedCamera& mounted) {
  MountedCamera half = mounted;
  half.camera = mounted.camera.scaled(0.5);
  half.camera.width = mounted.camera.width / 2;
  half.camera.height = mounted.camera.height / 2;
  return half;
}

std::vector<cv::Mat> images_of(const Drive& drive, std::size_t camera) {
  std::vector<std::size_t> frames;
  for (std::size_t i = 0; i < drive.frame_count(); ++i)
    if (drive.has_image(i, camera)) frames.push_back(i);
  return spread_images(frames.size(),
                       [&](std::size_t i) { return drive.read_image_half(frames[i], camera); });
}

}  // namespace

double OwnCar::masked_share(std::size_t camera) const {
  const cv::Mat& mask = masks.at(camera);
  if (mask.empty()) return 0.0;
  return 1.0 - static_cast<double>(cv::countNonZero(mask)) / static_cast<double>(mask.total());
}

cv::Mat pixels_of_body(const Eigen::AlignedBox3d& body,
                       const Camera& camera,
                       const Eigen::Isometry3d& T_vehicle_camera) {
  cv::Mat pixels = cv::Mat::zeros(camera.height, camera.width, CV_8U);
  const Eigen::Vector3d centre = T_vehicle_camera.translation();
  if (is_above_body(body, centre)) return pixels;
  constexpr double kFarM = 1e3;  // beyond every body
  for (int v = 0; v < pixels.rows; ++v)
    for (int u = 0; u < pixels.cols; ++u) {
      const auto ray = camera.bearing({u, v});
      if (ray &&
          is_hidden_by_body(body, centre, centre + kFarM * (T_vehicle_camera.linear() * *ray)))
        pixels.at<std::uint8_t>(v, u) = 255;
    }
  return pixels;
}

OwnCar find_own_car(const Drive& drive,
                    const std::optional<VehicleMeasures>& given,
                    int num_threads) {
  OwnCar car;
  std::optional<Eigen::AlignedBox3d> body;
  if (const auto& stated = given ? given : drive.vehicle()) {
    body = stated->body();
    if (body) car.vehicle = *stated;
  }
  const auto& cameras = drive.rig().cameras;
  car.masks.resize(cameras.size());
  parallel_for(cameras.size(), num_threads, [&](std::size_t c) {
    const MountedCamera half = camera_of_half_images(cameras[c]);
    if (const auto file = drive.mask_path(c)) {
      car.masks[c] = mask_from_file(*file, {half.camera.width, half.camera.height});
      return;
    }
    cv::Mat seen = find_still_parts(images_of(drive, c), half);
    if (body) {
      const cv::Mat hidden = pixels_of_body(*body, half.camera, half.T_vehicle_camera);
      if (cv::countNonZero(hidden) > 0) seen = seen.empty() ? hidden : cv::Mat(seen | hidden);
    }
    if (!seen.empty()) car.masks[c] = 255 - seen;
  });
  const bool any = std::any_of(car.masks.begin(), car.masks.end(),
                               [](const cv::Mat& mask) { return !mask.empty(); });
  car.source = body ? (given ? VehicleSource::kOption : VehicleSource::kFile)
                    : (any ? VehicleSource::kMeasured : VehicleSource::kNone);
  return car;
}

}  // namespace roadbook
