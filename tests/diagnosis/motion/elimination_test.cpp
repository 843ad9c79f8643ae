#include "diagnosis/motion/elimination.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "base/random.hpp"
#include "diagnosis/motion/motion_model.hpp"
#include "diagnosis/streams/motion_prediction.hpp"
#include "diagnosis/streams/observe.hpp"
#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"

namespace roadbook {
namespace {

// A chain of random knot steps, walks and readings, with the same rows kept densely on the side.
class DenseJudge {
 public:
  static constexpr std::size_t kSides = 3;
  static constexpr int kKnots = 6;

  DenseJudge() : elimination_(kSides, true) {
    for (int j = 0; j < kKnots; ++j) {
      if (j > 0) advance();
      for (int k = 0; k < 6; ++k) reading();
      walk();
      for (int k = 0; k < 4; ++k) reading();
    }
  }

  // Dense least squares: squared residual of side 0 and of its products with side 1.
  [[nodiscard]] Eigen::MatrixXd left_over() const {
    Eigen::MatrixXd A(static_cast<Eigen::Index>(rows_.size()), unknowns_);
    Eigen::MatrixXd b(A.rows(), static_cast<Eigen::Index>(kSides));
    for (Eigen::Index i = 0; i < A.rows(); ++i) {
      Eigen::VectorXd row = Eigen::VectorXd::Zero(unknowns_);
      const Eigen::VectorXd& stored = rows_[static_cast<std::size_t>(i)];
      row.head(stored.size()) = stored;
      A.row(i) = row.transpose();
      b.row(i) = sides_[static_cast<std::size_t>(i)].transpose();
    }
    const Eigen::MatrixXd x = A.colPivHouseholderQr().solve(b);
    return (b - A * x).transpose() * (b - A * x);
  }
  [[nodiscard]] const Eigen::MatrixXd& innovations() const { return products_; }

 private:
  // Unknowns are numbered as they appear. slot_[i] states how the current slot i depends on them.
  Eigen::VectorXd fresh() {
    slot_width_ = ++unknowns_;
    return Eigen::VectorXd::Unit(unknowns_, unknowns_ - 1);
  }
  static Eigen::VectorXd sum(const Eigen::VectorXd& a, double factor, const Eigen::VectorXd& b) {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(std::max(a.size(), b.size()));
    all.head(a.size()) = a;
    all.head(b.size()) += factor * b;
    return all;
  }
  Eigen::VectorXd random_sides() {
    return Eigen::Vector3d(random_.normal(), random_.normal(), random_.normal());
  }
  void add(const Eigen::VectorXd& row, const Eigen::VectorXd& sides) {
    rows_.push_back(row);
    sides_.push_back(sides);
  }

  void reading() {
    std::vector<double> row(elimination_.stride(), 0.0);
    Eigen::VectorXd dense = Eigen::VectorXd::Zero(1);
    for (std::size_t i = 0; i < kSlots; ++i) {
      row[i] = random_.normal();
      dense = sum(dense, row[i], slots_[i]);
    }
    const Eigen::VectorXd sides = random_sides();
    for (std::size_t k = 0; k < kSides; ++k) row[kSlots + k] = sides[static_cast<Eigen::Index>(k)];
    add(dense, sides);
    if (elimination_.measure(row.data()) == 0.0) return;
    const Eigen::Map<const Eigen::VectorXd> e(row.data() + kSlots, kSides);
    products_ += e * e.transpose();
  }

  void walk() {
    WheelStep step;
    for (auto* rolls : {&step.drift, &step.turn_drift})
      for (double& r : *rolls) r = random_.normal();
    step.drift_sigma = 0.7;
    step.turn_sigma = 1.3;
    const std::array<Eigen::VectorXd, 2> sides{random_sides(), random_sides()};
    elimination_.walk(step, sides[0].data(), sides[1].data());
    for (std::size_t i = 0; i < 2; ++i) {
      const auto& rolls = i == 0 ? step.drift : step.turn_drift;
      const Eigen::VectorXd now = fresh();
      Eigen::VectorXd row = sum(now, -1.0, slots_[i]);
      for (std::size_t k = 0; k < 4; ++k) row = sum(row, -rolls[k], slots_[kSpeedA + k]);
      add(row / (i == 0 ? step.drift_sigma : step.turn_sigma), sides[i]);
      slots_[i] = now;
    }
  }

