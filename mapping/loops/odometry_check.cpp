#include "mapping/loops/odometry_check.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace roadbook {
namespace {

constexpr double kLargestChi2 = 11.345;  // 3 degrees of freedom, p = 0.01
constexpr double kTrustedChi2 = 4.642;   // the same, p = 0.2: good enough to judge others by
// Standard deviation of height, roll and pitch over a long way, relative to the discounted one of
// the motions. Heights are wrong by 0.65 m at most after 140 to 190 m in garages; the discounted
// information would allow 2 to 3 m (docs/results/robustness.md).
constexpr double kOutOfPlaneShare = 0.2;

// The way to each keyframe: from its predecessor by the odometry, or over a loop from a keyframe of
// an earlier pass where that is surer. The ways form a tree with the first keyframe as its root.
class Ways {
 public:
  Ways(const std::vector<VoKeyframe>& keyframes,
       const std::vector<LoopEdge>& edges,
       const std::vector<std::uint8_t>& trusted) {
    std::vector<std::vector<const LoopEdge*>> loops_to(keyframes.size());
    for (std::size_t i = 0; i < edges.size(); ++i)
      if (trusted[i] != 0) loops_to[static_cast<std::size_t>(edges[i].to)].push_back(&edges[i]);
    Vector6d share = Vector6d::Ones();
    share.segment<3>(2).setConstant(kOutOfPlaneShare);
    for (std::size_t k = 0; k < keyframes.size(); ++k) {
      Node node = k == 0 ? Node{keyframes[0].T_odom_vehicle} : after(keyframes, k, share);
      for (const LoopEdge* edge : loops_to[k]) {
        const Node over = over_loop(*edge);
        if (out_of_plane(over) < out_of_plane(node)) node = over;
      }
      add(node);
    }
  }

  // Squared Mahalanobis distance of the loop from the way between its keyframes, in height, roll
  // and pitch.
  [[nodiscard]] double out_of_plane_chi2(const LoopEdge& edge) const {
    const auto from = static_cast<std::size_t>(edge.from);
    const auto to = static_cast<std::size_t>(edge.to);
    const Eigen::Isometry3d T_to_root = nodes_[to].T.inverse();
    const Eigen::Isometry3d error =
        edge.T_from_to.inverse() * nodes_[from].T.inverse() * T_to_root.inverse();
    Vector6d r;
    r << error.translation(), so3_log(error.linear());
    const Matrix6d J = se3_adjoint(T_to_root);
    const Matrix6d way =
        nodes_[to].covariance + nodes_[from].covariance - 2.0 * nodes_[common(from, to)].covariance;
    const Matrix6d covariance =
        J * way * J.transpose() + edge.information.ldlt().solve(Matrix6d::Identity());
    const Eigen::Vector3d out = r.segment<3>(2);
    const Eigen::Matrix3d block = covariance.block<3, 3>(2, 2);
    const double chi2 = out.dot(block.ldlt().solve(out));
    return std::isfinite(chi2) ? chi2 : 0.0;
  }

 private:
  struct Node {
    Eigen::Isometry3d T;                     // in the frame of the odometry
    Matrix6d covariance = Matrix6d::Zero();  // of the way from the root, left perturbation
    std::size_t before = 0;                  // where the way comes from
    std::size_t depth = 0;
    std::size_t jump = 0;  // an ancestor farther away
  };

  // Of the pose itself, not of the odometry's origin.
  static double out_of_plane(const Node& node) {
    const Eigen::Matrix<double, 3, 6> J = se3_adjoint(node.T.inverse()).middleRows<3>(2);
    return (J * node.covariance * J.transpose()).trace();
  }

  [[nodiscard]] Node after(const std::vector<VoKeyframe>& keyframes,
                           std::size_t k,
                           const Vector6d& share) const {
    const Node& last = nodes_[k - 1];
    Node node{last.T * keyframes[k - 1].T_odom_vehicle.inverse() * keyframes[k].T_odom_vehicle,
              last.covariance, k - 1};
    if (keyframes[k].after_gap) return node;
    const Matrix6d inverse = keyframes[k].information.ldlt().solve(Matrix6d::Identity());
    const Matrix6d J = se3_adjoint(node.T) * share.asDiagonal();
    node.covariance += J * inverse * J.transpose();
    return node;
  }

