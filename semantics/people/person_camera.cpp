#include "semantics/people/person_camera.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "base/se3.hpp"

namespace roadbook {
namespace {

constexpr float kNowhere = -1e4F;
constexpr int kOctaves = 4;
constexpr int kLattice = 8;  // spacing of the lattice on which the camera model is evaluated [px]

}  // namespace

double intersection_over_union(const PersonBox& a, const PersonBox& b) {
  if (a.camera != b.camera) return 0.0;
  const auto common = [](double a_low, double a_high, double b_low, double b_high) {
    return std::max(0.0, std::min(a_high, b_high) - std::max(a_low, b_low));
  };
  const double half_a = 0.5 * PersonBox::kBreadth * a.size;
  const double half_b = 0.5 * PersonBox::kBreadth * b.size;
  const double apart = wrap_angle(b.azimuth - a.azimuth);
  const double both =
      common(-half_a, half_a, apart - half_b, apart + half_b) *
      common(a.foot_slope, a.foot_slope + a.size, b.foot_slope, b.foot_slope + b.size);
  const double either = 2.0 * (half_a * a.size + half_b * b.size) - both;
  return either > 0.0 ? both / either : 0.0;
}

PersonBox box_of_person(int camera,
                        const MountedCamera& mounted,
                        const Eigen::Vector3d& foot_vehicle,
                        double height_m) {
  const Eigen::Vector3d d = foot_vehicle - mounted.T_vehicle_camera.translation();
  const double range_m = std::max(d.head<2>().norm(), 1e-3);
  return {camera, std::atan2(d.y(), d.x()), d.z() / range_m, height_m / range_m};
}

ImagePyramid image_pyramid(const cv::Mat& grey) {
  ImagePyramid pyramid{grey};
  for (int i = 1; i < kOctaves && !grey.empty(); ++i) {
    cv::Mat half;
    cv::resize(pyramid.back(), half, {pyramid.back().cols / 2, pyramid.back().rows / 2}, 0, 0,
               cv::INTER_AREA);
    pyramid.push_back(half);
  }
  return pyramid;
}

PersonCamera::PersonCamera(const MountedCamera& mounted, const cv::Mat& mask) : mounted_(mounted) {
  if (!mask.empty())
    cv::resize(mask, mask_, {mounted.camera.width, mounted.camera.height}, 0, 0, cv::INTER_NEAREST);
  const Eigen::Vector3d axis = mounted.T_vehicle_camera.linear().col(2);
  heading_ = std::atan2(axis.y(), axis.x());
}

Eigen::Vector2d PersonCamera::pixel(double azimuth, double slope) const {
  const Eigen::Vector3d ray(std::cos(azimuth), std::sin(azimuth), slope);
  const auto p = mounted_.camera.project(mounted_.T_vehicle_camera.linear().transpose() * ray);
  return p ? *p : Eigen::Vector2d(kNowhere, kNowhere);
}

int PersonCamera::octave_of(double scale) const {
  // The chosen octave is at most 50 % finer than the patch needs.
  const double finer = mounted_.camera.focal_px() / scale;
  return std::clamp(static_cast<int>(std::floor(std::log2(std::max(finer, 1e-3)) + 0.4)), 0,
                    kOctaves - 1);
}

cv::Mat PersonCamera::pixel_map(const CylinderPatch& patch) const {
  // The model is evaluated on a lattice and interpolated linearly. 8 px of a window are about one
  // degree. Over this angle, a fisheye image deviates from linear by less than a tenth of a pixel.
  const int columns = (patch.size.width - 1 + kLattice - 1) / kLattice + 1;
  const int rows = (patch.size.height - 1 + kLattice - 1) / kLattice + 1;
  cv::Mat lattice(rows, columns, CV_32FC2);
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const Eigen::Vector2d p = pixel(patch.left - kLattice * column / patch.scale,
                                      patch.top - kLattice * row / patch.scale);
      lattice.at<cv::Vec2f>(row, column) = {static_cast<float>(p.x()), static_cast<float>(p.y())};
    }
  cv::Mat map(patch.size, CV_32FC2);
  const auto shrink = static_cast<float>(std::exp2(-octave_of(patch.scale)));
  for (int v = 0; v < patch.size.height; ++v)
    for (int u = 0; u < patch.size.width; ++u) {
      const int row = std::min(v / kLattice, std::max(0, rows - 2));
      const int column = std::min(u / kLattice, std::max(0, columns - 2));
      const float b = static_cast<float>(v - kLattice * row) / kLattice;
      const float a = static_cast<float>(u - kLattice * column) / kLattice;
      const int below = std::min(row + 1, rows - 1);
      const int right = std::min(column + 1, columns - 1);
      const auto& p00 = lattice.at<cv::Vec2f>(row, column);
      const auto& p01 = lattice.at<cv::Vec2f>(row, right);
      const auto& p10 = lattice.at<cv::Vec2f>(below, column);
      const auto& p11 = lattice.at<cv::Vec2f>(below, right);
      auto& out = map.at<cv::Vec2f>(v, u);
      if (p00[0] == kNowhere || p01[0] == kNowhere || p10[0] == kNowhere || p11[0] == kNowhere) {
        out = {kNowhere, kNowhere};
        continue;
      }
      const cv::Vec2f p = (1 - b) * ((1 - a) * p00 + a * p01) + b * ((1 - a) * p10 + a * p11);
      // Pixel centres: one pixel of octave o is the mean of 2^o x 2^o pixels.
      out = (p + cv::Vec2f(0.5F, 0.5F)) * shrink - cv::Vec2f(0.5F, 0.5F);
    }
  return map;
}

cv::Mat PersonCamera::seen(const CylinderPatch& patch) const {
  const cv::Mat map = pixel_map(patch);
  const auto grow = static_cast<float>(std::exp2(octave_of(patch.scale)));
  cv::Mat out(patch.size, CV_8U, cv::Scalar(0));
  for (int v = 0; v < map.rows; ++v)
    for (int u = 0; u < map.cols; ++u) {
      const cv::Vec2f p = (map.at<cv::Vec2f>(v, u) + cv::Vec2f(0.5F, 0.5F)) * grow;
      const auto x = static_cast<int>(std::floor(p[0]));
      const auto y = static_cast<int>(std::floor(p[1]));
      if (x < 0 || y < 0 || x >= mounted_.camera.width || y >= mounted_.camera.height) continue;
      if (mask_.empty() || mask_.at<unsigned char>(y, x) != 0) out.at<unsigned char>(v, u) = 255;
    }
  return out;
}

cv::Mat PersonCamera::cut(const ImagePyramid& image, const CylinderPatch& patch) const {
  cv::Mat out;
  cv::remap(image[static_cast<std::size_t>(octave_of(patch.scale))], out, pixel_map(patch),
            cv::Mat(), cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(0));
  return out;
}

bool PersonCamera::sees(double azimuth, double slope) const {
  const Eigen::Vector2d p = pixel(azimuth, slope);
  if (!mounted_.camera.contains(p)) return false;
  return mask_.empty() || mask_.at<unsigned char>(static_cast<int>(std::lround(p.y())),
                                                  static_cast<int>(std::lround(p.x()))) != 0;
}

}  // namespace roadbook