  void advance() {
    KnotStep s;
    for (auto* values : {&s.drift, &s.turn_drift, &s.x, &s.y})
      for (double& v : *values) v = random_.normal();
    s.x_by_heading = random_.normal();
    s.y_by_heading = random_.normal();
    s.half_step_s = 0.3;
    s.sideways = {0.6, 0.8};
    s.creep_sigma = 0.5;
    s.speed_sigma = 0.8;
    s.yaw_sigma = 1.1;
    elimination_.advance(s);
    const Eigen::VectorXd creep = fresh(), speed = fresh(), yaw = fresh();
    const Eigen::VectorXd nothing = Eigen::Vector3d::Zero();
    add(creep / s.creep_sigma, nothing);
    add(sum(sum(slots_[kSpeedA], -2.0, slots_[kSpeedB]), 1.0, speed) / s.speed_sigma, nothing);
    add(sum(sum(slots_[kYawA], -2.0, slots_[kYawB]), 1.0, yaw) / s.yaw_sigma, nothing);
    auto next = slots_;
    for (std::size_t k = 0; k < 4; ++k) {
      next[kDrift] = sum(next[kDrift], s.drift[k], slots_[kSpeedA + k]);
      next[kTurnDrift] = sum(next[kTurnDrift], s.turn_drift[k], slots_[kSpeedA + k]);
      next[kX] = sum(next[kX], s.x[k], slots_[kSpeedA + k]);
      next[kY] = sum(next[kY], s.y[k], slots_[kSpeedA + k]);
    }
    next[kX] = sum(sum(next[kX], s.x_by_heading, slots_[kHeading]), s.sideways[0], creep);
    next[kY] = sum(sum(next[kY], s.y_by_heading, slots_[kHeading]), s.sideways[1], creep);
    next[kHeading] =
        sum(sum(slots_[kHeading], s.half_step_s, slots_[kYawA]), s.half_step_s, slots_[kYawB]);
    next[kSpeedA] = slots_[kSpeedB];
    next[kYawA] = slots_[kYawB];
    next[kSpeedB] = speed;
    next[kYawB] = yaw;
    slots_ = next;
  }

  Random random_{7};
  Eigen::Index unknowns_ = 0;
  Eigen::Index slot_width_ = 0;
  std::array<Eigen::VectorXd, kSlots> slots_ = first_slots();
  std::vector<Eigen::VectorXd> rows_, sides_;
  Eigen::MatrixXd products_ = Eigen::MatrixXd::Zero(kSides, kSides);
  Elimination elimination_;

  std::array<Eigen::VectorXd, kSlots> first_slots() {
    std::array<Eigen::VectorXd, kSlots> slots;
    for (auto& s : slots) s = fresh();
    return slots;
  }
};

TEST(Elimination, LeavesWhatDenseLeastSquaresLeavesOfEverySide) {
  const DenseJudge judge;
  const Eigen::MatrixXd dense = judge.left_over();
  EXPECT_LT((judge.innovations() - dense).cwiseAbs().maxCoeff(), 1e-9 * dense.norm());
}

// The back substitution of a pass gives the trajectory whose residuals are orthogonal to every
// change. A second pass from there changes nothing.
TEST(Elimination, TheSolutionIsWhereTheNextPassStaysPut) {
  test::HiddenDriveOptions options;
  options.length_m = 40.0;
  Observations obs = observe(test::streams_of(test::record_drive(options)));
  MotionModel model = nominal_model(obs);
  Columns none;
  for (int i = 0; i < 4; ++i) fit_model(obs, model, 1);
  renew_residual(obs, model);
  const Pass pass = run_pass(obs, model.point, model.noise, none, {true, 0, &model.inflation});
  for (const auto& knot : pass.elimination.back_substitute({1.0}).knots) {
    EXPECT_LT(std::abs(knot[kX]), 1e-5);
    EXPECT_LT(std::abs(knot[kY]), 1e-5);
    EXPECT_LT(std::abs(knot[kHeading]), 1e-6);
  }
}

}  // namespace
}  // namespace roadbook
