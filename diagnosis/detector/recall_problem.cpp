#include "diagnosis/detector/recall_problem.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/numerics/sequential_projection.hpp"

namespace roadbook {
namespace {

using Eigen::Index;

constexpr const char* kRangeEffect = "detector.range";
constexpr std::size_t kNearPlaces = kTrackGap / 2;  // frames on either side
constexpr std::size_t kFewestOthers = 3;            // detections besides the trial itself
constexpr std::size_t kFewestLooks = 50;
constexpr std::size_t kFewestMissed = 5;
constexpr double kPlacesApart = 1.5;  // [m]
constexpr double kInterceptVariance = 25.0;

double chance(double log_odds) { return 1.0 / (1.0 + std::exp(-log_odds)); }

// Log likelihood of the outcomes `y` (0, 1) at log odds `eta`.
double bernoulli(const Eigen::VectorXd& eta, const Eigen::VectorXd& y) {
  double sum = 0.0;
  for (Index i = 0; i < eta.size(); ++i)
    sum += y[i] * eta[i] - std::max(eta[i], 0.0) - std::log1p(std::exp(-std::abs(eta[i])));
  return sum;
}

}  // namespace

struct RecallProblem::State final : CauseState {
  double intercept = 0.0;
};

RecallProblem::RecallProblem(const SightingReadings& readings,
                             const std::vector<PersonTrack>& tracks,
                             LibraryOptions library,
                             double known)
    : library_(std::move(library)), known_(known) {
  if (!readings.frames_known) {
    message_ =
        "missed detections of the detector not diagnosed: looks.csv (the times at which the "
        "detector searched) is missing or empty";
    return;
  }
  for (std::size_t p = 0; p < tracks.size(); ++p) collect(readings, tracks, p);
  const auto missed = static_cast<std::size_t>(std::count(found_.begin(), found_.end(), false));
  if (found_.size() < kFewestLooks || missed < kFewestMissed) {
    message_ = "missed detections of the detector not diagnosed: " + std::to_string(found_.size()) +
               " images searched for a person who was detected before and after, " +
               std::to_string(missed) + " of them without a detection; want at least " +
               std::to_string(kFewestLooks) + " and " + std::to_string(kFewestMissed);
    return;
  }
  dispersion_ = over_dispersion();
}

void RecallProblem::collect(const SightingReadings& readings,
                            const std::vector<PersonTrack>& tracks,
                            std::size_t person) {
  const auto& s = tracks[person].sightings;
  const auto look_of = [&](std::size_t i) { return readings.sightings[s[i]].look; };
  std::size_t next = 0;  // first detection in or after the frame
  for (std::size_t look = look_of(0) + 1; look < look_of(s.size() - 1); ++look) {
    while (look_of(next) < look) ++next;
    const bool found = look_of(next) == look;
    const std::size_t after = found ? next + 1 : next;
    if (s.size() - (found ? 1 : 0) < kFewestOthers) continue;
    const Sighting& a = readings.sightings[s[next - 1]];
    const Sighting& b = readings.sightings[s[after]];
    if (look - a.look > kNearPlaces || b.look - look > kNearPlaces) continue;
    // Position by the other detections, whether or not this frame has one.
    const DetectorFrame& at = readings.looks[look];
    const double part = (at.t_s - a.t_s) / (b.t_s - a.t_s);
    const Eigen::Vector2d place = a.foot + part * (b.foot - a.foot);
    if (!readings.in_sight(look, place)) continue;
    // With two pedestrians close together the detected one is unknown; one pedestrian may also have
    // two tracks.
    const bool alone = std::none_of(tracks.begin(), tracks.end(), [&](const PersonTrack& other) {
      if (&other == &tracks[person]) return false;
      const auto there = place_at(readings, other, look);
      return there && (*there - place).norm() < kPlacesApart;
    });
    if (!alone) continue;
    found_.push_back(found);
    // The nearer of the cameras of the detections before and after.
    const Eigen::Vector2d eye_a = readings.eye_at(look, a.mount);
    const Eigen::Vector2d eye_b = readings.eye_at(look, b.mount);
    const bool first = (place - eye_a).norm() <= (place - eye_b).norm();
    moments_.push_back(detection_context(at, first ? eye_a : eye_b, place));
    person_.push_back(person);
  }
}

double RecallProblem::found_share() const {
  return static_cast<double>(std::count(found_.begin(), found_.end(), true)) /
         static_cast<double>(found_.size());
}

// Variance inflation between pedestrians, with the effect of range fitted: the scatter of their
// scores over that of independent trials.
double RecallProblem::over_dispersion() const {
  CauseModel model = nominal();
  Candidate range = detector_effect(kRangeEffect);
  range.columns = {0};
  accept(model, range);
  fit(model, 10);
  const Eigen::VectorXd eta = log_odds(model);
  Eigen::VectorXd w(eta.size());
  for (Index i = 0; i < eta.size(); ++i) w[i] = chance(eta[i]) * (1.0 - chance(eta[i]));
  Eigen::VectorXd x = columns(range).col(0);
  x.array() -= w.dot(x) / w.sum();
  std::map<std::size_t, double> score;
  double expected = 0.0;
  for (Index i = 0; i < eta.size(); ++i) {
    const auto row = static_cast<std::size_t>(i);
    score[person_[row]] += x[i] * ((found_[row] ? 1.0 : 0.0) - chance(eta[i]));
    expected += w[i] * x[i] * x[i];
  }
  double seen = 0.0;
  for (const auto& [person, s] : score) seen += s * s;
  return std::max(1.0, seen / std::max(expected, 1e-12));
}

std::vector<ChannelName> RecallProblem::channels() const { return {{"detector", "found"}}; }

CauseModel RecallProblem::nominal() const {
  CauseModel model;
  auto state = std::make_shared<State>();
  const double share = std::clamp(found_share(), 1e-3, 1.0 - 1e-3);
  state->intercept = std::log(share / (1.0 - share));
  model.state = state;
  fit(model, 10);
  return model;
}

std::vector<Candidate> RecallProblem::candidates(const CauseModel& /*model*/) const {
  std::vector<Candidate> all;
  if (library_.named) all.push_back(detector_effect(kRangeEffect));
  if (library_.grammar)
    for (const char* covariate : {"range", "bearing", "speed", "turn rate", "time"})
      all.push_back(detector_term("detector.found", covariate, "1", 0.5));
  std::erase_if(all, [&](const Candidate& c) {
    return std::find(library_.without.begin(), library_.without.end(), c.name) !=
           library_.without.end();
  });
  return all;
}

Eigen::MatrixXd RecallProblem::columns(const Candidate& candidate) const {
  if (candidate.kind != CandidateKind::kNamed) return detector_terms(moments_, candidate.covariate);
  Eigen::MatrixXd X(static_cast<Index>(rows()), 1);
  for (std::size_t i = 0; i < rows(); ++i) X(static_cast<Index>(i), 0) = -moments_[i].range_m;
  return X;
}

Eigen::VectorXd RecallProblem::known_part() const {
  Eigen::VectorXd part(static_cast<Index>(rows()));
  for (std::size_t i = 0; i < rows(); ++i)
    part[static_cast<Index>(i)] = -known_ * moments_[i].range_m;
  return part;
}

Eigen::VectorXd RecallProblem::log_odds(const CauseModel& model) const {
  const auto& state = static_cast<const State&>(*model.state);
  Eigen::VectorXd eta = known_part().array() + state.intercept;
  for (const Accepted& a : model.accepted) eta += columns(a.candidate) * a.size;
  return eta;
}

// Rows are Pearson residuals; columns are derivatives of the log odds with the same weights. Their
// products are score and information of the logistic model.
Projection RecallProblem::project(const CauseModel& model,
                                  std::vector<Candidate> candidates) const {
  Projection p;
  std::vector<Eigen::MatrixXd> parts;
  for (const Accepted& a : model.accepted) {
    parts.push_back(columns(a.candidate));
    p.accepted += static_cast<std::size_t>(parts.back().cols());
  }
  std::size_t next = p.accepted;
  for (Candidate& c : candidates) {
    Eigen::MatrixXd own = columns(c);
    if (own.isZero(0.0)) continue;
    c.columns.clear();
    for (Index k = 0; k < own.cols(); ++k) c.columns.push_back(next++);
    p.candidates.push_back(c);
    parts.push_back(std::move(own));
  }
  const Eigen::VectorXd eta = log_odds(model);
  Innovations& in = p.innovations;
  in.sides = 1 + next;
  SequentialProjection projection(Eigen::VectorXd::Constant(1, kInterceptVariance),
                                  static_cast<Index>(in.sides));
  Eigen::RowVectorXd row(static_cast<Index>(in.sides));
  for (std::size_t i = 0; i < rows(); ++i) {
    const auto at = static_cast<Index>(i);
    const double probability = chance(eta[at]);
    const double variance = dispersion_ * probability * (1.0 - probability);
    const double weight = std::sqrt(variance) / dispersion_;
    row[0] = ((found_[i] ? 1.0 : 0.0) - probability) / std::sqrt(variance);
    Index column = 1;
    for (const Eigen::MatrixXd& part : parts)
      for (Index k = 0; k < part.cols(); ++k) row[column++] = weight * part(at, k);
    const double scale = projection.next(Eigen::VectorXd::Constant(1, weight), row);
    in.of.push_back({i, 0, moments_[i].t_s, scale});
    in.values.insert(in.values.end(), row.data(), row.data() + row.size());
  }
  return p;
}

void RecallProblem::fit(CauseModel& model, int iterations) const {
  fit_beside(model, iterations, {});
}

void RecallProblem::fit_beside(CauseModel& model, int iterations, const SizePrior& others) const {
  auto state = std::make_shared<State>(static_cast<const State&>(*model.state));
  Eigen::MatrixXd X = Eigen::MatrixXd::Ones(static_cast<Index>(rows()), 1);
  Eigen::VectorXd size = Eigen::VectorXd::Constant(1, state->intercept);
  for (const Accepted& a : model.accepted) {
    const Eigen::MatrixXd own = columns(a.candidate);
    X.conservativeResize(Eigen::NoChange, X.cols() + own.cols());
    X.rightCols(own.cols()) = own;
    size.conservativeResize(size.size() + a.size.size());
    size.tail(a.size.size()) = a.size;
  }
  Eigen::VectorXd y(static_cast<Index>(rows()));
  for (std::size_t i = 0; i < rows(); ++i) y[static_cast<Index>(i)] = found_[i] ? 1.0 : 0.0;
  const Eigen::VectorXd known = known_part();
  const auto likelihood = [&](const Eigen::VectorXd& b) {
    return bernoulli(known + X * b, y) / dispersion_ - 0.5 * b[0] * b[0] / kInterceptVariance;
  };
  const auto with_others = [&](const Eigen::VectorXd& b) {
    if (others.empty()) return likelihood(b);
    const Eigen::VectorXd x = b.tail(b.size() - 1);
    return likelihood(b) + x.dot(others.weighted - 0.5 * others.information * x);
  };
  Eigen::MatrixXd F;
  double best = with_others(size);
  for (int iteration = 0; iteration < std::max(iterations, 6); ++iteration) {
    const Eigen::VectorXd p = (known + X * size).unaryExpr(&chance);
    const Eigen::VectorXd w = p.array() * (1.0 - p.array());
    F = X.transpose() * w.asDiagonal() * X;
    F(0, 0) += dispersion_ / kInterceptVariance;
    Eigen::VectorXd u = X.transpose() * (y - p);
    u[0] -= dispersion_ / kInterceptVariance * size[0];
    F.diagonal() *= 1.0 + 1e-10;
    Eigen::MatrixXd held = F;
    if (!others.empty()) {
      const Index n = size.size() - 1;
      held.bottomRightCorner(n, n) += dispersion_ * others.information;
      u.tail(n) += dispersion_ * others.score(size.tail(n));
    }
    Eigen::VectorXd step = held.ldlt().solve(u);
    // Step halving: far from the maximum a Newton step may be too long.
    for (int k = 0; k < 8 && !(with_others(size + step) >= best); ++k) step *= 0.5;
    if (!(with_others(size + step) >= best)) break;
    size += step;
    best = with_others(size);
    if (step.norm() < 1e-9) break;
  }
  state->intercept = size[0];
  Index at = 1;
  for (Accepted& a : model.accepted) {
    a.size = size.segment(at, a.size.size());
    at += a.size.size();
  }
  const Index n = size.size() - 1;
  const Eigen::VectorXd cross = F.col(0).tail(n);
  model.information =
      (F.bottomRightCorner(n, n) - cross * cross.transpose() / F(0, 0)) / dispersion_;
  model.log_likelihood = likelihood(size);
  model.state = state;
}

RowCovariate RecallProblem::covariate(const CauseModel& /*model*/,
                                      const Candidate& cause,
                                      const Innovations& innovations) const {
  const std::string what = cause.kind == CandidateKind::kNamed ? "range" : cause.covariate;
  RowCovariate result{what == "range" ? "range [m]" : what, {}};
  const std::vector<double> values = detector_covariate(moments_, what);
  for (const Innovation& i : innovations.of) result.values.push_back(values[i.row]);
  return result;
}

}  // namespace roadbook
