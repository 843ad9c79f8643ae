#include "diagnosis/detector/detector_grammar.hpp"

#include <cmath>

#include "base/error.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

using Eigen::Index;

DetectionContext detection_context(const DetectorFrame& look,
                                   const Eigen::Vector2d& eye,
                                   const Eigen::Vector2d& foot) {
  const Eigen::Vector2d to = foot - eye;
  const double bearing = std::atan2(to.y(), to.x()) - look.heading;
  return {look.t_s, to.norm(), std::remainder(bearing, 2.0 * M_PI), look.speed, look.yaw_rate};
}

Candidate detector_effect(const std::string& name) {
  for (const EffectInfo& e : reading_effects()) {
    if (e.name != name) continue;
    Candidate c;
    c.name = e.name;
    c.unit = e.unit;
    c.tau = e.plausible;
    c.lowest = e.lowest;
    c.highest = e.highest;
    return c;
  }
  ROADBOOK_ASSERT(!"a declared effect");
}

Candidate detector_term(const std::string& hook,
                        const std::string& covariate,
                        const std::string& unit,
                        double tau) {
  Candidate c;
  c.kind = CandidateKind::kGrammar;
  c.hook = hook;
  c.covariate = covariate;
  c.name = hook + " ~ " + covariate;
  c.unit = unit;
  c.tau = tau;
  c.penalty = 2.0;
  return c;
}

std::vector<double> detector_covariate(const std::vector<DetectionContext>& moments,
                                       const std::string& covariate) {
  std::vector<double> values;
  for (const DetectionContext& m : moments) {
    if (covariate == "range")
      values.push_back(m.range_m);
    else if (covariate == "bearing")
      values.push_back(m.bearing_rad);
    else if (covariate == "speed")
      values.push_back(m.speed);
    else if (covariate == "turn rate")
      values.push_back(m.yaw_rate);
    else
      values.push_back(m.t_s);
  }
  return values;
}

Eigen::MatrixXd detector_terms(const std::vector<DetectionContext>& moments,
                               const std::string& covariate) {
  const auto n = static_cast<Index>(moments.size());
  if (covariate == "constant") return Eigen::MatrixXd::Ones(n, 1);
  const std::vector<double> values = detector_covariate(moments, covariate);
  const Eigen::Map<const Eigen::VectorXd> v(values.data(), n);
  Eigen::MatrixXd X = Eigen::MatrixXd::Zero(n, 2);
  if (covariate == "bearing") {
    X.col(0) = v.array().cos();
    X.col(1) = v.array().sin();
    X.rowwise() -= X.colwise().mean();
    return X;
  }
  if (n < 3) return X;
  const double mean = v.mean();
  const double sd = std::sqrt((v.array() - mean).square().mean());
  if (!(sd > 1e-6 * (1.0 + std::abs(mean)))) return X;
  X.col(0) = (v.array() - mean) / sd;
  X.col(1) = X.col(0).array().square() - 1.0;
  return X;
}

}  // namespace roadbook
