#include "semantics/labels/keyframe_index.hpp"

#include <algorithm>
#include <opencv2/flann.hpp>
#include <utility>

namespace roadbook {
namespace {

using SquaredDistance = cvflann::L2_Simple<double>;

// The tree compares strictly and with a radius in single precision; the exact test below decides.
constexpr double kRelativeMargin = 1e-6;
constexpr double kMarginM = 1e-6;
constexpr int kLeafSize = 10;

cv::Mat positions_of(const Map& map) {
  cv::Mat positions(static_cast<int>(map.keyframes.size()), 2, CV_64F);
  for (int k = 0; k < positions.rows; ++k) {
    const Eigen::Vector3d p = map.T_map_vehicle(k).translation();
    positions.at<double>(k, 0) = p.x();
    positions.at<double>(k, 1) = p.y();
  }
  return positions;
}

}  // namespace

struct KeyframeIndex::Tree {
  explicit Tree(cv::Mat p)
      : positions(std::move(p)), index(positions, cvflann::KDTreeSingleIndexParams(kLeafSize)) {}

  cv::Mat positions;  ///< a row [x, y] for each keyframe; the index reads them
  cv::flann::GenericIndex<SquaredDistance> index;
};

KeyframeIndex::KeyframeIndex(const Map& map)
    : map_(&map),
      tree_(map.keyframes.empty() ? nullptr : std::make_unique<Tree>(positions_of(map))) {}

KeyframeIndex::~KeyframeIndex() = default;

std::vector<std::size_t> KeyframeIndex::within(const Eigen::Vector2d& place,
                                               double radius_m) const {
  if (!tree_) return {};
  const std::vector<double> query{place.x(), place.y()};
  const double reach = radius_m * (1.0 + kRelativeMargin) + kMarginM;
  std::vector<int> hits(map_->keyframes.size());
  std::vector<double> squared(hits.size());
  const int count = tree_->index.radiusSearch(query, hits, squared, reach * reach,
                                              cvflann::SearchParams(-1, 0.0F, false));
  std::vector<std::size_t> near;
  for (int i = 0; i < count; ++i) {
    const auto k = static_cast<std::size_t>(hits[static_cast<std::size_t>(i)]);
    const double* p = tree_->positions.ptr<double>(static_cast<int>(k));
    if ((Eigen::Vector2d(p[0], p[1]) - place).norm() <= radius_m) near.push_back(k);
  }
  std::sort(near.begin(), near.end());
  return near;
}

}  // namespace roadbook
