#include "diagnosis/friction/friction_columns.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.hpp"
#include "base/gravity.hpp"
#include "diagnosis/inference/logged_term.hpp"
#include "sensors/effects.hpp"
#include "sensors/friction.hpp"

namespace roadbook {
namespace {

struct Named {
  const char* name;
  double FrictionImperfections<double>::*size;
};
constexpr std::array kNamedFriction{
    Named{"friction0.slip_bias", &FrictionImperfections<double>::slip_bias},
    Named{"friction0.speed_bias", &FrictionImperfections<double>::speed_bias},
    Named{"friction0.drying", &FrictionImperfections<double>::drying},
    Named{"friction0.temperature", &FrictionImperfections<double>::temperature},
};

constexpr std::array kCovariates{"speed",           "acceleration", "lateral acceleration",
                                 "friction in use", "time",         "temperature",
                                 "heading"};

const EffectInfo& declared(const std::string& name) {
  for (const EffectInfo& e : reading_effects())
    if (e.name == name) return e;
  ROADBOOK_ASSERT(!"a declared effect");
}

FrictionMoment moment(const FrictionSample& s, double start_s) {
  FrictionMoment at;
  at.in_use = std::hypot(s.acceleration, s.lateral_acceleration) / kGravity;
  at.speed = s.speed;
  at.elapsed_s = s.t_s - start_s;
  at.above_reference = s.temperature_c - kFrictionReference;
  at.wet = s.surface == kWaterSurface;
  return at;
}

// Standardised to mean 0 and variance 1 over the rows where `mask` is 1; 0 if it hardly varies.
Eigen::VectorXd standardised(const Eigen::VectorXd& values, const Eigen::VectorXd& mask) {
  const double n = std::max(mask.sum(), 1.0);
  const double mean = mask.dot(values) / n;
  const Eigen::VectorXd centred = (values.array() - mean).matrix().cwiseProduct(mask);
  const double sd = std::sqrt(centred.squaredNorm() / n);
  if (!(sd > 1e-9 * (1.0 + std::abs(mean)))) return Eigen::VectorXd::Zero(values.size());
  return centred / sd;
}

Candidate friction_term(const char* hook, const std::string& covariate) {
  Candidate c;
  c.kind = CandidateKind::kGrammar;
  c.hook = hook;
  c.covariate = covariate;
  c.name = c.hook + " ~ " + c.covariate;
  c.unit = "1";
  c.tau = 0.05;
  c.penalty = kGrammarPenalty;
  return c;
}

Eigen::MatrixXd friction_column_terms(const ColumnCovariate& column,
                                      const std::vector<FrictionSample>& samples,
                                      const Eigen::VectorXd& mask) {
  Eigen::MatrixXd terms(mask.size(), static_cast<Eigen::Index>(column.terms()));
  for (Eigen::Index i = 0; i < terms.rows(); ++i) {
    const auto values = column.terms_at(samples[static_cast<std::size_t>(i)].t_s);
    for (Eigen::Index k = 0; k < terms.cols(); ++k)
      terms(i, k) = mask[i] * values[static_cast<std::size_t>(k)];
  }
  return terms;
}

}  // namespace

SurfaceClasses surface_classes(const std::vector<FrictionSample>& samples) {
  SurfaceClasses classes;
  for (const FrictionSample& s : samples) classes.labels.push_back(s.surface);
  std::sort(classes.labels.begin(), classes.labels.end());
  classes.labels.erase(std::unique(classes.labels.begin(), classes.labels.end()),
                       classes.labels.end());
  for (const FrictionSample& s : samples)
    classes.of.push_back(static_cast<std::size_t>(
        std::lower_bound(classes.labels.begin(), classes.labels.end(), s.surface) -
        classes.labels.begin()));
  return classes;
}

std::vector<Candidate> friction_effects(const FrictionReadings& readings) {
  std::vector<Candidate> candidates;
  for (std::size_t i = 0; i < kNamedFriction.size(); ++i) {
    const EffectInfo& info = declared(kNamedFriction[i].name);
    if (info.covariate == "temperature" && !readings.has_temperature) continue;
    // Only a label says whether the ground is wet.
    if (info.name == "friction0.drying" && !readings.has_surface) continue;
    Candidate c;
    c.name = info.name;
    c.unit = info.unit;
    c.effect = i;
    c.tau = info.plausible;
    candidates.push_back(c);
  }
  return candidates;
}

void take_off_friction(const EffectSizes& sizes, FrictionReadings& readings) {
  FrictionImperfections<double> off;
  for (const Named& named : kNamedFriction)
    if (const auto size = sizes.find(named.name); size != sizes.end())
      off.*named.size = size->second;
  for (FrictionSample& s : readings.samples)
    s.friction -= predict_friction(off, 0.0, moment(s, readings.samples.front().t_s));
}

std::vector<Candidate> friction_grammar(const FrictionReadings& readings,
                                        const SurfaceClasses& classes) {
  std::vector<Candidate> candidates;
  const bool wet = std::binary_search(classes.labels.begin(), classes.labels.end(), kWaterSurface);
  for (const char* hook : {"friction0.bias", "friction0.wet_bias"}) {
    if (std::string_view(hook) == "friction0.wet_bias" && (!wet || classes.labels.size() < 2))
      continue;
    for (const char* covariate : kCovariates) {
      if (std::string_view(covariate) == "temperature" && !readings.has_temperature) continue;
      candidates.push_back(friction_term(hook, covariate));
    }
    for (const ColumnCovariate& column : readings.columns)
      candidates.push_back(logged_term(friction_term(hook, column.name())));
  }
  return candidates;
}

bool is_friction_covariate(std::string_view name) {
  return std::find(kCovariates.begin(), kCovariates.end(), name) != kCovariates.end();
}

Eigen::VectorXd friction_covariate(const std::vector<FrictionSample>& samples,
                                   const std::string& name) {
  Eigen::VectorXd values(static_cast<Eigen::Index>(samples.size()));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const FrictionSample& s = samples[i];
    double& v = values[static_cast<Eigen::Index>(i)];
    if (name == "speed")
      v = s.speed;
    else if (name == "acceleration")
      v = s.acceleration;
    else if (name == "lateral acceleration")
      v = s.lateral_acceleration;
    else if (name == "friction in use")
      v = std::hypot(s.acceleration, s.lateral_acceleration) / kGravity;
    else if (name == "temperature")
      v = s.temperature_c;
    else if (name == "heading")
      v = s.heading;
    else
      v = s.t_s - samples.front().t_s;
  }
  return values;
}

