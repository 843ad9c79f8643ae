#include "semantics/overhead/ground_image.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace roadbook {
namespace {

// Affine map from the pixels of a patch to the pixels of the image.
cv::Matx23d patch_to_image(const GroundImage& image,
                           const Eigen::Vector2d& centre,
                           double heading,
                           double pixel_m,
                           cv::Size size) {
  const double scale = pixel_m / image.resolution_m;
  const double c = scale * std::cos(heading);
  const double s = scale * std::sin(heading);
  const Eigen::Vector2d at = image.pixel_of(centre);
  const double u = 0.5 * (size.width - 1);
  const double v = 0.5 * (size.height - 1);
  // Along: (cos, -sin) in columns and rows; to the right: (sin, cos).
  return {c, s, at.x() - c * u - s * v, -s, c, at.y() + s * u - c * v};
}

}  // namespace

GroundImage coarser(const GroundImage& image, double resolution_m) {
  const double factor = std::max(1.0, resolution_m / image.resolution_m);
  GroundImage out;
  out.corner = image.corner;
  cv::Mat filled = image.grey.clone();
  const cv::Scalar mean = cv::mean(image.grey, image.seen);
  filled.setTo(mean, image.seen == 0);
  const cv::Size size(std::max(1, static_cast<int>(std::floor(image.grey.cols / factor))),
                      std::max(1, static_cast<int>(std::floor(image.grey.rows / factor))));
  out.resolution_m = image.resolution_m * factor;
  // Only whole pixels of the coarse image. The remainder at the right and at the bottom is cut off.
  const cv::Rect used(
      0, 0, std::min(image.grey.cols, static_cast<int>(std::lround(size.width * factor))),
      std::min(image.grey.rows, static_cast<int>(std::lround(size.height * factor))));
  cv::resize(filled(used), out.grey, size, 0, 0, cv::INTER_AREA);
  cv::Mat seen;
  cv::resize(image.seen(used), seen, size, 0, 0, cv::INTER_AREA);
  out.seen = seen > 127;
  return out;
}

cv::Mat upright_patch(const GroundImage& image,
                      const Eigen::Vector2d& centre,
                      double heading,
                      double pixel_m,
                      cv::Size size) {
  cv::Mat patch;
  cv::warpAffine(image.grey, patch, patch_to_image(image, centre, heading, pixel_m, size), size,
                 cv::INTER_LINEAR | cv::WARP_INVERSE_MAP, cv::BORDER_CONSTANT, cv::Scalar(128));
  return patch;
}

double seen_share(const GroundImage& image, const OrientedBox& box) {
  constexpr int kSteps = 8;
  int seen = 0;
  const Eigen::Vector2d along(std::cos(box.heading), std::sin(box.heading));
  const Eigen::Vector2d left(-along.y(), along.x());
  // In pixels. The added half pixel turns truncation into rounding.
  const Eigen::Vector2d middle =
      image.pixel_of(box.centre + Eigen::Vector2d(0.5, -0.5) * image.resolution_m);
  const Eigen::Vector2d ahead =
      box.length_m / image.resolution_m * Eigen::Vector2d(along.x(), -along.y());
  const Eigen::Vector2d beside =
      box.width_m / image.resolution_m * Eigen::Vector2d(left.x(), -left.y());
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double a = (i + 0.5) / kSteps - 0.5;
      const double b = (j + 0.5) / kSteps - 0.5;
      const double x = middle.x() + a * ahead.x() + b * beside.x();
      const double y = middle.y() + a * ahead.y() + b * beside.y();
      if (x >= 0.0 && y >= 0.0 && x < image.seen.cols && y < image.seen.rows)
        seen += image.seen.at<unsigned char>(static_cast<int>(y), static_cast<int>(x)) != 0 ? 1 : 0;
    }
  return static_cast<double>(seen) / (kSteps * kSteps);
}

}  // namespace roadbook
