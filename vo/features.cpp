#include "vo/features.hpp"

#include <algorithm>
#include <opencv2/core/types.hpp>
#include <string>
#include <tuple>
#include <utility>

#include "base/error.hpp"
#include "vo/brisk_description.hpp"
#include "vo/corners.hpp"

namespace roadbook {
namespace {

// Strongest first; ties are broken by place, so that the order never depends on the detector's.
bool stronger(const cv::KeyPoint& a, const cv::KeyPoint& b) {
  return std::tuple(-a.response, a.pt.y, a.pt.x) < std::tuple(-b.response, b.pt.y, b.pt.x);
}

bool allowed(const cv::KeyPoint& k, const cv::Mat& image, const cv::Mat& mask, float border) {
  const auto width = static_cast<float>(image.cols);
  const auto height = static_cast<float>(image.rows);
  if (k.pt.x < border || k.pt.y < border || k.pt.x > width - 1 - border ||
      k.pt.y > height - 1 - border)
    return false;
  return mask.empty() || mask.at<std::uint8_t>(cvRound(k.pt.y), cvRound(k.pt.x)) != 0;
}

// `found`: strongest first.
std::vector<cv::KeyPoint> spread_evenly(const std::vector<cv::KeyPoint>& found,
                                        const cv::Mat& image,
                                        int per_cell,
                                        const FeatureOptions& options) {
  const int columns = image.cols / options.cell_px + 1;
  const int rows = image.rows / options.cell_px + 1;
  std::vector<int> taken(static_cast<std::size_t>(columns * rows));
  std::vector<cv::KeyPoint> kept;
  for (const auto& k : found) {
    int& count = taken[static_cast<std::size_t>(cvFloor(k.pt.y) / options.cell_px * columns +
                                                cvFloor(k.pt.x) / options.cell_px)];
    if (count >= per_cell) continue;
    ++count;
    kept.push_back(k);
    if (static_cast<int>(kept.size()) == options.max_features) break;
  }
  return kept;
}

// Corners where features may lie, strongest first.
std::vector<cv::KeyPoint> corners_of(const cv::Mat& image,
                                     const cv::Mat& mask,
                                     int threshold,
                                     const FeatureOptions& options) {
  std::vector<cv::KeyPoint> found = find_corners(image, threshold);
  std::erase_if(found, [&](const cv::KeyPoint& k) {
    return !allowed(k, image, mask, static_cast<float>(options.border_px));
  });
  std::sort(found.begin(), found.end(), stronger);
  return found;
}

// Those that stay corners when they are described.
std::size_t describable(const cv::Mat& image, const std::vector<cv::KeyPoint>& corners) {
  const auto border = description_border_px();
  return static_cast<std::size_t>(
      std::count_if(corners.begin(), corners.end(),
                    [&](const cv::KeyPoint& k) { return allowed(k, image, {}, border); }));
}

// Corners of small images and of plain ones crowd in few cells: cells give more than `max_per_cell`
// until the image has its fewest.
std::vector<cv::KeyPoint> filled_up(std::vector<cv::KeyPoint> kept,
                                    const std::vector<cv::KeyPoint>& found,
                                    const cv::Mat& image,
                                    const FeatureOptions& options) {
  const auto most = std::min(found.size(), static_cast<std::size_t>(options.max_features));
  const auto fewest = static_cast<std::size_t>(options.fewest);
  for (int per_cell = options.max_per_cell + 1;
       kept.size() < most && describable(image, kept) < fewest; ++per_cell)
    kept = spread_evenly(found, image, per_cell, options);
  return kept;
}

}  // namespace

void FeatureOptions::check() const {
  if (max_features < 1) throw InvalidOption("max_features", std::to_string(max_features), ">= 1");
  if (fewest < 0 || fewest > max_features)
    throw InvalidOption("fewest", std::to_string(fewest), "0 to max_features");
  if (max_per_cell < 1) throw InvalidOption("max_per_cell", std::to_string(max_per_cell), ">= 1");
  if (cell_px < 8) throw InvalidOption("cell_px", std::to_string(cell_px), ">= 8");
  if (low_threshold < 1 || low_threshold > threshold)
    throw InvalidOption("low_threshold", std::to_string(low_threshold), "1 to threshold");
}

Features detect_features(const cv::Mat& half_image,
                         const cv::Mat& mask,
                         const FeatureOptions& options) {
  ROADBOOK_ASSERT(half_image.type() == CV_8UC1);
  options.check();
  std::vector<cv::KeyPoint> found;
  std::vector<cv::KeyPoint> kept;
  for (const int threshold : {options.threshold, options.low_threshold}) {
    found = corners_of(half_image, mask, threshold, options);
    kept = spread_evenly(found, half_image, options.max_per_cell, options);
    if (static_cast<int>(kept.size()) > options.max_features / 3) break;
  }
  kept = filled_up(std::move(kept), found, half_image, options);
  std::vector<cv::Point2f> corners;
  corners.reserve(kept.size());
  for (const cv::KeyPoint& k : kept) corners.push_back(refine_corner(half_image, k.pt));
  DescribedCorners described = describe_corners(half_image, corners);
  Features features;
  features.pixels.reserve(described.corners.size());
  for (const int i : described.corners) {
    const cv::Point2f& corner = corners[static_cast<std::size_t>(i)];
    features.pixels.emplace_back(corner.x, corner.y);
  }
  features.descriptors = std::move(described.descriptors);
  return features;
}

}  // namespace roadbook
