#include "diagnosis/views/hinge_lines.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <cmath>

namespace roadbook::test {
namespace {

Accepted hinge_at(const HingeLine& line, double size) {
  Accepted hinge;
  hinge.candidate.kind = CandidateKind::kPlace;
  set_line(line, hinge.candidate);
  hinge.size = Eigen::VectorXd::Constant(1, size);
  return hinge;
}

// One camera and one hinge whose line does not pass through the map's origin.
struct OneHinge {
  explicit OneHinge(double size) {
    basis.cameras = 1;
    basis.hinges = 1;
    model.accepted.push_back(hinge_at(
        {{std::cos(2.5), std::sin(2.5)}, -7.0, {-7.0 * std::cos(2.5), -7.0 * std::sin(2.5)}},
        size));
    point.linear = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(basis.size()));
    point.linear[static_cast<Eigen::Index>(basis.hinge())] = size;
  }
  ViewBasis basis;
  CauseModel model;
  ViewPoint point;
};

TEST(HingeLines, ACandidateKeepsItsLine) {
  for (const double angle : {-3.0, -1.0, 0.2, 1.5, 2.9})
    for (const double offset : {-40.0, 0.0, 13.0}) {
      const Eigen::Vector2d normal(std::cos(angle), std::sin(angle));
      const Eigen::Vector2d pivot =
          offset * normal + 9.0 * Eigen::Vector2d(-normal.y(), normal.x());
      const HingeLine line{normal, offset, pivot};
      Candidate hinge;
      set_line(line, hinge);
      const HingeLine back = line_of(hinge);
      for (const Eigen::Vector2d& p : {Eigen::Vector2d(3.0, 4.0), {-70.0, 20.0}})
        EXPECT_NEAR(back.distance(p), line.distance(p), 1e-9);
      EXPECT_EQ(back.pivot, pivot);
    }
}

TEST(HingeLines, ALineTurnsAboutAPlaceAndShiftsAlongItsNormal) {
  const HingeLine line{{0.6, 0.8}, 5.0, {3.0, 4.0}};
  const Eigen::Vector2d place(20.0, -4.0);
  const HingeLine moved = line.moved(0.1, 0.3, place);
  EXPECT_NEAR(moved.distance(place), line.distance(place) - 0.3, 1e-12);
  EXPECT_NEAR(std::atan2(moved.normal.y(), moved.normal.x()), std::atan2(0.8, 0.6) + 0.1, 1e-12);
  EXPECT_NEAR(moved.distance(moved.pivot), 0.0, 1e-12);
  EXPECT_NEAR(line.moved(0.1, 0.0).distance(line.pivot), 0.0, 1e-12);
}

TEST(HingeLines, OnlyAHingeWithASizeHasALineToMove) {
  const OneHinge some(0.03);
  const Eigen::MatrixXd sums = line_columns(some.basis, some.model, some.point);
  ASSERT_EQ(sums.cols(), 2);
  EXPECT_EQ(sums.sum(), 2.0 * 0.03);
  EXPECT_EQ(sums(static_cast<Eigen::Index>(some.basis.hinge() + 1), 0), 0.03);
  EXPECT_EQ(sums(static_cast<Eigen::Index>(some.basis.hinge() + 2), 1), 0.03);
  const OneHinge none(0.0);
  EXPECT_EQ(line_columns(none.basis, none.model, none.point).cols(), 0);
}

TEST(HingeLines, AStepThatIsTooLongIsCutWithItsDirectionKept) {
  const OneHinge hinge(0.03);
  const HingeLine before = line_of(hinge.model.accepted[0].candidate);
  const auto moved_by = [&](const Eigen::Vector2d& step, bool whole) {
    CauseModel model = hinge.model;
    EXPECT_EQ(move_lines(step, hinge.basis, hinge.point, model), whole);
    const HingeLine after = line_of(model.accepted[0].candidate);
    const double turn = std::atan2(after.normal.y(), after.normal.x()) - 2.5;
    return Eigen::Vector2d(turn, -after.distance(before.pivot));
  };
  EXPECT_LT((moved_by({0.02, -0.1}, true) - Eigen::Vector2d(0.02, -0.1)).norm(), 1e-9);
  const Eigen::Vector2d cut = moved_by({1.0, 2.0}, false);
  EXPECT_GT(cut[0], 0.0);
  EXPECT_LT(cut[0], 0.5);
  EXPECT_NEAR(cut[1] / cut[0], 2.0, 1e-6);
}

// The variance of the sizes includes the uncertainty of the lines.
TEST(HingeLines, SizesAreNoBetterKnownThanTheirLines) {
  Eigen::Matrix3d root;
  root << 3.0, 0.4, 0.2, 0.0, 2.0, -0.7, 0.0, 0.0, 5.0;
  const Eigen::Matrix3d information = 100.0 * root.transpose() * root;
  Eigen::Matrix3d held = information;
  held.diagonal().tail<2>() += line_precision(2);
  EXPECT_NEAR(1.0 / marginal_information(information, 1)(0, 0), held.inverse()(0, 0), 1e-12);
  EXPECT_LT(marginal_information(information, 1)(0, 0), information(0, 0));
  EXPECT_EQ(marginal_information(information, 3), information);
}

// With lines projected out, scores equal those of a regression with nearly free lines.
TEST(HingeLines, SidesWithoutWhatLinesExplainAreThoseOfARegressionWithThem) {
  Eigen::MatrixXd rows = 1e3 * Eigen::MatrixXd::Random(40, 5);
  Innovations innovations;
  innovations.sides = 5;
  innovations.of.resize(40);
  for (Eigen::Index i = 0; i < 40; ++i)
    for (Eigen::Index k = 0; k < 5; ++k) innovations.values.push_back(rows(i, k));
  project_out_lines(innovations, 2);
  ASSERT_EQ(innovations.sides, 3U);
  ASSERT_EQ(innovations.values.size(), 120U);
  const Eigen::MatrixXd L = rows.rightCols(2);
  const Eigen::MatrixXd left =
      rows.leftCols(3) - L * L.colPivHouseholderQr().solve(rows.leftCols(3).eval());
  for (std::size_t i = 0; i < 40; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(innovations.row(i)[k],
                  left(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(k)), 1e-2);
}

TEST(HingeLines, WhatOthersSayHoldsSizesAndNotLines) {
  const OneHinge hinge(0.03);
  SizePrior others;
  others.information = Eigen::MatrixXd::Constant(1, 1, 400.0);
  others.weighted = Eigen::VectorXd::Constant(1, 400.0 * 0.05);
  const ViewPrior pull = prior_with_lines(others, hinge.model, 2);
  EXPECT_NEAR(pull.score[0], 400.0 * 0.02, 1e-12);
  EXPECT_EQ(pull.score.tail(2).norm(), 0.0);
  EXPECT_EQ(pull.information(0, 0), 400.0);
  EXPECT_GT(pull.information(1, 1), 0.0);
  EXPECT_EQ(prior_with_lines({}, hinge.model, 0).score.size(), 0);
}

}  // namespace
}  // namespace roadbook::test
