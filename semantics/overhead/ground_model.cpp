#include "semantics/overhead/ground_model.hpp"

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "base/error.hpp"

namespace roadbook {
namespace {

using Cell = std::pair<int, int>;  // (row, column) of a grid node

std::int64_t key_of(int column, int row) {
  return (static_cast<std::int64_t>(row) << 32) ^ static_cast<std::uint32_t>(column);
}

void require_positive(const char* field, double value) {
  if (!(value > 0.0) || !std::isfinite(value))
    throw InvalidOption(field, std::to_string(value), "a finite number > 0");
}

// Bilinear weights of the four nodes around a point.
struct Corner {
  int column = 0;
  int row = 0;
  double weight = 0.0;
};

std::array<Corner, 4> corners_of(double x, double y, double spacing_m) {
  const double fx = x / spacing_m;
  const double fy = y / spacing_m;
  const int column = static_cast<int>(std::floor(fx));
  const int row = static_cast<int>(std::floor(fy));
  const double a = fx - column;
  const double b = fy - row;
  return {{{column, row, (1 - a) * (1 - b)},
           {column + 1, row, a * (1 - b)},
           {column, row + 1, (1 - a) * b},
           {column + 1, row + 1, a * b}}};
}

// Nodes within reach, ordered by row and column, so that the unknowns do not depend on hashing.
std::map<Cell, int> active_nodes(const std::vector<Eigen::Vector2d>& around,
                                 const GroundModelOptions& options) {
  std::map<Cell, int> nodes;
  std::map<Cell, bool> seen;  // poses in the same cell reach the same nodes
  const int reach = static_cast<int>(std::ceil(options.reach_m / options.spacing_m)) + 1;
  for (const Eigen::Vector2d& p : around) {
    const int column = static_cast<int>(std::lround(p.x() / options.spacing_m));
    const int row = static_cast<int>(std::lround(p.y() / options.spacing_m));
    if (!seen.emplace(Cell{row, column}, true).second) continue;
    for (int dr = -reach; dr <= reach; ++dr)
      for (int dc = -reach; dc <= reach; ++dc)
        if (dr * dr + dc * dc <= reach * reach) nodes.emplace(Cell{row + dr, column + dc}, 0);
  }
  int index = 0;
  for (auto& [cell, i] : nodes) i = index++;
  return nodes;
}

// Normal equations of a linear least-squares problem. Each row has few unknowns.
class NormalEquations {
 public:
  explicit NormalEquations(int size) : b_(Eigen::VectorXd::Zero(size)) {}

  void add(const std::vector<std::pair<int, double>>& row, double value, double weight) {
    for (const auto& [i, a] : row) {
      b_[i] += weight * a * value;
      for (const auto& [j, c] : row) entries_.emplace_back(i, j, weight * a * c);
    }
  }
  [[nodiscard]] Eigen::VectorXd solve() const {
    Eigen::SparseMatrix<double> A(b_.size(), b_.size());
    A.setFromTriplets(entries_.begin(), entries_.end());
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> ldlt(A);
    ROADBOOK_ASSERT(ldlt.info() == Eigen::Success);
    return ldlt.solve(b_);
  }

