#include "diagnosis/detector/foot_position_problem.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "diagnosis/inference/linear_fit.hpp"

namespace roadbook {
namespace {

using Eigen::Index;

constexpr std::size_t kFewestSightings = 5;  // least number for a usable pedestrian
constexpr std::size_t kFewestPeople = 3;

}  // namespace

FootPositionProblem::FootPositionProblem(const SightingReadings& readings,
                                         const std::vector<PersonTrack>& tracks,
                                         LibraryOptions library)
    : library_(std::move(library)) {
  for (const PersonTrack& track : tracks) {
    if (track.sightings.size() < kFewestSightings) continue;
    std::vector<PlacedFeet> seen;
    for (const std::size_t s : track.sightings) {
      const Sighting& one = readings.sightings[s];
      seen.push_back({one.t_s, one.foot, one.covariance});
    }
    // Ranges from positions smoothed along the best straight path: detected ranges share the noise
    // of the positions, and so do smoothed curved paths.
    const std::vector<Eigen::Vector2d> feet = smoothed_feet(seen);
    const std::vector<Eigen::Vector2d> straight = smoothed_feet(seen, {1.0, 60.0, 0.0});
    people_.push_back({places_.size(), feet.size(), false});
    for (std::size_t i = 0; i < feet.size(); ++i) {
      const Sighting& one = readings.sightings[track.sightings[i]];
      const DetectorFrame& look = readings.looks[one.look];
      const Eigen::Vector2d u = (feet[i] - one.eye).normalized();
      const Eigen::Vector2d w(-u.y(), u.x());
      const Eigen::Vector2d arm = feet[i] - Eigen::Vector2d(look.x, look.y);
      const Eigen::Vector2d moved =
          look.speed * Eigen::Vector2d(std::cos(look.heading), std::sin(look.heading)) +
          look.yaw_rate * Eigen::Vector2d(-arm.y(), arm.x());
      places_.push_back({one.foot, u, std::sqrt(u.dot(one.covariance * u)),
                         std::sqrt(w.dot(one.covariance * w)), moved, one.eye});
      moments_.push_back(detection_context(look, one.eye, straight[i]));
    }
  }
  if (people_.size() < kFewestPeople)
    message_ = "foot positions of the detector not diagnosed: " + std::to_string(people_.size()) +
               " people were tracked over at least " + std::to_string(kFewestSightings) +
               " detections each, want at least " + std::to_string(kFewestPeople) + " people";
  else {
    estimate_noise();
    aim();
    estimate_noise();
  }
}

std::vector<ChannelName> FootPositionProblem::channels() const {
  return {{"detector", "feet along the line of sight"}, {"detector", "feet across it"}};
}

Eigen::VectorXd FootPositionProblem::readings() const {
  Eigen::VectorXd y(static_cast<Index>(rows()));
  for (const Person& person : people_)
    for (std::size_t i = person.first; i < person.first + person.count; ++i) {
      const Place& p = places_[i];
      const Eigen::Vector2d d = p.foot - places_[person.first].foot;
      y[static_cast<Index>(2 * i)] = p.along.dot(d);
      y[static_cast<Index>(2 * i + 1)] = p.along.x() * d.y() - p.along.y() * d.x();
    }
  return y;
}

double FootPositionProblem::whiten(const Person& person,
                                   const Noise& noise,
                                   Eigen::MatrixXd& sides,
                                   std::vector<double>* variances) const {
  constexpr double kAnywhere = 1e6;  // [m^2]
  const PersonMotion motion{person.stands ? 0.0 : kWalking, noise.memory_s, noise.shift};
  Eigen::Matrix4d P = Eigen::Vector4d(kAnywhere, kAnywhere, motion.speed * motion.speed,
                                      motion.speed * motion.speed)
                          .asDiagonal();
  Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(4, sides.cols());
  double log_determinant = 0.0;
  for (std::size_t i = person.first; i < person.first + person.count; ++i) {
    const Place& p = places_[i];
    if (i > person.first) {
      Eigen::Matrix4d F;
      Eigen::Matrix4d Q;
      PersonFilter::step(motion, moments_[i].t_s - moments_[i - 1].t_s, F, Q);
      mean = (F * mean).eval();
      P = (F * P * F.transpose() + Q).eval();
    }
    for (int across = 0; across < 2; ++across) {
      const auto row = static_cast<Index>(2 * i) + across;
      Eigen::Vector4d h = Eigen::Vector4d::Zero();
      h.head<2>() = across == 0 ? p.along : Eigen::Vector2d(-p.along.y(), p.along.x());
      const double sigma =
          across == 0 ? noise.along * p.sigma_along : noise.across * p.sigma_across;
      const Eigen::Vector4d gain = P * h;
      const double S = h.dot(gain) + sigma * sigma;
      const Eigen::RowVectorXd surprise = sides.row(row) - h.transpose() * mean;
      mean.noalias() += gain * surprise / S;
      P.noalias() -= gain * gain.transpose() / S;
      sides.row(row) = surprise / std::sqrt(S);
      if (i == person.first) sides.row(row).setZero();
      if (i > person.first) log_determinant += std::log(S);
      if (variances != nullptr) (*variances)[static_cast<std::size_t>(row)] = S / (sigma * sigma);
    }
  }
  return log_determinant;
}

Innovations FootPositionProblem::whitened(Eigen::MatrixXd sides) const {
  Innovations result;
  result.sides = static_cast<std::size_t>(sides.cols());
  std::vector<double> variances(rows(), 1.0);
  for (const Person& person : people_) (void)whiten(person, noise_, sides, &variances);
  for (const Person& person : people_)
    for (std::size_t row = 2 * (person.first + 1); row < 2 * (person.first + person.count); ++row) {
      const Eigen::RowVectorXd values = sides.row(static_cast<Index>(row)) / std::sqrt(dispersion_);
      result.of.push_back({row, row % 2, moments_[row / 2].t_s, variances[row]});
      result.values.insert(result.values.end(), values.data(), values.data() + values.size());
    }
  return result;
}

CauseModel FootPositionProblem::nominal() const {
  CauseModel model;
  model.state = std::make_shared<CauseState>();
  fit(model, 1);
  return model;
}

std::vector<Candidate> FootPositionProblem::candidates(const CauseModel& model) const {
  std::vector<Candidate> all;
  if (library_.named) all.push_back(detector_effect(kName));
  if (library_.grammar) {
    for (const char* covariate : {"constant", "range", "bearing", "speed", "turn rate", "time"})
      for (const char* hook : {"detector.along", "detector.across"})
        all.push_back(detector_term(hook, covariate, "m", 0.2));
    // Once the catalogued effect is accepted, it is the mean along the line of sight.
    const bool named = std::any_of(model.accepted.begin(), model.accepted.end(),
                                   [](const Accepted& a) { return a.candidate.name == kName; });
    for (Candidate& c : all)
      if (c.kind == CandidateKind::kGrammar) {
        c.has_mean = c.covariate != "constant" && !(named && c.hook == "detector.along");
        if (c.hook == "detector.along") c.named_mean = kName;
      }
    all.push_back(detector_term("detector.time", "constant", "s", 0.1));
  }
  std::erase_if(all, [&](const Candidate& c) {
    return std::find(library_.without.begin(), library_.without.end(), c.name) !=
           library_.without.end();
  });
  return all;
}

Eigen::MatrixXd FootPositionProblem::columns(const Candidate& candidate) const {
  const auto n = static_cast<Index>(rows());
  if (candidate.hook == "detector.time") {
    Eigen::MatrixXd X(n, 1);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const Place& p = places_[i];
      X(static_cast<Index>(2 * i), 0) = p.along.dot(p.by_time);
      X(static_cast<Index>(2 * i + 1), 0) =
          p.along.x() * p.by_time.y() - p.along.y() * p.by_time.x();
    }
    return X;
  }
  const bool named = candidate.kind == CandidateKind::kNamed;
  Eigen::MatrixXd terms = detector_terms(moments_, named ? "constant" : candidate.covariate);
  if (terms.isZero(0.0)) return Eigen::MatrixXd::Zero(n, terms.cols());
  if (!named && candidate.has_mean) {
    terms.conservativeResize(Eigen::NoChange, terms.cols() + 1);
    terms.rightCols(1).setOnes();
  }
  const Index across = candidate.hook == "detector.across" ? 1 : 0;
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(n, terms.cols());
  for (Index i = 0; i < terms.rows(); ++i) X.row(2 * i + across) = terms.row(i);
  return X;
}

