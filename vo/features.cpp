#include "vo/features.hpp"

#include <algorithm>
#include <cstring>
#include <opencv2/features2d.hpp>
#include <string>
#include <tuple>

#include "base/error.hpp"
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

std::vector<cv::KeyPoint> spread_evenly(std::vector<cv::KeyPoint> found,
                                        const cv::Mat& image,
                                        const cv::Mat& mask,
                                        const FeatureOptions& options) {
  std::sort(found.begin(), found.end(), stronger);
  const int columns = image.cols / options.cell_px + 1;
  const int rows = image.rows / options.cell_px + 1;
  std::vector<int> taken(static_cast<std::size_t>(columns * rows));
  std::vector<cv::KeyPoint> kept;
  for (const auto& k : found) {
    if (!allowed(k, image, mask, static_cast<float>(options.border_px))) continue;
    int& count = taken[static_cast<std::size_t>(cvFloor(k.pt.y) / options.cell_px * columns +
                                                cvFloor(k.pt.x) / options.cell_px)];
    if (count >= options.max_per_cell) continue;
    ++count;
    kept.push_back(k);
    if (static_cast<int>(kept.size()) == options.max_features) break;
  }
  return kept;
}

// Size that BRISK's own detector gives a corner of its finest scale.
constexpr float kBriskSizePx = 12.0F;

// Making a BRISK object costs 50 ms and 47 MB of pattern tables, so it is made once; describing
// only reads them. Its detector is not used: it computes the direction of every raw corner before
// the strongest are chosen, and describing computes it again (20 times the time for the same
// corners).
cv::BRISK& describer() {
  static const cv::Ptr<cv::BRISK> brisk = cv::BRISK::create(30, 0);
  return *brisk;
}

}  // namespace

void FeatureOptions::check() const {
  if (max_features < 1) throw InvalidOption("max_features", std::to_string(max_features), ">= 1");
  if (cell_px < 8) throw InvalidOption("cell_px", std::to_string(cell_px), ">= 8");
  if (low_threshold < 1 || low_threshold > threshold)
    throw InvalidOption("low_threshold", std::to_string(low_threshold), "1 to threshold");
}

Features detect_features(const cv::Mat& half_image,
                         const cv::Mat& mask,
                         const FeatureOptions& options) {
  ROADBOOK_ASSERT(half_image.type() == CV_8UC1);
  std::vector<cv::KeyPoint> kept;
  for (const int threshold : {options.threshold, options.low_threshold}) {
    kept = spread_evenly(find_corners(half_image, threshold), half_image, mask, options);
    if (static_cast<int>(kept.size()) > options.max_features / 3) break;
  }
  for (auto& k : kept) {
    k.pt = refine_corner(half_image, k.pt);
    k.size = kBriskSizePx;
  }
  cv::Mat described;
  describer().compute(half_image, kept, described);
  Features features;
  features.pixels.reserve(kept.size());
  features.descriptors.resize(kept.size());
  for (std::size_t i = 0; i < kept.size(); ++i) {
    features.pixels.emplace_back(kept[i].pt.x, kept[i].pt.y);
    std::memcpy(features.descriptors[i].data(), described.ptr(static_cast<int>(i)),
                sizeof(Descriptor));
  }
  return features;
}

}  // namespace roadbook