 private:
  std::vector<Eigen::Triplet<double>> entries_;
  Eigen::VectorXd b_;
};

// Penalises second differences of neighbouring heights, in both directions and mixed. A very weak
// coupling of neighbours determines the heights that bending alone leaves free.
void add_bending(const std::map<Cell, int>& nodes,
                 const GroundModelOptions& options,
                 NormalEquations* equations) {
  const double sigma = options.sigma_bend_rad * options.spacing_m;
  const double bend = 1.0 / (sigma * sigma);
  const double pull = 1e-6 * bend;
  const auto find = [&](int row, int column) {
    const auto it = nodes.find({row, column});
    return it == nodes.end() ? -1 : it->second;
  };
  for (const auto& [cell, i] : nodes) {
    const auto [row, column] = cell;
    const int left = find(row, column - 1);
    const int right = find(row, column + 1);
    const int below = find(row - 1, column);
    const int above = find(row + 1, column);
    const int diagonal = find(row + 1, column + 1);
    if (left >= 0 && right >= 0) equations->add({{left, 1}, {i, -2}, {right, 1}}, 0, bend);
    if (below >= 0 && above >= 0) equations->add({{below, 1}, {i, -2}, {above, 1}}, 0, bend);
    if (right >= 0 && above >= 0 && diagonal >= 0)
      equations->add({{i, 1}, {right, -1}, {above, -1}, {diagonal, 1}}, 0, 2 * bend);
    if (right >= 0) equations->add({{i, 1}, {right, -1}}, 0, pull);
    if (above >= 0) equations->add({{i, 1}, {above, -1}}, 0, pull);
  }
}

struct Evidence {
  std::vector<std::pair<int, double>> row;
  double z = 0.0;
  double sigma = 0.0;
};

std::vector<Evidence> evidence_on(const std::map<Cell, int>& nodes,
                                  const std::vector<GroundPoint>& points,
                                  const GroundModelOptions& options) {
  std::vector<Evidence> evidence;
  for (const GroundPoint& point : points) {
    Evidence e{{}, point.p_map.z(), point.sigma_m};
    for (const Corner& c : corners_of(point.p_map.x(), point.p_map.y(), options.spacing_m)) {
      const auto it = nodes.find({c.row, c.column});
      if (it != nodes.end()) e.row.emplace_back(it->second, c.weight);
    }
    if (e.row.size() == 4) evidence.push_back(std::move(e));
  }
  return evidence;
}

}  // namespace

void GroundModelOptions::check() const {
  require_positive("ground.spacing_m", spacing_m);
  require_positive("ground.reach_m", reach_m);
  require_positive("ground.sigma_bend_rad", sigma_bend_rad);
  require_positive("ground.sigma_wheel_m", sigma_wheel_m);
  require_positive("ground.sigma_landmark_m", sigma_landmark_m);
  require_positive("ground.wheelbase_m", wheelbase_m);
  require_positive("ground.track_width_m", track_width_m);
}

GroundModel GroundModel::plane(double z0_m, const Eigen::Vector2d& slope) {
  GroundModel model;
  model.z0_m_ = z0_m;
  model.slope_ = slope;
  return model;
}

GroundModel GroundModel::fit(const std::vector<GroundPoint>& points,
                             const std::vector<Eigen::Vector2d>& around,
                             const GroundModelOptions& options) {
  options.check();
  GroundModel model;
  model.spacing_m_ = options.spacing_m;
  const std::map<Cell, int> nodes = active_nodes(around, options);
  const std::vector<Evidence> evidence = evidence_on(nodes, points, options);
  if (nodes.empty() || evidence.empty()) return model;

  const int size = static_cast<int>(nodes.size());
  NormalEquations bending(size);
  add_bending(nodes, options, &bending);
  Eigen::VectorXd h = Eigen::VectorXd::Zero(size);
  constexpr int kIterations = 5;  // Cauchy weights converge within a few rounds
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    NormalEquations equations = bending;
    for (const Evidence& e : evidence) {
      double predicted = 0.0;
      for (const auto& [i, a] : e.row) predicted += a * h[i];
      // The first round uses all points with full weight. Later rounds reduce the weight of points
      // that lie several sigma away.
      const double r = iteration == 0 ? 0.0 : (e.z - predicted) / (3.0 * e.sigma);
      equations.add(e.row, e.z, 1.0 / (e.sigma * e.sigma * (1.0 + r * r)));
    }
    h = equations.solve();
  }
  for (const auto& [cell, i] : nodes) model.nodes_.emplace(key_of(cell.second, cell.first), h[i]);
  return model;
}

std::optional<double> GroundModel::height(double x, double y) const {
  if (spacing_m_ == 0.0) return z0_m_ + slope_.x() * x + slope_.y() * y;
  double z = 0.0;
  for (const Corner& c : corners_of(x, y, spacing_m_)) {
    const auto it = nodes_.find(key_of(c.column, c.row));
    if (it == nodes_.end()) return std::nullopt;
    z += c.weight * it->second;
  }
  return z;
}

std::vector<GroundPoint> ground_points(const Map& map, const GroundModelOptions& options) {
  std::vector<GroundPoint> points;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Session& session = map.sessions[static_cast<std::size_t>(map.keyframes[k].session)];
    const double wheelbase = session.wheels ? session.wheels->wheelbase_m : options.wheelbase_m;
    const double half_track =
        0.5 * (session.wheels ? session.wheels->track_width_m : options.track_width_m);
    const Eigen::Isometry3d T_map_vehicle = map.T_map_vehicle(static_cast<int>(k));
    for (const double x : {0.0, wheelbase})
      for (const double y : {-half_track, half_track})
        points.push_back({T_map_vehicle * Eigen::Vector3d(x, y, 0.0), options.sigma_wheel_m});
  }
  for (const Landmark& landmark : map.landmarks) {
    if (!landmark.ground || !is_known(landmark.covariance)) continue;
    // Conservative: the trace is an upper bound of the height's variance in any frame.
    const double variance = std::max(0.0, landmark.covariance.trace());
    points.push_back(
        {map.p_map(landmark), std::hypot(options.sigma_landmark_m, std::sqrt(variance))});
  }
  return points;
}

GroundModel estimate_ground(const Map& map, const GroundModelOptions& options) {
  std::vector<Eigen::Vector2d> around;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k)
    around.emplace_back(map.T_map_vehicle(static_cast<int>(k)).translation().head<2>());
  return GroundModel::fit(ground_points(map, options), around, options);
}

}  // namespace roadbook
