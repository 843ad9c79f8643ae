#include "diagnosis/views/view_problem.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "base/error.hpp"
#include "base/index.hpp"
#include "diagnosis/views/corner_errors.hpp"
#include "diagnosis/views/hinge_lines.hpp"
#include "diagnosis/views/hinge_search.hpp"
#include "diagnosis/views/view_compression.hpp"
#include "diagnosis/views/view_evidence.hpp"
#include "diagnosis/views/view_noise_causes.hpp"
#include "diagnosis/views/view_whiteness.hpp"
#include "diagnosis/views/wheel_variations.hpp"

namespace roadbook {
namespace {

struct FittedViews final : CauseState {
  explicit FittedViews(BundleState s) : state(std::move(s)) {}
  BundleState state;
};

constexpr double kGrammarTau = 0.5;  // [px]
constexpr double kWorthAStep = 0.5;  // [chi-squared] least gain of a further line step
constexpr int kLineIterations = 6;   // fits with lines need more iterations

}  // namespace

ViewProblem::ViewProblem(ViewData data, EffectSizes known, LibraryOptions library, int num_threads)
    : known_(std::move(known)), library_(std::move(library)) {
  basis_.cameras = data.bundle.cameras.size();
  fit_ = fit_views(std::move(data), basis_, known_, library_.places, num_threads);
  if (!fit_.usable) return;
  causes_ = view_causes(fit_.data, basis_);
  system_ = std::make_unique<ViewSystem>(fit_.data, basis_, num_threads);
  nominal_ = fitted_nominal();
}

std::vector<TimedPose> ViewProblem::poses_with(const EffectSizes& effects) const {
  ViewPoint point = fit_.point;
  point.effects = effects;
  stands_at_.reset();
  settle(*system_, fit_.noise, point);
  std::vector<TimedPose> poses;
  for (std::size_t k = 0; k < point.state.poses.size(); ++k)
    poses.push_back({fit_.data.moments[k].t_ns, point.state.poses[k]});
  return poses;
}

std::vector<ChannelName> ViewProblem::channels() const {
  std::vector<ChannelName> names;
  for (const MountedCamera& camera : fit_.data.bundle.cameras)
    names.push_back({camera.name, "reprojection"});
  for (const char* axis : {"along", "across", "height", "roll", "pitch", "heading"})
    names.push_back({"wheels0", std::string("keyframe ") + axis});
  names.push_back({"ground", "height"});
  return names;
}

std::size_t ViewProblem::rows() const { return system_->row_count(); }

ViewPoint ViewProblem::point_of(const CauseModel& model) const {
  const auto* fitted = dynamic_cast<const FittedViews*>(model.state.get());
  ROADBOOK_ASSERT(fitted != nullptr);
  ViewPoint point{fitted->state, {}, {}, {}};
  take_sizes(model, point);
  return point;
}

void ViewProblem::take_sizes(const CauseModel& model, ViewPoint& point) const {
  point.effects = known_;
  point.linear = fit_.point.linear;
  point.hinges = fit_.point.hinges;
  for (const Accepted& a : model.accepted) {
    if (a.candidate.kind == CandidateKind::kPlace)
      point.hinges[a.candidate.effect] = line_of(a.candidate);
    if (a.candidate.kind == CandidateKind::kNamed)
      point.effects[a.candidate.name] += a.size[0];
    else
      point.linear += sums_of(a.candidate) * a.size;
  }
}

Eigen::MatrixXd ViewProblem::sums_of(const Candidate& candidate) const {
  Eigen::MatrixXd sums = Eigen::MatrixXd::Zero(index(basis_.size()), 1);
  if (candidate.kind == CandidateKind::kNamed) {
    for (const std::size_t column : causes_[candidate.effect].columns) sums(index(column), 0) = 1.0;
    return sums;
  }
  if (candidate.kind == CandidateKind::kPlace) {
    sums(index(basis_.hinge(candidate.effect)), 0) = 1.0;
    return sums;
  }
  if (candidate.hook.starts_with("wheels0.")) {
    sums(index(basis_.variations() + candidate.effect), 0) = 1.0;
    return sums;
  }
  const std::size_t hook = candidate.hook.ends_with(kViewHooks[0]) ? 0 : 1;
  const ViewTerms& terms = kViewTerms[candidate.effect];
  // Every basis function but the constant is used together with the constant.
  const std::size_t mean = terms.first == 0 ? 0 : 1;
  sums = Eigen::MatrixXd::Zero(index(basis_.size()), index(mean + terms.count));
  for (std::size_t c = 0; c < basis_.cameras; ++c) {
    const std::string& camera = fit_.data.bundle.cameras[c].name;
    if (!candidate.hook.starts_with("cam.") && !candidate.hook.starts_with(camera + ".")) continue;
    if (mean == 1) sums(index(basis_.term(c, hook, 0)), 0) = 1.0;
    for (std::size_t t = 0; t < terms.count; ++t)
      sums(index(basis_.term(c, hook, terms.first + t)), index(mean + t)) = 1.0;
  }
  return sums;
}

Eigen::MatrixXd ViewProblem::accepted_sums(const CauseModel& model) const {
  Eigen::MatrixXd sums(index(basis_.size()), 0);
  for (const Accepted& a : model.accepted) {
    const Eigen::MatrixXd own = sums_of(a.candidate);
    sums.conservativeResize(Eigen::NoChange, sums.cols() + own.cols());
    sums.rightCols(own.cols()) = own;
  }
  return sums;
}

std::vector<Candidate> ViewProblem::candidates(const CauseModel& model) const {
  std::vector<Candidate> all;
  const CornerErrors corners(fit_.data, fit_.noise);
  const auto left_out = [&](const std::string& name) {
    return std::find(library_.without.begin(), library_.without.end(), name) !=
           library_.without.end();
  };
  for (std::size_t c = 0; c < causes_.size() && library_.named; ++c) {
    Candidate named;
    named.name = causes_[c].name;
    named.unit = causes_[c].unit;
    named.effect = c;
    named.tau = causes_[c].tau;
    named.least_statistic = corners.hide(causes_[c], basis_);
    if (!left_out(named.name)) all.push_back(named);
  }
  const auto is_found = [&](std::size_t h) {
    return std::any_of(model.accepted.begin(), model.accepted.end(), [&](const Accepted& a) {
      return a.candidate.kind == CandidateKind::kPlace && a.candidate.effect == h;
    });
  };
  for (std::size_t h = 0; h < basis_.hinges && !left_out("ground.hinge"); ++h) {
    if (is_found(h)) continue;
    Candidate hinge;
    hinge.kind = CandidateKind::kPlace;
    hinge.at_known = h == 0 && known_.contains("ground.hinge");
    hinge.name = "ground.hinge";
    hinge.unit = "rad";
    hinge.effect = h;
    hinge.tau = kHingeTau;
    hinge.penalty = std::log(static_cast<double>(kHingeLines));
    set_line(fit_.point.hinges[h], hinge);
    all.push_back(hinge);
  }
  std::vector<std::string> streams;
  for (const MountedCamera& camera : fit_.data.bundle.cameras) streams.push_back(camera.name);
  if (basis_.cameras > 1) streams.emplace_back("cam");
  for (std::size_t s = 0; s < streams.size(); ++s)
    for (const std::string_view hook : kViewHooks)
      for (std::size_t t = 0; t < kViewTerms.size() && library_.grammar; ++t) {
        Candidate term;
        term.kind = CandidateKind::kGrammar;
        term.hook = streams[s] + "." + std::string(hook);
        term.covariate = kViewTerms[t].covariate;
        term.name = term.hook + " ~ " + term.covariate;
        term.unit = "px";
        term.effect = t;
        term.tau = kGrammarTau;
        term.penalty = kGrammarPenalty;
        term.least_statistic = s < basis_.cameras ? corners.hide(s) : corners.hide_of_rig();
        if (!left_out(term.name)) all.push_back(term);
      }
  return all;
}

CauseModel ViewProblem::nominal() const { return nominal_; }

CauseModel ViewProblem::fitted_nominal() const {
  CauseModel model;
  model.state = std::make_shared<FittedViews>(fit_.point.state);
  ViewPoint point = fit_.point;
  model.log_likelihood =
      -0.5 * view_step(*system_, point, fit_.noise, accepted_sums(model)).squares;
  model.information.resize(0, 0);
  return model;
}

ViewSystem& ViewProblem::at(const CauseModel& model) const {
  Eigen::VectorXd sizes;
  for (const Accepted& a : model.accepted) {
    sizes.conservativeResize(sizes.size() + a.size.size());
    sizes.tail(a.size.size()) = a.size;
  }
  if (stands_at_ == model.state && stands_sizes_.size() == sizes.size() && stands_sizes_ == sizes)
    return *system_;
  const bool whole = system_->linearise(point_of(model), fit_.noise);
  ROADBOOK_ASSERT(whole);  // the nominal fit has gone through the same factor
  stands_at_ = model.state;
  stands_sizes_ = sizes;
  return *system_;
}

Projection ViewProblem::project(const CauseModel& model, std::vector<Candidate> candidates) const {
  if (candidates.empty()) return one_row_a_landmark(model);
  Eigen::MatrixXd sums = accepted_sums(model);
  Projection p;
  p.accepted = static_cast<std::size_t>(sums.cols());
  // Many candidates share columns: the constant, and rig effects if there is one camera.
  std::map<std::vector<Eigen::Index>, std::size_t> known;
  for (Candidate& c : candidates) {
    const Eigen::MatrixXd own = sums_of(c);
    c.columns.clear();
    for (Eigen::Index i = 0; i < own.cols(); ++i) {
      std::vector<Eigen::Index> weights;
      for (Eigen::Index k = 0; k < own.rows(); ++k)
        if (own(k, i) != 0.0) weights.push_back(k);
      const auto [place, fresh] = known.try_emplace(weights, static_cast<std::size_t>(sums.cols()));
      c.columns.push_back(place->second);
      if (!fresh) continue;
      sums.conservativeResize(Eigen::NoChange, sums.cols() + 1);
      sums.rightCols(1) = own.col(i);
    }
  }
  p.candidates = std::move(candidates);
  ViewPoint sizes;
  take_sizes(model, sizes);
  const Eigen::MatrixXd lines = line_columns(basis_, model, sizes);
  Eigen::MatrixXd all(sums.rows(), sums.cols() + lines.cols());
  all << sums, lines;
  p.innovations = compressed_innovations(at(model), fit_.data, all);
  project_out_lines(p.innovations, lines.cols());
  return p;
}

Projection ViewProblem::one_row_a_landmark(const CauseModel& model) const {
  Projection p;
  const Eigen::MatrixXd sums = accepted_sums(model);
  p.accepted = static_cast<std::size_t>(sums.cols());
  p.innovations = landmark_innovations(at(model), fit_.data, sums);
  const std::vector<double> p_white = image_whiteness(at(model), fit_.data);
  for (std::size_t c = 0; c < p_white.size(); ++c) p.innovations.whiteness_p[c] = p_white[c];
  return p;
}

void ViewProblem::fit(CauseModel& model, int iterations) const {
  fit_beside(model, iterations, {});
}

bool ViewProblem::take_step(const ViewStep& step, CauseModel& model, ViewPoint& point) const {
  Eigen::Index at = 0;
  for (Accepted& a : model.accepted)
    for (double& size : a.size) size += step.size[at++];
  const bool whole = move_lines(step.size.tail(step.size.size() - at), basis_, point, model);
  take_sizes(model, point);
  return whole;
}

void ViewProblem::fit_beside(CauseModel& model, int iterations, const SizePrior& others) const {
  const Eigen::MatrixXd sizes = accepted_sums(model);
  ViewPoint point = point_of(model);
  stands_at_.reset();
  if (iterations > 1 && has_hinge(model)) iterations = std::max(iterations, kLineIterations);
  double before = std::numeric_limits<double>::infinity();
  for (int i = 0; i < iterations; ++i) {
    const Eigen::MatrixXd lines = line_columns(basis_, model, point);
    Eigen::MatrixXd sums(sizes.rows(), sizes.cols() + lines.cols());
    sums << sizes, lines;
    BundleState from = point.state;
    const ViewStep step =
        view_step(*system_, point, fit_.noise, sums, prior_with_lines(others, model, lines.cols()));
    ROADBOOK_ASSERT(step.information.rows() == sums.cols());  // as in `at`: it was factored before
    const bool whole = take_step(step, model, point);
    // With a large effect a full step of poses and landmarks goes too far. They are then refitted
    // from their old values at the new size.
    const bool too_far = !whole || !(system_->settle_points(point) <= kNoRise * step.here);
    if (too_far) {
      point.state = std::move(from);
      static_cast<void>(system_->adjust(point, fit_.noise));
    }
    model.state = std::make_shared<FittedViews>(point.state);
    model.information = marginal_information(step.information, sizes.cols());
    model.log_likelihood = -0.5 * step.squares;
    const double moved =  // in standard errors
        step.size.cwiseProduct(step.information.diagonal().cwiseSqrt()).lpNorm<Eigen::Infinity>();
    // Line steps can predict a gain that does not come true, where the path of a wheel bends at the
    // line.
    const bool in_vain = lines.cols() > 0 && step.here > before - kWorthAStep;
    before = too_far ? std::numeric_limits<double>::infinity() : step.here;
    if ((moved < 0.05 || in_vain) && !too_far) break;
  }
}

std::vector<NoiseCause> ViewProblem::noise_causes(const CauseModel& model) const {
  return view_noise_causes(fit_, at(model), accepted_sums(model));
}

std::vector<Candidate> ViewProblem::variations(const CauseModel& /*model*/,
                                               const Candidate& name) const {
  return wheel_variations(name);
}

std::string ViewProblem::note(const Accepted& cause) const {
  if (cause.candidate.kind != CandidateKind::kPlace) return {};
  return hinge_note(line_of(cause.candidate));
}

EvidencePlot ViewProblem::evidence(const CauseModel& nominal,
                                   const CauseModel& extended,
                                   const Candidate& cause) const {
  const Eigen::MatrixXd sums = sums_of(cause);
  const ViewResiduals before = view_residuals(at(nominal), sums.rowwise().sum());
  const ViewResiduals after = view_residuals(at(extended), sums.rowwise().sum());
  return view_evidence(fit_.data, channels(), cause, before, after);
}

}  // namespace roadbook
