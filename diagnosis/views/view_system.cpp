#include "diagnosis/views/view_system.hpp"

#include <Eigen/Cholesky>
#include <algorithm>

#include "base/index.hpp"
#include "base/parallel.hpp"

namespace roadbook {
namespace {

BundleOptions plain_options(int num_threads) {
  BundleOptions options;
  options.loss = RobustLoss::kNone;
  options.num_threads = num_threads;
  return options;
}

std::vector<std::uint8_t> points_with_two(const BundleProblem& problem) {
  std::vector<int> count(problem.points.size(), 0);
  for (const BundleObservation& o : problem.observations) ++count[at(o.point)];
  std::vector<std::uint8_t> kept(count.size());
  for (std::size_t p = 0; p < kept.size(); ++p) kept[p] = count[p] >= 2 ? 1 : 0;
  return kept;
}

std::vector<std::uint8_t> rows_used(const Eigen::MatrixXd& sums) {
  std::vector<std::uint8_t> used(static_cast<std::size_t>(sums.rows()), 0);
  for (Eigen::Index i = 0; i < sums.rows(); ++i)
    used[static_cast<std::size_t>(i)] = sums.cols() > 0 && !sums.row(i).isZero(0.0) ? 1 : 0;
  return used;
}

// For each term of the layout its observation. Observations are sorted by landmark.
std::vector<int> sources(const BundleProblem& problem, const BundleLayout& layout) {
  std::vector<int> begin(problem.points.size() + 1, 0);
  for (const BundleObservation& o : problem.observations) ++begin[at(o.point) + 1];
  for (std::size_t p = 1; p < begin.size(); ++p) begin[p] += begin[p - 1];
  std::vector<int> source(layout.terms.size(), -1);
  for (std::size_t p = 0; p < problem.points.size(); ++p) {
    int next = begin[p];
    for (std::size_t t = layout.term_begin[p]; t < layout.term_begin[p + 1]; ++t)
      if (layout.terms[t].camera != BundleTerm::kGround) source[t] = next++;
  }
  return source;
}

}  // namespace

ViewSystem::ViewSystem(const ViewData& data, const ViewBasis& basis, int num_threads)
    : data_(data),
      basis_(basis),
      prediction_(data, basis),
      options_(plain_options(num_threads)),
      problem_(data.bundle),
      layout_(problem_,
              options_,
              std::vector<std::uint8_t>(problem_.observations.size(), 1),
              points_with_two(problem_)) {
  observation_of_term_ = sources(problem_, layout_);
  list_rows();
}

void ViewSystem::list_rows() {
  const ViewChannels channels{data_.bundle.cameras.size()};
  terms_of_pose_.resize(problem_.poses.size());
  motions_of_pose_.resize(problem_.poses.size());
  rows_of_pose_.resize(problem_.poses.size());
  row_of_term_.resize(layout_.terms.size());
  row_of_motion_.resize(problem_.motions.size());
  for (std::size_t t = 0; t < layout_.terms.size(); ++t)
    terms_of_pose_[at(layout_.terms[t].pose)].push_back(t);
  for (std::size_t m = 0; m < problem_.motions.size(); ++m)
    motions_of_pose_[at(problem_.motions[m].to)].push_back(m);
  for (std::size_t k = 0; k < problem_.poses.size(); ++k) {
    const int pose = static_cast<int>(k);
    first_row_.push_back(row_count_);
    for (const std::size_t t : terms_of_pose_[k]) {
      row_of_term_[t] = row_count_ + rows_of_pose_[k].size();
      if (const int o = observation_of_term_[t]; o >= 0) {
        const std::size_t camera = at(problem_.observations[at(o)].camera);
        rows_of_pose_[k].insert(rows_of_pose_[k].end(), 2, {camera, pose, o});
      } else {
        rows_of_pose_[k].push_back({channels.ground(), pose, -1});
      }
    }
    for (const std::size_t m : motions_of_pose_[k]) {
      row_of_motion_[m] = row_count_ + rows_of_pose_[k].size();
      for (std::size_t axis = 0; axis < 6; ++axis)
        rows_of_pose_[k].push_back({channels.motion(axis), pose, -1});
    }
    row_count_ += rows_of_pose_[k].size();
  }
}

void ViewSystem::set_noise(const ViewNoise& noise) {
  options_.ground_sigma_m = noise.ground_m;
  for (std::size_t i = 0; i < problem_.observations.size(); ++i) {
    BundleObservation& o = problem_.observations[i];
    o.sigma_px = data_.bundle.observations[i].sigma_px * noise.pixel[at(o.camera)];
  }
  for (std::size_t m = 0; m < problem_.motions.size(); ++m) {
    Matrix6d& information = problem_.motions[m].information;
    information = data_.bundle.motions[m].information;
    for (int i = 0; i < 6; ++i)
      for (int j = 0; j < 6; ++j) information(i, j) /= noise.motion[at(i)] * noise.motion[at(j)];
  }
}

void ViewSystem::refresh_layout() {
  for (std::size_t p = 0; p < problem_.points.size(); ++p)
    for (std::size_t t = layout_.term_begin[p]; t < layout_.term_begin[p + 1]; ++t) {
      BundleTerm& term = layout_.terms[t];
      if (const int o = observation_of_term_[t]; o >= 0) {
        term.pixel = problem_.observations[at(o)].pixel;
        term.inv_sigma = 1.0 / problem_.observations[at(o)].sigma_px;
      } else {
        term.pixel.x() = problem_.points[p].ground_height_m;
        term.inv_sigma = 1.0 / options_.ground_sigma_m;
      }
    }
}

bool ViewSystem::linearise(const ViewPoint& point,
                           const ViewNoise& noise,
                           const Eigen::MatrixXd* sums) {
  set_noise(noise);
  prediction_.apply(point, problem_, options_.num_threads);
  refresh_layout();
  if (!system_) system_ = std::make_unique<BundleSystem>(problem_, layout_, options_);
  system_->linearise(point.state);
  linearise_terms(point, sums == nullptr ? std::vector<std::uint8_t>() : rows_used(*sums));
  linearise_motions(point);
  // Negligible against any reading; prevents singular landmarks with hardly any parallax.
  constexpr double kDamping = 1e-9;
  BundleStep step;
  return system_->solve(kDamping, step);
}

double ViewSystem::squares() const {
  double sum = 0.0;
  for (const Term& term : terms_)
    sum += term.e.valid ? term.e.r.squaredNorm() : invalid_cost(options_);
  for (const Motion& motion : motions_) sum += motion.r.squaredNorm();
  return sum;
}

bool ViewSystem::adjust(ViewPoint& point, const ViewNoise& noise) {
  set_noise(noise);
  prediction_.apply(point, problem_, options_.num_threads);
  BundleProblem problem = problem_;
  for (std::size_t k = 0; k < problem.poses.size(); ++k)
    problem.poses[k].T_map_vehicle = point.state.poses[k];
  for (std::size_t p = 0; p < problem.points.size(); ++p)
    problem.points[p].p_map = point.state.points[p];
  BundleOptions options = options_;
  options.outlier_rounds = 0;
  options.max_iterations = 4;  // later steps gain little, and further Gauss-Newton steps follow
  options.relative_tolerance = 1e-3;
  if (!bundle_adjust(problem, options).usable) return false;
  point.state = state_of(problem);
  return true;
}

// Normal equations of one landmark with fixed poses.
ViewSystem::PointFit ViewSystem::point_fit(std::size_t p,
                                           const BundleState& state,
                                           const Eigen::Vector3d& p_map) const {
  PointFit fit{p_map};
  for (std::size_t t = layout_.term_begin[p]; t < layout_.term_begin[p + 1]; ++t) {
    const BundleTerm& term = layout_.terms[t];
    const TermResidual e = term_residual(problem_, term, state.poses[at(term.pose)], p_map, true);
    if (!e.valid) {
      fit.squares +=
          invalid_cost(options_);  // otherwise leaving the field of view would lower the cost
      continue;
    }
    fit.squares += e.r.squaredNorm();
    fit.V.noalias() += e.J_point.transpose() * e.J_point;
    fit.b.noalias() -= e.J_point.transpose() * e.r;
  }
  return fit;
}

// Levenberg-Marquardt for one landmark.
ViewSystem::PointFit ViewSystem::settled_point(std::size_t p, const BundleState& state) const {
  constexpr int kTrials = 4;
  constexpr double kAtRest = 1e-3;  // [chi-squared]
  PointFit best = point_fit(p, state, state.points[p]);
  double lambda = 1e-4;
  for (int trial = 0; trial < kTrials; ++trial) {
    Eigen::Matrix3d damped = best.V;
    damped.diagonal() *= 1.0 + lambda;
    const Eigen::LLT<Eigen::Matrix3d> llt(damped);
    if (llt.info() != Eigen::Success) break;
    const PointFit next = point_fit(p, state, best.p_map + llt.solve(best.b));
    const double gained = best.squares - next.squares;
    lambda *= gained > 0.0 ? 0.1 : 100.0;
    if (gained > 0.0) best = next;
    if (gained > 0.0 && gained < kAtRest) break;
  }
  return best;
}

double ViewSystem::settle_points(ViewPoint& point) {
  prediction_.apply(point, problem_, options_.num_threads);
  refresh_layout();
  std::vector<double> squares(problem_.points.size(), 0.0);
  parallel_for_small(problem_.points.size(), options_.num_threads, [&](std::size_t p) {
    const PointFit fit = layout_.point_free[p] != 0
                             ? settled_point(p, point.state)
                             : point_fit(p, point.state, point.state.points[p]);
    point.state.points[p] = fit.p_map;
    squares[p] = fit.squares;
  });
  double sum = 0.0;
  for (const double s : squares) sum += s;
  for (const MotionConstraint& m : problem_.motions) {
    const Vector6d r = motion_residual(point.state.poses[at(m.from)], point.state.poses[at(m.to)],
                                       m.T_from_to, 1.0)
                           .r;
    sum += r.dot(m.information * r);
  }
  return sum;
}

void ViewSystem::lay_out_strips() {
  terms_.resize(layout_.terms.size());
  const std::size_t view = 2 * basis_.per_camera();
  const std::size_t ground = basis_.size() - basis_.hinge();
  std::size_t end = 0;
  for (std::size_t t = 0; t < terms_.size(); ++t) {
    terms_[t].strip = end;
    end += observation_of_term_[t] >= 0 ? view : ground;
  }
  strips_.resize(end);
}

void ViewSystem::linearise_terms(const ViewPoint& point, const std::vector<std::uint8_t>& needed) {
  const SteppedCameras cameras(problem_.cameras);
  const ViewTiming timing(data_, point.effects);
  const auto needed_of = [&](int camera) {
    const std::span<const std::uint8_t> all(needed);
    return all.empty() ? all : all.subspan(basis_.camera(at(camera)), basis_.per_camera());
  };
  lay_out_strips();
  parallel_for_small(problem_.points.size(), options_.num_threads, [&](std::size_t p) {
    for (std::size_t t = layout_.term_begin[p]; t < layout_.term_begin[p + 1]; ++t) {
      const BundleTerm& term = layout_.terms[t];
      Term& mine = terms_[t];
      mine.point = static_cast<int>(p);
      mine.e = term_residual(problem_, term, point.state.poses[at(term.pose)],
                             point.state.points[p], true);
      if (const int o = observation_of_term_[t]; o >= 0) {
        TermResidual plain = mine.e;
        plain.r /= term.inv_sigma;
        plain.J_pose /= term.inv_sigma;
        Eigen::Map<ViewPrediction::Strip> strip(strips_.data() + mine.strip, 2,
                                                index(basis_.per_camera()));
        prediction_.view_columns(point, cameras, timing, needed_of(term.camera),
                                 problem_.observations[at(o)], plain, strip);
        strip *= mine.e.valid ? term.inv_sigma : 0.0;
      } else {
        ground_strip(point, t);
      }
      mine.e.r = -mine.e.r;  // reading less prediction
    }
  });
}

void ViewSystem::ground_strip(const ViewPoint& point, std::size_t t) {
  const std::size_t p = at(terms_[t].point);
  const Eigen::VectorXd columns =
      prediction_.ground_columns(point, problem_.points[p], point.state.points[p]);
  Eigen::Map<Eigen::VectorXd>(strips_.data() + terms_[t].strip, columns.size()) =
      -layout_.terms[t].inv_sigma * columns;
}

void ViewSystem::linearise_motions(const ViewPoint& point) {
  motions_.resize(problem_.motions.size());
  const SteppedWheels wheels(point.effects);
  parallel_for(motions_.size(), options_.num_threads, [&](std::size_t m) {
    const MotionConstraint& motion = problem_.motions[m];
    const MotionResidual e =
        motion_residual(point.state.poses[at(motion.from)], point.state.poses[at(motion.to)],
                        motion.T_from_to, 1.0);
    const Matrix6d root = motion.information.llt().matrixU();
    motions_[m].r = -root * e.r;
    motions_[m].J_from = root * e.J_from;
    motions_[m].J_to = root * e.J_to;
    motions_[m].strip = root * prediction_.motion_columns(point, wheels, data_.bundle.motions[m]);
  });
}

void ViewSystem::move(ViewPoint& point, const ViewSides& sides, const Eigen::VectorXd& size) const {
  const auto step_of = [&](const auto& x) -> Eigen::VectorXd {
    return x.col(0) - x.middleCols(1, size.size()) * size;
  };
  BundleStep step;
  step.poses = step_of(sides.poses);
  const Eigen::VectorXd points = step_of(sides.points);
  for (std::size_t p = 0; p < problem_.points.size(); ++p)
    step.points.push_back(points.segment<3>(index(3 * p)));
  step.scales = Eigen::VectorXd::Zero(index(point.state.scales.size()));
  point.state = moved(point.state, layout_, step);
}

}  // namespace roadbook
