#include "speedmap/fields/label_field.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/geometry/outline.hpp"

namespace roadbook {
namespace {

constexpr double kMostBuckets = 1 << 20;

LabelAt signed_distance(const LabelledOutline& label, const Eigen::Vector2d& p) {
  double nearest = INFINITY;
  Eigen::Vector2d away = Eigen::Vector2d::Zero();
  Eigen::Vector2d edge = Eigen::Vector2d::Zero();
  double area = 0.0;
  bool inside = false;
  const auto& corners = label.corners;
  for (std::size_t i = 0, j = corners.size() - 1; i < corners.size(); j = i++) {
    const Eigen::Vector2d a = corners[j];
    const Eigen::Vector2d b = corners[i];
    const Eigen::Vector2d ab = b - a;
    const Eigen::Vector2d ap = p - a;
    area += a.x() * b.y() - a.y() * b.x();
    const double length = ab.squaredNorm();
    const double t = length > 0.0 ? std::clamp(ap.dot(ab) / length, 0.0, 1.0) : 0.0;
    const Eigen::Vector2d from = ap - t * ab;
    if (from.squaredNorm() < nearest) {
      nearest = from.squaredNorm();
      away = from;
      edge = ab;
    }
    if (ray_crosses(p, a, b)) inside = !inside;
  }
  const double distance = std::sqrt(nearest);
  LabelAt at{&label, inside ? -distance : distance, Eigen::Vector2d::Zero()};
  if (distance > 1e-9)
    at.gradient = away / at.distance_m;
  else  // on the outline: its normal
    at.gradient = Eigen::Vector2d(edge.y(), -edge.x()).normalized() * (area < 0.0 ? -1.0 : 1.0);
  return at;
}

}  // namespace

LabelField::LabelField(std::vector<LabelledOutline> labels, double reach_m)
    : labels_(std::move(labels)), reach_m_(reach_m) {
  if (!(reach_m > 0.0 && reach_m <= 1e4))
    throw InvalidOption("reach_m", std::to_string(reach_m), "above 0, to 1e4");
  std::erase_if(labels_, [](const LabelledOutline& label) { return label.corners.size() < 3; });
  if (labels_.empty()) return;
  for (const LabelledOutline& label : labels_) {
    Box box{label.corners.front(), label.corners.front()};
    for (const Eigen::Vector2d& corner : label.corners) {
      if (!corner.allFinite())
        throw InvalidOption("corners", "a number that is not finite", "metres in the map frame");
      box.low = box.low.cwiseMin(corner);
      box.high = box.high.cwiseMax(corner);
    }
    boxes_.push_back({box.low.array() - reach_m, box.high.array() + reach_m});
  }
  low_ = boxes_.front().low;
  Eigen::Vector2d high = boxes_.front().high;
  for (const Box& box : boxes_) {
    low_ = low_.cwiseMin(box.low);
    high = high.cwiseMax(box.high);
  }
  const Eigen::Vector2d size = high - low_;
  bucket_m_ = std::max(reach_m, std::sqrt(size.prod() / kMostBuckets));
  columns_ = 1 + static_cast<int>(size.x() / bucket_m_);
  rows_ = 1 + static_cast<int>(size.y() / bucket_m_);
  buckets_.resize(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_));
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const Eigen::Vector2i from = ((boxes_[i].low - low_) / bucket_m_).cast<int>();
    const Eigen::Vector2i to = ((boxes_[i].high - low_) / bucket_m_).cast<int>();
    for (int r = from.y(); r <= to.y(); ++r)
      for (int c = from.x(); c <= to.x(); ++c)
        buckets_[static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) +
                 static_cast<std::size_t>(c)]
            .push_back(static_cast<std::uint32_t>(i));
  }
}

void LabelField::at(const Eigen::Vector2d& p, std::vector<LabelAt>& found) const {
  found.clear();
  const Eigen::Vector2d q = (p - low_) / bucket_m_;
  if (!(q.x() >= 0.0 && q.y() >= 0.0 && q.x() < columns_ && q.y() < rows_)) return;
  for (const std::uint32_t i :
       buckets_[static_cast<std::size_t>(q.y()) * static_cast<std::size_t>(columns_) +
                static_cast<std::size_t>(q.x())]) {
    if ((p.array() < boxes_[i].low.array()).any() || (p.array() > boxes_[i].high.array()).any())
      continue;
    const LabelAt at = signed_distance(labels_[i], p);
    if (at.distance_m <= reach_m_) found.push_back(at);
  }
  // Labels are few: insertion, in the order of the labels where distances are equal.
  for (std::size_t i = 1; i < found.size(); ++i)
    for (std::size_t k = i; k > 0 && found[k].distance_m < found[k - 1].distance_m; --k)
      std::swap(found[k], found[k - 1]);
}

}  // namespace roadbook
