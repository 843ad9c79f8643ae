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

// The problem of views, linearised at a point, with poses and landmarks projected out exactly. Each
// right-hand side s (the residual or a column) is solved once with the factor of bundle adjustment,
// x = H^-1 J^T s, and becomes s - J x.

/// What a row measures.
struct ViewRow {
  std::size_t channel = 0;  ///< index, see ViewChannels
  int pose = 0;
  int observation = -1;  ///< index of the observation if the row is a view; else -1
};

/// Channels of the rows: one a camera, then the six axes of the motions, then the ground.
struct ViewChannels {
  std::size_t cameras = 0;
  [[nodiscard]] std::size_t motion(std::size_t axis) const { return cameras + axis; }
  [[nodiscard]] std::size_t ground() const { return cameras + 6; }
  [[nodiscard]] std::size_t size() const { return cameras + 7; }
};

using ViewPanel = BlockCholesky::Panel;

/// A row in draws with random signs: plus or minus `size`, by one bit of `signs` a draw.
struct ViewDraw {
  double size = 0.0;
  std::uint64_t signs = 0;
};

/// Right-hand sides with the solutions for poses and landmarks.
struct ViewSides {
  ViewPanel poses;   ///< solution x of each free pose
  ViewPanel points;  ///< solution x of each landmark
  /// Weights of elementary columns (rows) for each side after the residual (columns). Empty: every
  /// elementary column is a side.
  Eigen::MatrixXd sums;
  /// For each elementary column the sums that contain it, with their weights.
  std::vector<std::vector<std::pair<Eigen::Index, double>>> used;
  /// Number of further sides with one random sign a row.
  std::size_t probes = 0;
  std::vector<ViewDraw> draws;  ///< one a row, if there are draws
  Eigen::Index count = 0;
};

class ViewSystem {
 public:
  /// `data` and `basis` must outlive this object. `num_threads`: 0 for all cores; results do not
  /// depend on it.
  ViewSystem(const ViewData& data, const ViewBasis& basis, int num_threads = 1);

  /// Linearises and factors the problem at `point`. Returns false if it is singular. `sums`: if
  /// given, only columns with a weight in it are computed.
  bool linearise(const ViewPoint& point,
                 const ViewNoise& noise,
                 const Eigen::MatrixXd* sums = nullptr);

  /// Squared residual at the point of linearisation. A view that cannot be projected there costs
  /// `invalid_cost`, as in bundle adjustment.
  [[nodiscard]] double squares() const;
  /// Refits poses and landmarks to the effects of `point` by bundle adjustment
  /// (Levenberg-Marquardt), for points from which a Gauss-Newton step is too long. Returns false
  /// and leaves the point unchanged if it does not converge.
  bool adjust(ViewPoint& point, const ViewNoise& noise);

  /// Refits each landmark to the poses and effects of `point`, at the noise of the last
  /// linearisation: a full step may throw landmarks with little parallax far away. Returns the
  /// squared residual; corrections by effects stay those at the old landmarks. Source: Jeong et al.
  /// 2010 (embedded point iterations).
  double settle_points(ViewPoint& point);

  /// The residual and all elementary columns as sides.
  [[nodiscard]] ViewSides all_sides() const;
  /// The residual, the sums of columns, and `probes` sides of random signs.
  [[nodiscard]] ViewSides sides(const Eigen::MatrixXd& sums, std::size_t probes = 0) const;
  /// The residual and `count` (at most 64) draws of each row; `draws` in the order of the rows.
  [[nodiscard]] ViewSides drawn_sides(std::vector<ViewDraw> draws, int count) const;

  [[nodiscard]] std::size_t poses() const { return rows_of_pose_.size(); }
  [[nodiscard]] std::size_t row_count() const { return row_count_; }
  /// Writes the projected rows of a pose: its views, the motion that ends there and its ground
  /// points; one column a side. `raw`: rows before projection (probes: their signs).
  void rows(std::size_t pose, const ViewSides& sides, ViewPanel& values, bool raw = false) const;
  /// Calls `body` for each pose in order with its projected rows. Several threads compute the rows.
  void each_pose(const ViewSides& sides,
                 const std::function<void(std::size_t pose, const ViewPanel& values)>& body) const;
  [[nodiscard]] int num_threads() const { return options_.num_threads; }
  /// Index of the first row of a pose among all rows.
  [[nodiscard]] std::size_t first_row(std::size_t pose) const { return first_row_[pose]; }
  [[nodiscard]] const std::vector<ViewRow>& row_info(std::size_t pose) const {
    return rows_of_pose_[pose];
  }

  /// Moves poses and landmarks of `point` by the solution for the residual less `size` times the
  /// columns (one value a side after the residual).
  void move(ViewPoint& point, const ViewSides& sides, const Eigen::VectorXd& size) const;

 private:
  struct Term {
    TermResidual e;
    int point = 0;
    std::size_t strip = 0;  ///< offset in strips_
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
  std::vector<int> observation_of_term_;  ///< -1 for a ground point
  BundleLayout layout_;
  std::unique_ptr<BundleSystem> system_;
  std::vector<Term> terms_;
  std::vector<Motion> motions_;
  std::vector<double> strips_;
  std::vector<std::vector<std::size_t>> terms_of_pose_;
  std::vector<std::vector<std::size_t>> motions_of_pose_;
  std::vector<std::vector<ViewRow>> rows_of_pose_;
  std::vector<std::size_t> first_row_;
  std::vector<std::size_t> row_of_term_;  ///< index of the first row of each term
  std::vector<std::size_t> row_of_motion_;
  std::size_t row_count_ = 0;
};

}  // namespace roadbook
