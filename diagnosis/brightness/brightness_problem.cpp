#include "diagnosis/brightness/brightness_problem.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>

#include "base/index.hpp"
#include "sensors/brightness.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kFewestSamples = 200;
constexpr double kLook = 0.02;  // [log grey] standard deviation of viewpoint-dependent brightness
constexpr double kOutlierGate = 3.5;  // [sigma] with all candidates free
constexpr std::size_t kStride = 3;    // every third step is free in the search of outliers

// Subtracts the mean of each landmark. Samples of a landmark are contiguous.
void centre_landmarks(const std::vector<BrightnessSample>& samples, Eigen::MatrixXd& sides) {
  for (std::size_t begin = 0, end = 0; begin < samples.size(); begin = end) {
    while (end < samples.size() && samples[end].landmark == samples[begin].landmark) ++end;
    auto block = sides.middleRows(index(begin), index(end - begin));
    block.rowwise() -= block.colwise().mean().eval();
  }
}

std::size_t landmarks_in(const std::vector<BrightnessSample>& samples) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < samples.size(); ++i)
    count += i == 0 || samples[i].landmark != samples[i - 1].landmark ? 1 : 0;
  return count;
}

}  // namespace

BrightnessProblem::BrightnessProblem(std::vector<BrightnessSample> samples,
                                     std::vector<std::string> cameras,
                                     EffectSizes known,
                                     LibraryOptions library)
    : samples_(std::move(samples)),
      cameras_(std::move(cameras)),
      library_(std::move(library)),
      causes_(brightness_causes(cameras_, samples_)) {
  for (std::size_t c = 0; c < causes_.size(); ++c)
    if (const auto found = known.find(causes_[c].name);
        found != known.end() && causes_[c].kind != BrightnessKind::kStep)
      known_.emplace_back(c, found->second);
  if (!usable()) return;
  place_known_steps(known);
  take_out_outliers();
}

void BrightnessProblem::place_known_steps(const EffectSizes& known) {
  for (const auto& [name, size] : known) {
    std::optional<std::size_t> best;
    double least = std::numeric_limits<double>::max();
    for (std::size_t c = 0; c < causes_.size(); ++c) {
      if (causes_[c].name != name || causes_[c].kind != BrightnessKind::kStep) continue;
      Sizes with = known_;
      with.emplace_back(c, size);
      // Absolute values, because outliers are frequent.
      if (const double sum = sides(with, {}).col(0).lpNorm<1>(); sum < least) {
        least = sum;
        best = c;
      }
    }
    if (best) known_.emplace_back(*best, size);
  }
}

bool BrightnessProblem::usable() const { return samples_.size() >= kFewestSamples; }

bool BrightnessProblem::acts_on(const BrightnessCause& cause,
                                const BrightnessSample& sample) const {
  return (cause.camera < 0 || cause.camera == sample.camera) &&
         (cause.kind != BrightnessKind::kStep || sample.t_s >= cause.from_s);
}

Eigen::MatrixXd BrightnessProblem::sides(const Sizes& sizes,
                                         const std::vector<std::size_t>& causes) const {
  Eigen::MatrixXd sides(index(samples_.size()), index(1 + causes.size()));
  Eigen::MatrixXd distance(index(samples_.size()), 2);
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    const BrightnessSample& s = samples_[i];
    double exposure = 0.0, vignetting = 0.0, step = 0.0;
    for (const auto& [c, size] : sizes) {
      if (!acts_on(causes_[c], s)) continue;
      (causes_[c].kind == BrightnessKind::kStep       ? step
       : causes_[c].kind == BrightnessKind::kExposure ? exposure
                                                      : vignetting) += size;
    }
    exposure = std::max(-0.95, exposure);
    step = std::max(-0.95, step);
    // Keeps the brightness at the image corners above 0.
    const double r2 = s.radius * s.radius;
    vignetting = std::clamp(vignetting, -2.0, 0.95 / std::max(1.0, r2));
    sides(index(i), 0) = s.log_grey - std::log(grey_factor(exposure, vignetting, s.radius)) -
                         kGreyPerLight * std::log1p(step);
    for (std::size_t c = 0; c < causes.size(); ++c) {
      const BrightnessCause& cause = causes_[causes[c]];
      const double now = cause.kind == BrightnessKind::kExposure ? exposure : step;
      const double change = cause.kind == BrightnessKind::kVignetting
                                ? -r2 / (1.0 - vignetting * r2)
                                : 1.0 / (1.0 + now);
      sides(index(i), index(1 + c)) = acts_on(cause, s) ? kGreyPerLight * change : 0.0;
    }
    distance.row(index(i)) << s.log_distance, s.log_distance * s.log_distance;
  }
  centre_landmarks(samples_, sides);
  centre_landmarks(samples_, distance);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(distance);
  const Eigen::MatrixXd Q = qr.householderQ() * Eigen::MatrixXd::Identity(distance.rows(), 2);
  sides -= Q * (Q.transpose() * sides);
  return sides;
}