  [[nodiscard]] Node over_loop(const LoopEdge& edge) const {
    const auto from = static_cast<std::size_t>(edge.from);
    Node node{nodes_[from].T * edge.T_from_to, nodes_[from].covariance, from};
    const Matrix6d J = se3_adjoint(node.T);
    node.covariance += J * edge.information.ldlt().solve(Matrix6d::Identity()) * J.transpose();
    return node;
  }

  void add(Node node) {
    if (!nodes_.empty()) {
      const Node& before = nodes_[node.before];
      const Node& far = nodes_[before.jump];
      node.depth = before.depth + 1;
      const bool equal = before.depth - far.depth == far.depth - nodes_[far.jump].depth;
      node.jump = equal ? far.jump : node.before;
    }
    nodes_.push_back(node);
  }

  // The last keyframe on the ways to both, in logarithmic time (Myers 1983, jump pointers).
  [[nodiscard]] std::size_t common(std::size_t a, std::size_t b) const {
    if (nodes_[a].depth < nodes_[b].depth) std::swap(a, b);
    const std::size_t depth = nodes_[b].depth;
    while (nodes_[a].depth > depth)
      a = nodes_[nodes_[a].jump].depth >= depth ? nodes_[a].jump : nodes_[a].before;
    while (a != b) {
      const bool far = nodes_[a].jump != nodes_[b].jump;
      a = far ? nodes_[a].jump : nodes_[a].before;
      b = far ? nodes_[b].jump : nodes_[b].before;
    }
    return a;
  }

  std::vector<Node> nodes_;
};

// For each edge the median of its stretch: squared distances from the ways. 0: not judged.
std::vector<double> distances_from(const Ways& ways,
                                   const std::vector<LoopEdge>& edges,
                                   const std::vector<int>& stretch,
                                   const std::vector<std::uint8_t>& is_judged) {
  std::map<int, std::vector<double>> chi2_of_stretch;
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (is_judged[i] != 0) chi2_of_stretch[stretch[i]].push_back(ways.out_of_plane_chi2(edges[i]));
  std::map<int, double> median_of_stretch;
  for (auto& [number, chi2] : chi2_of_stretch) {
    const auto middle = chi2.begin() + static_cast<std::ptrdiff_t>(chi2.size() / 2);
    std::nth_element(chi2.begin(), middle, chi2.end());
    median_of_stretch[number] = *middle;
  }
  std::vector<double> chi2(edges.size(), 0.0);
  for (std::size_t i = 0; i < edges.size(); ++i)
    if (is_judged[i] != 0) chi2[i] = median_of_stretch[stretch[i]];
  return chi2;
}

}  // namespace

std::vector<std::uint8_t> contradict_odometry(const std::vector<VoKeyframe>& keyframes,
                                              const std::vector<LoopEdge>& edges,
                                              const std::vector<int>& stretch) {
  constexpr int kMostRounds = 8;
  if (edges.empty()) return {};
  std::vector<int> gaps_before(keyframes.size(), 0);
  for (std::size_t k = 1; k < keyframes.size(); ++k)
    gaps_before[k] = gaps_before[k - 1] + (keyframes[k].after_gap ? 1 : 0);
  std::vector<std::uint8_t> is_judged;
  for (const LoopEdge& edge : edges)
    is_judged.push_back(gaps_before[static_cast<std::size_t>(edge.from)] ==
                        gaps_before[static_cast<std::size_t>(edge.to)]);
  std::vector<std::uint8_t> trusted(edges.size(), 0);
  std::vector<double> chi2 = distances_from({keyframes, edges, trusted}, edges, stretch, is_judged);
  for (int round = 0; round < kMostRounds; ++round) {
    const auto trusted_before = trusted;
    for (std::size_t i = 0; i < edges.size(); ++i)
      trusted[i] = is_judged[i] != 0 && chi2[i] <= kTrustedChi2;
    if (trusted == trusted_before || *std::max_element(chi2.begin(), chi2.end()) <= kLargestChi2)
      break;
    const auto now = distances_from({keyframes, edges, trusted}, edges, stretch, is_judged);
    for (std::size_t i = 0; i < edges.size(); ++i) chi2[i] = std::min(chi2[i], now[i]);
  }
  std::vector<std::uint8_t> contradicts;
  for (const double one : chi2) contradicts.push_back(one > kLargestChi2 ? 1 : 0);
  return contradicts;
}

}  // namespace roadbook
