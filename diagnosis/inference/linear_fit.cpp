#include "diagnosis/inference/linear_fit.hpp"

#include <Eigen/Cholesky>

namespace roadbook {

using Eigen::Index;

Projection linear_projection(const CauseModel& model,
                             std::vector<Candidate> candidates,
                             Eigen::VectorXd readings,
                             const std::function<Eigen::MatrixXd(const Candidate&)>& columns,
                             const std::function<Innovations(const Eigen::MatrixXd&)>& white) {
  std::vector<Eigen::MatrixXd> parts;
  Projection projection;
  for (const Accepted& a : model.accepted) {
    parts.push_back(columns(a.candidate));
    readings -= parts.back() * a.size;
    projection.accepted += static_cast<std::size_t>(parts.back().cols());
  }
  std::size_t next = projection.accepted;
  for (Candidate& c : candidates) {
    Eigen::MatrixXd own = columns(c);
    if (own.isZero(0.0)) continue;
    c.columns.clear();
    for (Index k = 0; k < own.cols(); ++k) c.columns.push_back(next++);
    projection.candidates.push_back(c);
    parts.push_back(std::move(own));
  }
  Eigen::MatrixXd sides(readings.size(), static_cast<Index>(1 + next));
  sides.col(0) = readings;
  Index at = 1;
  for (const Eigen::MatrixXd& part : parts) {
    sides.middleCols(at, part.cols()) = part;
    at += part.cols();
  }
  projection.innovations = white(sides);
  return projection;
}

void linear_fit(const Projection& projection, CauseModel& model, const SizePrior& others) {
  const auto n = static_cast<Index>(projection.accepted);
  const Innovations& e = projection.innovations;
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(n);
  double squares = 0.0;
  for (std::size_t i = 0; i < e.of.size(); ++i) {
    const Eigen::Map<const Eigen::VectorXd> column(e.row(i) + 1, n);
    F.noalias() += column * column.transpose();
    u += column * e.row(i)[0];
    squares += e.row(i)[0] * e.row(i)[0];
  }
  Eigen::MatrixXd held = F;
  Eigen::VectorXd pull = u;
  if (!others.empty()) {
    held += others.information;
    pull += others.score(sizes_of(model));
  }
  held.diagonal() *= 1.0 + 1e-10;
  const Eigen::VectorXd step = n > 0 ? Eigen::VectorXd(held.ldlt().solve(pull)) : pull;
  Index at = 0;
  for (Accepted& a : model.accepted) {
    a.size += step.segment(at, a.size.size());
    at += a.size.size();
  }
  model.information = F;
  model.log_likelihood = -0.5 * (squares - 2.0 * u.dot(step) + step.dot(F * step));
}

}  // namespace roadbook
