#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "diagnosis/views/view_prediction.hpp"
#include "mapping/optimisation/bundle_adjustment_system.hpp"

namespace roadbook {

// The problem of views linearised at a point, with poses and landmarks projected out exactly: each
// side (residual or column) goes once through the factor of bundle adjustment, x = H^-1 J^T s, and
// leaves s - J x.

/// What a row reads.
struct ViewRow {
  std::size_t channel = 0;  ///< see ViewChannels
  int pose = 0;
  int observation = -1;  ///< of a view
};

/// Channels: one a camera, then the six of the motions, then the ground.
struct ViewChannels {
  std::size_t cameras = 0;
  [[nodiscard]] std::size_t motion(std::size_t axis) const { return cameras + axis; }
  [[nodiscard]] std::size_t ground() const { return cameras + 6; }
  [[nodiscard]] std::size_t size() const { return cameras + 7; }
};

using ViewPanel = BlockCholesky::Panel;

/// What a row reads in draws of random signs: plus or minus `size`, by one bit a draw.
struct ViewDraw {
  double size = 0.0;
  std::uint64_t signs = 0;
};

/// Sides with what poses and landmarks take of them.
struct ViewSides {
  ViewPanel poses;   ///< x of each free pose
  ViewPanel points;  ///< x of each landmark
  /// Sides after the residual as sums of elementary columns (columns of this); empty: every
  /// elementary column is a side.
  Eigen::MatrixXd sums;
  /// Of each elementary column the sums that it is part of, with its weight: few.
  std::vector<std::vector<std::pair<Eigen::Index, double>>> used;
  /// Further sides of random signs, one a row and probe.
  std::size_t probes = 0;
  std::vector<ViewDraw> draws;  ///< of each row, where there are probes
  Eigen::Index count = 0;
};

class ViewSystem {
 public:
  /// `data` and `basis` are kept by reference. `num_threads`: 0: all cores; results are the same
  /// for any number.
  ViewSystem(const ViewData& data, const ViewBasis& basis, int num_threads = 1);

  /// Linearises and factors; false where the problem is singular. `sums`: only the columns in these
  /// will be asked for.
  bool linearise(const ViewPoint& point,
                 const ViewNoise& noise,
                 const Eigen::MatrixXd* sums = nullptr);

  /// Of the residual where it was linearised. What a camera cannot see there costs as much as in
  /// bundle adjustment (`invalid_cost`).
  [[nodiscard]] double squares() const;
  /// Poses and landmarks that suit the point's effects, by bundle adjustment (Levenberg-Marquardt):
  /// for points from which a whole Gauss-Newton step goes too far. False, and the point as it was,
  /// where that does not converge.
  bool adjust(ViewPoint& point, const ViewNoise& noise);

  /// Landmarks that suit the point's poses and effects, each for itself, at the noise of the last
  /// linearisation: a whole step of poses and landmarks may take those with little parallax far
  /// away (embedded point iterations: Jeong et al., Pushing the envelope of modern methods for
  /// bundle adjustment, CVPR 2010). Squares of the residual there, what effects take off readings
  /// still being that of where the landmarks were.
  double settle_points(ViewPoint& point);

  /// Residual and all elementary columns.
  [[nodiscard]] ViewSides all_sides() const;
  /// Residual and sums of columns, and `probes` random ones.
  [[nodiscard]] ViewSides sides(const Eigen::MatrixXd& sums, std::size_t probes = 0) const;
  /// Residual and `count` (64 at most) draws of each row, poses in order.
  [[nodiscard]] ViewSides drawn_sides(std::vector<ViewDraw> draws, int count) const;

  [[nodiscard]] std::size_t poses() const { return rows_of_pose_.size(); }
  [[nodiscard]] std::size_t row_count() const { return row_count_; }
  /// Rows of a pose's views, of the motion that ends there and of its ground points, sides side by
  /// side and projected; `raw`: as they are (probes: of random signs).
  void rows(std::size_t pose, const ViewSides& sides, ViewPanel& values, bool raw = false) const;
  /// Calls `body` for pose after pose with its projected rows, which several threads make.
  void each_pose(const ViewSides& sides,
                 const std::function<void(std::size_t pose, const ViewPanel& values)>& body) const;
  [[nodiscard]] int num_threads() const { return options_.num_threads; }
  /// Number of a pose's first row among all.
  [[nodiscard]] std::size_t first_row(std::size_t pose) const { return first_row_[pose]; }
  [[nodiscard]] const std::vector<ViewRow>& row_info(std::size_t pose) const {
    return rows_of_pose_[pose];
  }

  /// Moves the point's poses and landmarks by what they take of the residual less `size` of the
  /// columns (one a side after the residual).
  void move(ViewPoint& point, const ViewSides& sides, const Eigen::VectorXd& size) const;

 private:
  struct Term {
    TermResidual e;
    int point = 0;
    std::size_t strip = 0;  ///< in strips_
  };
  struct Motion {
    Vector6d r;
    Matrix6d J_from;
    Matrix6d J_to;
    ViewPrediction::MotionStrip strip;
  };
  struct PointFit {
    Eigen::Vector3d p_map;
    double squares = 0.0;
    Eigen::Matrix3d V = Eigen::Matrix3d::Zero();
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
  };
  void set_noise(const ViewNoise& noise);
  void refresh_layout();
  void lay_out_strips();
  void linearise_terms(const ViewPoint& point, const std::vector<std::uint8_t>& needed);
  void ground_strip(const ViewPoint& point, std::size_t term);
  void linearise_motions(const ViewPoint& point);
  void list_rows();
  [[nodiscard]] PointFit point_fit(std::size_t p,
                                   const BundleState& state,
                                   const Eigen::Vector3d& p_map) const;
  [[nodiscard]] PointFit settled_point(std::size_t p, const BundleState& state) const;
  [[nodiscard]] Eigen::Index rows_of_term(std::size_t term) const {
    return observation_of_term_[term] >= 0 ? 2 : 1;
  }
  void raw_term(std::size_t term,
                const ViewSides& sides,
                ViewPanel& values,
                Eigen::Index row) const;
  void raw_motion(std::size_t motion,
                  const ViewSides& sides,
                  ViewPanel& values,
                  Eigen::Index row) const;
  void raw(std::size_t pose, const ViewSides& sides, ViewPanel& values) const;
  void project(ViewSides& sides) const;
  void sum_to_poses(ViewSides& sides) const;
  void sum_to_points(ViewSides& sides) const;

  const ViewData& data_;
  const ViewBasis& basis_;
  ViewPrediction prediction_;
  BundleOptions options_;
  BundleProblem problem_;
  std::vector<int> observation_of_term_;  ///< -1: ground
  BundleLayout layout_;
  std::unique_ptr<BundleSystem> system_;
  std::vector<Term> terms_;
  std::vector<Motion> motions_;
  std::vector<double> strips_;
  std::vector<std::vector<std::size_t>> terms_of_pose_;
  std::vector<std::vector<std::size_t>> motions_of_pose_;
  std::vector<std::vector<ViewRow>> rows_of_pose_;
  std::vector<std::size_t> first_row_;
  std::vector<std::size_t> row_of_term_;  ///< first one among all
  std::vector<std::size_t> row_of_motion_;
  std::size_t row_count_ = 0;
};

}  // namespace roadbook