// The brightness of a place depends on the viewpoint, which may correlate with the image radius of
// a camera as vignetting does. The covariance of a camera's samples is therefore sigma^2 I + look^2
// B B^T, with the constant and r^2 of the camera in B. This function applies its inverse square
// root.
Eigen::MatrixXd BrightnessProblem::whitened(Eigen::MatrixXd sides) const {
  Eigen::MatrixXd B = Eigen::MatrixXd::Zero(sides.rows(), 2 * index(cameras_.size()));
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    B(index(i), 2 * samples_[i].camera) = 1.0;
    B(index(i), 2 * samples_[i].camera + 1) = samples_[i].radius * samples_[i].radius;
  }
  centre_landmarks(samples_, B);
  // Uses the eigenvalues of the small matrix B^T B, which are the nonzero ones of B B^T.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(B.transpose() * B);
  const Eigen::ArrayXd squares = eigen.eigenvalues().array().max(1e-12);
  const Eigen::ArrayXd less =
      (1.0 - (1.0 + squares * std::pow(kLook / sigma_, 2)).rsqrt()) / squares;
  const Eigen::MatrixXd BV = B * eigen.eigenvectors();
  sides -= BV * (less.matrix().asDiagonal() * (BV.transpose() * sides));
  return sides / sigma_;
}

// Outliers about a fit with all candidates free, regularised by their priors, so that effects are
// not removed as outliers.
void BrightnessProblem::take_out_outliers() {
  std::vector<std::size_t> all;
  for (std::size_t c = 0; c < causes_.size(); ++c)
    if (causes_[c].kind != BrightnessKind::kStep || c % kStride == 0) all.push_back(c);
  for (int round = 0; round < 3; ++round) {
    const Eigen::MatrixXd S = sides(known_, all);
    const Eigen::Index n = index(all.size());
    Eigen::MatrixXd F = S.rightCols(n).transpose() * S.rightCols(n);
    constexpr double kGuess = 0.1;  // [log grey] assumed noise, to weight the priors
    for (std::size_t c = 0; c < all.size(); ++c)
      F(index(c), index(c)) += kGuess * kGuess / std::pow(causes_[all[c]].tau, 2);
    const Eigen::VectorXd e =
        S.col(0) - S.rightCols(n) * F.ldlt().solve(S.rightCols(n).transpose() * S.col(0));
    std::vector<double> size(e.size());
    for (Eigen::Index i = 0; i < e.size(); ++i) size[static_cast<std::size_t>(i)] = std::abs(e[i]);
    const auto middle = size.begin() + static_cast<std::ptrdiff_t>(size.size() / 2);
    std::nth_element(size.begin(), middle, size.end());
    const double spread = std::max(1e-4, 1.4826 * *middle);
    std::vector<BrightnessSample> kept;
    double squares = 0.0;
    for (std::size_t i = 0; i < samples_.size(); ++i)
      if (std::abs(e[index(i)]) < kOutlierGate * spread) {
        kept.push_back(samples_[i]);
        squares += e[index(i)] * e[index(i)];
      }
    const std::size_t unknowns = landmarks_in(kept) + 2 + all.size();
    const double freedom =
        std::max(1.0, static_cast<double>(kept.size()) - static_cast<double>(unknowns));
    samples_ = std::move(kept);
    sigma_ = std::sqrt(squares / freedom);
  }
}

std::vector<ChannelName> BrightnessProblem::channels() const {
  std::vector<ChannelName> names;
  for (const std::string& camera : cameras_) names.push_back({camera, "brightness"});
  return names;
}

