#pragma once

#include <Eigen/Dense>
#include <cmath>
#include <map>
#include <utility>

#include "base/random.hpp"
#include "diagnosis/inference/cause_problem.hpp"

namespace roadbook::test {

/// The smallest problem: readings of one channel with unknown offset and slope in time, plus
/// columns of candidates that may have been added to the readings.
class RegressionProblem final : public CauseProblem {
 public:
  struct Column {
    Candidate candidate;
    Eigen::VectorXd values;
  };

  RegressionProblem(std::uint64_t seed, Eigen::Index rows)
      : random_(seed), readings_(rows), line_(rows, 2) {
    for (Eigen::Index i = 0; i < rows; ++i) {
      line_.row(i) << 1.0, time(i);
      readings_[i] = 3.0 - 0.1 * time(i) + random_.normal();
    }
  }

  [[nodiscard]] static double time(Eigen::Index i) { return 0.1 * static_cast<double>(i); }
  [[nodiscard]] Eigen::VectorXd draw() {
    Eigen::VectorXd values(readings_.size());
    for (double& v : values) v = random_.normal();
    return values;
  }
  void add(const std::string& name, const Eigen::VectorXd& values) {
    Candidate c;
    c.name = name;
    c.unit = "1";
    c.effect = columns_.size();
    columns_.push_back({c, values});
  }
  /// Makes the last column a generic effect without a catalogued equivalent.
  void make_term() {
    Candidate& c = columns_.back().candidate;
    c.kind = CandidateKind::kGrammar;
    c.hook = "a.term";
    c.covariate = "something";
    c.penalty = 2.0;
  }
  /// Makes the last column an effect of one place.
  void make_place() { columns_.back().candidate.kind = CandidateKind::kPlace; }
  void bound(std::size_t column, double lowest, double highest) {
    columns_[column].candidate.lowest = lowest;
    columns_[column].candidate.highest = highest;
  }
  void hide(std::size_t column, double size) { readings_ += size * columns_[column].values; }
  void plausible(std::size_t column, double tau) { columns_[column].candidate.tau = tau; }
  /// Tests catalogued effects against catalogued effects alone.
  void set_level_of_names(double level) { level_ = level; }
  /// Sets the noise of the readings to `sigma` instead of 1. Rows are whitened by this value.
  void set_sigma(double sigma) { sigma_ = sigma; }

  /// Size and standard error of a column by ordinary least squares, with the line in the model.
  [[nodiscard]] std::pair<double, double> least_squares(std::size_t column) const {
    Eigen::MatrixXd A(readings_.size(), 3);
    A << line_, columns_[column].values;
    const Eigen::MatrixXd inverse = (A.transpose() * A).inverse();
    return {(inverse * A.transpose() * readings_)[2], sigma_ * std::sqrt(inverse(2, 2))};
  }

  [[nodiscard]] std::vector<ChannelName> channels() const override {
    return {{"readings", "value"}};
  }
  [[nodiscard]] std::size_t rows() const override {
    return static_cast<std::size_t>(readings_.size());
  }
  [[nodiscard]] double level_of_names() const override { return level_; }
  [[nodiscard]] CauseModel nominal() const override {
    CauseModel model;
    fit(model, 1);
    return model;
  }
  [[nodiscard]] std::vector<Candidate> candidates(const CauseModel&) const override {
    std::vector<Candidate> all;
    for (const Column& c : columns_) all.push_back(c.candidate);
    return all;
  }

  [[nodiscard]] Projection project(const CauseModel& model,
                                   std::vector<Candidate> candidates) const override {
    Projection p;
    p.accepted = model.accepted.size();
    Eigen::MatrixXd sides(readings_.size(), 1);
    sides.col(0) = readings_;
    const auto append = [&](const Candidate& c) {
      sides.conservativeResize(Eigen::NoChange, sides.cols() + 1);
      sides.rightCols(1) = columns_[c.effect].values;
    };
    for (const Accepted& a : model.accepted) {
      sides.col(0) -= a.size[0] * columns_[a.candidate.effect].values;
      append(a.candidate);
    }
    for (Candidate& c : candidates) {
      c.columns = {static_cast<std::size_t>(sides.cols()) - 1};
      append(c);
    }
    p.candidates = std::move(candidates);
    const Eigen::MatrixXd left = without_line(sides) / sigma_;
    p.innovations.sides = static_cast<std::size_t>(left.cols());
    for (Eigen::Index i = 0; i < left.rows(); ++i) {
      p.innovations.of.push_back({static_cast<std::size_t>(i), 0, time(i), 1.0});
      for (Eigen::Index k = 0; k < left.cols(); ++k) p.innovations.values.push_back(left(i, k));
    }
    return p;
  }

  void fit(CauseModel& model, int) const override {
    const auto n = static_cast<Eigen::Index>(model.accepted.size());
    Eigen::MatrixXd A(readings_.size(), n);
    for (Eigen::Index k = 0; k < n; ++k)
      A.col(k) = columns_[model.accepted[static_cast<std::size_t>(k)].candidate.effect].values;
    A = without_line(A) / sigma_;
    const Eigen::VectorXd y = without_line(readings_) / sigma_;
    model.information = A.transpose() * A;
    const Eigen::VectorXd size = model.information.ldlt().solve(A.transpose() * y);
    for (Eigen::Index k = 0; k < n; ++k)
      model.accepted[static_cast<std::size_t>(k)].size[0] = size[k];
    model.log_likelihood = -0.5 * (y - A * size).squaredNorm();
  }

 private:
  [[nodiscard]] Eigen::MatrixXd without_line(const Eigen::MatrixXd& sides) const {
    return sides - line_ * (line_.transpose() * line_).ldlt().solve(line_.transpose() * sides);
  }

  Random random_;
  Eigen::VectorXd readings_;
  Eigen::MatrixXd line_;
  std::vector<Column> columns_;
  double sigma_ = 1.0;
  double level_ = 0.0;
};

}  // namespace roadbook::test
