#include "mapping/calibration/calibration_problem.hpp"

#include <ceres/crs_matrix.h>

#include <algorithm>
#include <map>

#include "base/index.hpp"
#include "mapping/optimisation/ceres_solve.hpp"

namespace roadbook {
namespace {

constexpr double kMotionLossWidth = 5.28;  // as in bundle adjustment
constexpr double kTolerance = 1e-4;

// (value / sigma) for each column of a block.
template <int kSize>
class ColumnPrior : public ceres::SizedCostFunction<kSize, kSize> {
 public:
  explicit ColumnPrior(const std::array<double, kSize>& sigmas) : sigmas_(sigmas) {}
  bool Evaluate(const double* const* parameters,
                double* residuals,
                double** jacobians) const override {
    for (std::size_t i = 0; i < sigmas_.size(); ++i) residuals[i] = parameters[0][i] / sigmas_[i];
    if (jacobians == nullptr || jacobians[0] == nullptr) return true;
    std::fill_n(jacobians[0], kSize * kSize, 0.0);
    for (std::size_t i = 0; i < sigmas_.size(); ++i) jacobians[0][i * kSize + i] = 1.0 / sigmas_[i];
    return true;
  }

 private:
  std::array<double, kSize> sigmas_;
};

template <int kSize>
ceres::CostFunction* prior_of(const std::vector<CalibrationColumn>& columns, std::size_t first) {
  std::array<double, kSize> sigmas{};
  for (std::size_t i = 0; i < sigmas.size(); ++i) sigmas[i] = prior_sigma(columns[first + i].kind);
  return new ColumnPrior<kSize>(sigmas);
}

}  // namespace

CalibrationProblem::CalibrationProblem(const CalibrationData& data,
                                       const Eigen::VectorXd& values,
                                       const std::vector<std::uint8_t>& held,
                                       double pixel_loss_width,
                                       double ground_sigma_m)
    : data_(data),
      cameras_(data.rig.cameras.size()),
      points_(data.points),
      held_(held),
      pixel_loss_(pixel_loss_width),
      motion_loss_(kMotionLossWidth),
      problem_(ceres_problem_options()) {
  Eigen::Index next = 0;
  for (CameraBlock& camera : cameras_)
    for (double& value : camera) value = values[next++];
  if (data.has_wheels())
    for (double& value : wheels_) value = values[next++];
  poses_.reserve(data.poses.size());
  for (const CalibrationPose& pose : data.poses) poses_.push_back(block_of(pose.T_map_vehicle));
  add_blocks(data, held);
  add_residuals(data, ground_sigma_m);
}

void CalibrationProblem::add_blocks(const CalibrationData& data,
                                    const std::vector<std::uint8_t>& held) {
  const auto add = [&](double* block, int size, std::size_t first) {
    std::vector<int> constant;
    for (int i = 0; i < size; ++i)
      if (held[first + at(i)] != 0) constant.push_back(i);
    problem_.AddParameterBlock(block, size);
    if (static_cast<int>(constant.size()) == size) {
      problem_.SetParameterBlockConstant(block);
    } else if (!constant.empty()) {
      manifolds_.push_back(std::make_unique<ceres::SubsetManifold>(size, constant));
      problem_.SetManifold(block, manifolds_.back().get());
    }
  };
  for (std::size_t c = 0; c < cameras_.size(); ++c)
    add(cameras_[c].data(), kColumnsOfCamera, c * kColumnsOfCamera);
  if (data.has_wheels()) add(wheels_.data(), kColumnsOfWheels, cameras_.size() * kColumnsOfCamera);
  for (std::size_t k = 0; k < poses_.size(); ++k) {
    problem_.AddParameterBlock(poses_[k].data(), 7, &pose_manifold_);
    if (data.poses[k].fixed) problem_.SetParameterBlockConstant(poses_[k].data());
  }
  for (Eigen::Vector3d& point : points_) problem_.AddParameterBlock(point.data(), 3);
}

void CalibrationProblem::add_residual(ceres::CostFunction* cost,
                                      ceres::LossFunction* loss,
                                      const std::vector<double*>& blocks,
                                      int cluster) {
  residual_blocks_.push_back(problem_.AddResidualBlock(cost, loss, blocks));
  cluster_of_block_.push_back(cluster);
}

void CalibrationProblem::add_residuals(const CalibrationData& data, double ground_sigma_m) {
  // All views of the points that a camera sees first in one stretch are one cluster; so are the
  // heights of the ground in a stretch, and the motions of the wheels there.
  std::map<std::pair<int, int>, int> numbers;
  const auto cluster_of = [&](int stretch, int kind) {
    const auto [found, is_new] = numbers.try_emplace({stretch, kind}, clusters_);
    clusters_ += is_new ? 1 : 0;
    return found->second;
  };
  constexpr int kGround = -1;
  constexpr int kWheels = -2;
  int point = -1;
  int cluster = 0;
  for (const BundleObservation& view : data.views) {
    if (view.point != point) cluster = cluster_of(data.poses[at(view.pose)].stretch, view.camera);
    point = view.point;
    add_residual(
        new PixelCost(data.rig.cameras[at(view.camera)], data.poses[at(view.pose)].twist, view),
        &pixel_loss_,
        {poses_[at(view.pose)].data(), points_[at(view.point)].data(),
         cameras_[at(view.camera)].data()},
        cluster);
  }
  for (const CalibrationGround& ground : data.grounds)
    add_residual(new GroundCost(ground_sigma_m), &pixel_loss_,
                 {poses_[at(ground.pose)].data(), points_[at(ground.point)].data()},
                 cluster_of(data.poses[at(ground.pose)].stretch, kGround));
  for (const CalibrationMotion& motion : data.motions)
    add_residual(
        new WheelCost(motion, data.poses[at(motion.from)].t_ns, data.poses[at(motion.to)].t_ns),
        &motion_loss_,
        {poses_[at(motion.from)].data(), poses_[at(motion.to)].data(), wheels_.data()},
        cluster_of(data.poses[at(motion.to)].stretch, kWheels));
  const auto columns = calibration_columns(data.rig, data.has_wheels());
  for (std::size_t c = 0; c < cameras_.size(); ++c)
    add_residual(prior_of<kColumnsOfCamera>(columns, c * kColumnsOfCamera), nullptr,
                 {cameras_[c].data()}, -1);
  if (data.has_wheels())
    add_residual(prior_of<kColumnsOfWheels>(columns, cameras_.size() * kColumnsOfCamera), nullptr,
                 {wheels_.data()}, -1);
}

bool CalibrationProblem::solve(int max_iterations, const std::function<void(int)>& on_iteration) {
  constexpr double kFirstTrustRegionRadius = 1e10;  // nearly Gauss-Newton
  // Not SPARSE_SCHUR: with Eigen's Cholesky it would keep the order of the blocks, and every pose
  // depends on the columns.
  const ceres::Solver::Options options =
      ceres_solver_options(ceres::SPARSE_NORMAL_CHOLESKY, max_iterations, kFirstTrustRegionRadius);
  const CeresOutcome outcome = solve_by_ceres(options, kTolerance, on_iteration, problem_);
  return outcome.iterations > 0 && values().allFinite();
}

Eigen::VectorXd CalibrationProblem::values() const {
  const std::size_t wheels = data_.has_wheels() ? kColumnsOfWheels : 0;
  Eigen::VectorXd values(index(cameras_.size() * kColumnsOfCamera + wheels));
  Eigen::Index next = 0;
  for (const CameraBlock& camera : cameras_)
    for (const double value : camera) values[next++] = value;
  for (std::size_t i = 0; i < wheels; ++i) values[next++] = wheels_[i];
  return values;
}

void CalibrationProblem::write_to(CalibrationData& data) const {
  for (std::size_t k = 0; k < poses_.size(); ++k)
    data.poses[k].T_map_vehicle = pose_of(poses_[k].data());
  data.points = points_;
}

CalibrationProblem::Linear CalibrationProblem::linear() {
  ceres::Problem::EvaluateOptions options;
  std::vector<Eigen::Index> column_of;  // of each derivative of the first blocks
  const auto add_columns = [&](double* block, int size, std::size_t first) {
    if (problem_.IsParameterBlockConstant(block)) return;
    options.parameter_blocks.push_back(block);
    for (std::size_t i = first; i < first + at(size); ++i)
      if (held_[i] == 0) column_of.push_back(index(i));
  };
  for (std::size_t c = 0; c < cameras_.size(); ++c)
    add_columns(cameras_[c].data(), kColumnsOfCamera, c * kColumnsOfCamera);
  if (data_.has_wheels())
    add_columns(wheels_.data(), kColumnsOfWheels, cameras_.size() * kColumnsOfCamera);
  for (PoseBlock& pose : poses_)
    if (!problem_.IsParameterBlockConstant(pose.data()))
      options.parameter_blocks.push_back(pose.data());
  for (Eigen::Vector3d& point : points_) options.parameter_blocks.push_back(point.data());
  options.residual_blocks = residual_blocks_;
  options.num_threads = 1;
  double cost = 0.0;
  std::vector<double> residuals;
  ceres::CRSMatrix jacobian;
  problem_.Evaluate(options, &cost, &residuals, nullptr, &jacobian);

  Linear linear;
  linear.residuals = Eigen::Map<const Eigen::VectorXd>(residuals.data(), index(residuals.size()));
  linear.columns = Eigen::MatrixXd::Zero(jacobian.num_rows, index(held_.size()));
  const int front = static_cast<int>(column_of.size());
  std::vector<Eigen::Triplet<double>> others;
  others.reserve(jacobian.values.size());
  for (int row = 0; row < jacobian.num_rows; ++row)
    for (int i = jacobian.rows[at(row)]; i < jacobian.rows[at(row) + 1]; ++i) {
      const int column = jacobian.cols[at(i)];
      const double value = jacobian.values[at(i)];
      if (column < front)
        linear.columns(row, column_of[at(column)]) = value;
      else
        others.emplace_back(row, column - front, value);
    }
  linear.others.resize(jacobian.num_rows, jacobian.num_cols - front);
  linear.others.setFromTriplets(others.begin(), others.end());
  for (std::size_t b = 0; b < residual_blocks_.size(); ++b) {
    const ceres::CostFunction* of_block =
        problem_.GetCostFunctionForResidualBlock(residual_blocks_[b]);
    linear.clusters.insert(linear.clusters.end(), at(of_block->num_residuals()),
                           cluster_of_block_[b]);
  }
  linear.cluster_count = clusters_;
  return linear;
}

}  // namespace roadbook