BrightnessProblem::Sizes BrightnessProblem::sizes_of(const CauseModel& model) const {
  Sizes sizes = known_;
  for (const Accepted& a : model.accepted) sizes.emplace_back(a.candidate.effect, a.size[0]);
  return sizes;
}

CauseModel BrightnessProblem::nominal() const {
  CauseModel model;
  model.log_likelihood = -0.5 * whitened(sides(known_, {})).col(0).squaredNorm();
  return model;
}

Candidate BrightnessProblem::candidate(std::size_t c) const {
  Candidate candidate;
  candidate.name = causes_[c].name;
  candidate.unit = causes_[c].unit;
  candidate.effect = c;
  candidate.tau = causes_[c].tau;
  if (causes_[c].kind != BrightnessKind::kStep) return candidate;
  candidate.kind = CandidateKind::kPlace;
  candidate.at_known = std::any_of(known_.begin(), known_.end(),
                                   [&](const auto& known) { return known.first == c; });
  const auto many =
      std::count_if(causes_.begin(), causes_.end(),
                    [&](const BrightnessCause& other) { return other.name == candidate.name; });
  candidate.penalty = std::log(static_cast<double>(many));
  return candidate;
}

std::vector<Candidate> BrightnessProblem::candidates(const CauseModel&) const {
  std::vector<Candidate> all;
  for (std::size_t c = 0; c < causes_.size(); ++c) {
    const auto& without = library_.without;
    if (std::find(without.begin(), without.end(), causes_[c].name) != without.end()) continue;
    all.push_back(candidate(c));
  }
  return all;
}

std::string BrightnessProblem::note(const Accepted& cause) const {
  const BrightnessCause& c = causes_[cause.candidate.effect];
  if (c.kind != BrightnessKind::kStep) return {};
  char text[60];
  std::snprintf(text, sizeof text, "from %.1f s on", c.from_s);
  return text;
}

Projection BrightnessProblem::project(const CauseModel& model,
                                      std::vector<Candidate> candidates) const {
  Projection p;
  p.accepted = model.accepted.size();
  std::vector<std::size_t> causes;
  for (const Accepted& a : model.accepted) causes.push_back(a.candidate.effect);
  for (Candidate& c : candidates) {
    c.columns = {causes.size()};
    causes.push_back(c.effect);
  }
  p.candidates = std::move(candidates);
  const Eigen::MatrixXd S = whitened(sides(sizes_of(model), causes));
  std::vector<std::size_t> order(samples_.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return samples_[a].t_s < samples_[b].t_s; });
  p.innovations.sides = 1 + causes.size();
  for (const std::size_t i : order) {
    p.innovations.of.push_back({i, at(samples_[i].camera), samples_[i].t_s, 1.0});
    for (Eigen::Index k = 0; k < S.cols(); ++k) p.innovations.values.push_back(S(index(i), k));
  }
  return p;
}

void BrightnessProblem::fit(CauseModel& model, int iterations) const {
  std::vector<std::size_t> causes;
  for (const Accepted& a : model.accepted) causes.push_back(a.candidate.effect);
  const Eigen::Index n = index(causes.size());
  for (int i = 0; i < iterations; ++i) {
    const Eigen::MatrixXd S = whitened(sides(sizes_of(model), causes));
    model.information = S.rightCols(n).transpose() * S.rightCols(n);
    Eigen::MatrixXd F = model.information;
    F.diagonal().array() += 1e-9;
    const Eigen::VectorXd u = S.rightCols(n).transpose() * S.col(0);
    const Eigen::VectorXd step = F.ldlt().solve(u);
    for (Eigen::Index k = 0; k < n; ++k)
      model.accepted[static_cast<std::size_t>(k)].size[0] += step[k];
    model.log_likelihood = -0.5 * (S.col(0).squaredNorm() - u.dot(step));
  }
}

RowCovariate BrightnessProblem::covariate(const CauseModel&,
                                          const Candidate&,
                                          const Innovations& innovations) const {
  RowCovariate radius{"image radius [half widths]", {}};
  for (const Innovation& i : innovations.of) radius.values.push_back(samples_[i.row].radius);
  return radius;
}

}  // namespace roadbook
