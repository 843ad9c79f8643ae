#include "diagnosis/motion/separating_drive.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "diagnosis/streams/manoeuvres.hpp"
#include "diagnosis/streams/observe.hpp"

namespace roadbook {
namespace {

// Information of all accepted sizes and of the alternatives, trajectory projected out.
Eigen::MatrixXd information_of(const Observations& obs,
                               const MotionModel& model,
                               const std::vector<Candidate>& alternatives) {
  Library library = build_library(obs, model.point, alternatives, accepted_columns(obs, model));
  const auto pass = run_pass(obs, model.point, model.noise, library.columns, {});
  const auto columns = static_cast<Eigen::Index>(library.columns.count());
  const auto sides = static_cast<Eigen::Index>(pass.innovations.sides);
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>
      rows(pass.innovations.values.data(), static_cast<Eigen::Index>(pass.innovations.of.size()),
           sides);
  const auto of_causes = rows.middleCols(1, columns);
  const Eigen::MatrixXd products = of_causes.transpose() * of_causes;
  // An alternative whose streams are not there has no column: its rows stay zero.
  const auto front = static_cast<Eigen::Index>(library.front);
  const auto count = front + static_cast<Eigen::Index>(alternatives.size());
  std::vector<Eigen::Index> place(static_cast<std::size_t>(count), -1);
  for (Eigen::Index i = 0; i < front; ++i) place[static_cast<std::size_t>(i)] = i;
  for (const Candidate& c : library.candidates)
    for (std::size_t k = 0; k < alternatives.size(); ++k)
      if (alternatives[k].name == c.name && c.columns.size() == 1)
        place[static_cast<std::size_t>(front) + k] = static_cast<Eigen::Index>(c.columns.front());
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index i = 0; i < count; ++i)
    for (Eigen::Index j = 0; j < count; ++j) {
      const Eigen::Index p = place[static_cast<std::size_t>(i)];
      const Eigen::Index q = place[static_cast<std::size_t>(j)];
      if (p >= 0 && q >= 0) F(i, j) = products(p, q);
    }
  return F;
}

// The model about a manoeuvre's own trajectory.
MotionModel about(const Observations& obs, const MotionModel& model) {
  MotionModel other = model;
  other.point.trajectory = trajectory_of_poses(obs);
  other.point.residual.assign(obs.offsets().back(), 0.0);
  other.inflation.clear();
  return other;
}

// Loss of log likelihood with the alternative in place of the effect, the other effects free.
double loss(const Eigen::MatrixXd& F,
            Eigen::Index cause,
            Eigen::Index alternative,
            Eigen::Index accepted,
            double size) {
  std::vector<Eigen::Index> kept{cause, alternative};
  for (Eigen::Index i = 0; i < accepted; ++i)
    if (i != cause) kept.push_back(i);
  const auto n = static_cast<Eigen::Index>(kept.size());
  Eigen::MatrixXd G(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      G(i, j) = F(kept[static_cast<std::size_t>(i)], kept[static_cast<std::size_t>(j)]);
  // All but the cause are refitted: what of it they cannot imitate remains.
  Eigen::MatrixXd rest = G.bottomRightCorner(n - 1, n - 1);
  rest.diagonal() *= 1.0 + 1e-9;
  rest.diagonal().array() += 1e-12;
  const Eigen::VectorXd with = G.col(0).tail(n - 1);
  const double remains = G(0, 0) - with.dot(rest.ldlt().solve(with));
  return 0.5 * size * size * std::max(0.0, remains);
}

MotionStreams streams_like(const Observations& obs) {
  MotionStreams like;
  like.wheel_model = obs.wheel_model;
  like.wheels_read = obs.wheels_read;
  like.poses_have_heading = obs.poses_have_heading;
  like.poses = obs.poses;
  for (const WheelObservation& w : obs.wheels)
    like.wheels.push_back({w.t_s, w.left_rad, w.right_rad});
  // Windows hold means of readings, with the number of readings as weight.
  const auto samples = [&](const std::vector<WindowObservation>& windows, auto& out) {
    for (const WindowObservation& w : windows)
      for (std::size_t i = 0; i < w.count; ++i)
        out.push_back({w.begin_s + (w.end_s - w.begin_s) * static_cast<double>(i) /
                                       static_cast<double>(w.count),
                       w.value});
  };
  samples(obs.steering, like.steering);
  samples(obs.gyro, like.gyro);
  return like;
}

}  // namespace

std::string separating_drive(const Observations& obs,
                             const MotionModel& model,
                             std::size_t a,
                             const std::vector<Candidate>& alternatives,
                             double threshold) {
  Eigen::Index first = 0;
  for (std::size_t i = 0; i < a; ++i) first += model.accepted[i].size.size();
  Eigen::Index accepted = 0;
  for (const Accepted& cause : model.accepted) accepted += cause.size.size();
  if (model.accepted[a].size.size() != 1) return {};
  const double size = model.accepted[a].size[0];

  const Eigen::MatrixXd F_drive = information_of(obs, model, alternatives);
  const MotionStreams like = streams_like(obs);
  for (const Manoeuvre& manoeuvre : manoeuvres()) {
    ObservationOptions options;
    options.step_s = obs.step_s;
    const Observations driven = observe(streams_of(manoeuvre, like), options);
    const Eigen::MatrixXd F = F_drive + information_of(driven, about(driven, model), alternatives);
    double least = 1e300;
    for (std::size_t k = 0; k < alternatives.size(); ++k)
      least =
          std::min(least, loss(F, first, accepted + static_cast<Eigen::Index>(k), accepted, size));
    if (least >= 2.0 * threshold) return manoeuvre.name + " would separate them";
  }
  return "none of the manoeuvres tried would separate them";
}

}  // namespace roadbook