Eigen::MatrixXd friction_columns(const FrictionReadings& readings,
                                 const SurfaceClasses& classes,
                                 const Candidate& candidate) {
  const auto& samples = readings.samples;
  const auto n = static_cast<Eigen::Index>(samples.size());
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(n, 1);
  if (candidate.kind == CandidateKind::kNamed) {
    FrictionImperfections<double> off;
    off.*kNamedFriction[candidate.effect].size = 1.0;
    for (Eigen::Index i = 0; i < n; ++i)
      columns(i, 0) = predict_friction(
          off, 0.0, moment(samples[static_cast<std::size_t>(i)], samples.front().t_s));
    return columns;
  }
  if (candidate.kind == CandidateKind::kPlace) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const FrictionSample& s = samples[static_cast<std::size_t>(i)];
      const bool inside =
          std::hypot(s.x - candidate.place_x, s.y - candidate.place_y) < candidate.place_radius;
      columns(i, 0) = inside && classes.of[static_cast<std::size_t>(i)] == candidate.effect;
    }
    return columns;
  }
  Eigen::VectorXd mask = Eigen::VectorXd::Ones(n);
  if (candidate.hook == "friction0.wet_bias")
    for (Eigen::Index i = 0; i < n; ++i)
      mask[i] = samples[static_cast<std::size_t>(i)].surface == kWaterSurface;
  for (const ColumnCovariate& column : readings.columns)
    if (column.name() == candidate.covariate) return friction_column_terms(column, samples, mask);
  const Eigen::VectorXd values = friction_covariate(samples, candidate.covariate);
  columns.resize(n, 2);
  if (candidate.covariate == "heading") {
    columns.col(0) = values.array().cos().matrix().cwiseProduct(mask);
    columns.col(1) = values.array().sin().matrix().cwiseProduct(mask);
    return columns;
  }
  columns.col(0) = standardised(values, mask);
  columns.col(1) = standardised(columns.col(0).cwiseAbs2(), mask);
  return columns;
}

}  // namespace roadbook