Projection FootPositionProblem::project(const CauseModel& model,
                                        std::vector<Candidate> candidates) const {
  return linear_projection(
      model, std::move(candidates), readings(), [&](const Candidate& c) { return columns(c); },
      [&](const Eigen::MatrixXd& sides) { return whitened(sides); });
}

void FootPositionProblem::fit(CauseModel& model, int iterations) const {
  fit_beside(model, iterations, {});
}

void FootPositionProblem::fit_beside(CauseModel& model,
                                     int /*iterations*/,
                                     const SizePrior& others) const {
  linear_fit(project(model, {}), model, others);
}

std::string FootPositionProblem::note(const Accepted& /*cause*/) const {
  const auto standing =
      std::count_if(people_.begin(), people_.end(), [](const Person& p) { return p.stands; });
  char text[160];
  std::snprintf(text, sizeof text, "%zu people tracked, %td of them standing still", people_.size(),
                standing);
  return text;
}

RowCovariate FootPositionProblem::covariate(const CauseModel& /*model*/,
                                            const Candidate& cause,
                                            const Innovations& innovations) const {
  const bool named = cause.kind == CandidateKind::kNamed || cause.covariate == "constant";
  // A constant bias along the line of sight is visible as the line turns: it points ahead first and
  // back later. Therefore it is plotted over bearing.
  const std::string what = named ? "bearing" : cause.covariate;
  RowCovariate result{what == "bearing" ? "bearing [rad]"
                      : what == "range" ? "range [m]"
                                        : what,
                      {}};
  const std::vector<double> values = detector_covariate(moments_, what);
  for (const Innovation& i : innovations.of) result.values.push_back(values[i.row / 2]);
  return result;
}

}  // namespace roadbook
