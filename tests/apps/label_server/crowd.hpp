#pragma once

#include <opencv2/imgproc.hpp>

#include "drive/writer.hpp"
#include "semantics/labels/labels.hpp"
#include "tests/apps/label_server/lot.hpp"

namespace roadbook::test {

/// A person in an image of the lot's recording.
struct Somebody {
  LabelAnchor image;
  PersonBox box;
  Eigen::Vector2d foot = Eigen::Vector2d::Zero();  ///< [px]
  Eigen::Vector2d head = Eigen::Vector2d::Zero();
};

constexpr int kInstants = 7;  // too few to tell the own car from the rest
constexpr std::int64_t kCrowdBegin = 1'400'000'000'000'000'000;

inline std::int64_t crowd_stamp(int instant) {
  return kCrowdBegin + instant * std::int64_t{500'000'000};
}

/// Pixel of a point of a person. `aside`: to the left, as a share of the height; `up`: 0 at the
/// feet, 1 at the crown.
inline Eigen::Vector2d pixel_on(const MountedCamera& mounted,
                                const PersonBox& box,
                                double aside,
                                double up) {
  const double azimuth = box.azimuth + aside * box.size;
  const Eigen::Vector3d ray(std::cos(azimuth), std::sin(azimuth), box.foot_slope + up * box.size);
  return *mounted.camera.project(mounted.T_vehicle_camera.linear().transpose() * ray);
}

/// Two people in most images of every camera, three to seven metres away.
inline std::vector<Somebody> crowd() {
  const Rig rig = fisheye_rig();
  std::vector<Somebody> people;
  for (int instant = 0; instant < kInstants; ++instant)
    for (int c = 0; c < static_cast<int>(rig.cameras.size()); ++c) {
      Random random(7, "crowd", static_cast<std::uint64_t>(instant * 10 + c));
      const MountedCamera& mounted = rig.cameras[static_cast<std::size_t>(c)];
      const Eigen::Vector3d axis = mounted.T_vehicle_camera.linear().col(2);
      const double ahead = std::atan2(axis.y(), axis.x());
      for (const double side : {-1.0, 1.0}) {
        if ((instant + c) % 4 == 3) continue;
        const double range_m = random.uniform(3.0, 7.0);
        const double azimuth = ahead + side * random.uniform(0.2, 0.8);
        const Eigen::Vector3d eye = mounted.T_vehicle_camera.translation();
        const PersonBox box = box_of_person(
            c, mounted,
            {eye.x() + range_m * std::cos(azimuth), eye.y() + range_m * std::sin(azimuth), 0.0},
            1.74);
        people.push_back({{0, crowd_stamp(instant), c},
                          box,
                          pixel_on(mounted, box, 0.0, 0.0),
                          pixel_on(mounted, box, 0.0, 1.0)});
      }
    }
  return people;
}

/// A head, a trunk and two legs, along the image's local vertical.
inline void paint_somebody(const MountedCamera& mounted, const PersonBox& box, cv::Mat* image) {
  const auto part = [&](double left, double right, double low, double high) {
    std::vector<cv::Point> ring;
    for (int i = 0; i < 24; ++i) {
      const double angle = 2.0 * 3.14159265358979 * i / 24;
      const Eigen::Vector2d p =
          pixel_on(mounted, box, 0.5 * (left + right) + 0.5 * (left - right) * std::cos(angle),
                   0.5 * (low + high) + 0.5 * (high - low) * std::sin(angle));
      ring.emplace_back(cv::Point(cvRound(16 * p.x()), cvRound(16 * p.y())));
    }
    cv::fillPoly(*image, std::vector{ring}, cv::Scalar(225), cv::LINE_AA, 4);
  };
  part(0.06, -0.06, 0.86, 1.0);
  part(0.13, -0.13, 0.42, 0.9);
  part(0.12, 0.01, 0.0, 0.5);
  part(-0.01, -0.12, 0.0, 0.5);
}

/// Soft noise with slanting bars; none of them is a person.
inline cv::Mat crowd_background(int width, int height, std::uint64_t seed) {
  Random random(seed, "crowd background");
  cv::Mat image(height, width, CV_8U);
  for (int row = 0; row < height; ++row)
    for (int column = 0; column < width; ++column)
      image.at<std::uint8_t>(row, column) = static_cast<std::uint8_t>(70 + random.below(60));
  for (int bar = 0; bar < 14; ++bar) {
    const cv::Point from(static_cast<int>(random.below(static_cast<std::uint64_t>(width))),
                         static_cast<int>(random.below(static_cast<std::uint64_t>(height))));
    const cv::Point to = from + cv::Point(static_cast<int>(random.below(160)) - 80,
                                          static_cast<int>(random.below(60)) - 30);
    cv::line(image, from, to, cv::Scalar(210), 9, cv::LINE_AA);
  }
  cv::GaussianBlur(image, image, {5, 5}, 0.0);
  return image;
}

/// The recording of the lot with its people, in a folder that is not there yet.
inline void write_crowd_drive(const std::filesystem::path& folder) {
  const Rig rig = fisheye_rig();
  DriveWriter writer(folder, rig, std::nullopt);
  const auto people = crowd();
  for (int instant = 0; instant < kInstants; ++instant)
    for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
      const MountedCamera& mounted = rig.cameras[c];
      cv::Mat image = crowd_background(
          mounted.camera.width, mounted.camera.height,
          static_cast<std::uint64_t>(instant) * 10 + static_cast<std::uint64_t>(c));
      for (const Somebody& one : people)
        if (one.image.t_ns == crowd_stamp(instant) && one.image.camera == static_cast<int>(c))
          paint_somebody(mounted, one.box, &image);
      cv::GaussianBlur(image, image, {3, 3}, 0.0);
      writer.write_image(c, crowd_stamp(instant), image);
    }
  writer.finish();
}

/// A small lot with or without an overhead image, and its recording.
inline void write_crowd(const std::filesystem::path& map, bool with_picture = true) {
  Lot lot;
  lot.drive = map.parent_path() / "drive";
  write_crowd_drive(lot.drive);
  if (with_picture)
    write_lot(map, lot);
  else
    MapFileBuilder(map, "lot").finish(lot_map(lot), {});
}

}  // namespace roadbook::test
