#include "diagnosis/motion/motion_library.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/inference/logged_term.hpp"
#include "diagnosis/motion/effect_columns.hpp"
#include "diagnosis/motion/grammar.hpp"
#include "diagnosis/motion/wet_places.hpp"
#include "diagnosis/streams/wheel_rows.hpp"

namespace roadbook {
namespace {

constexpr const char* kConstant = "constant";

// A smooth function of a covariate has a mean.
bool has_constant(const Candidate& c) {
  return c.kind == CandidateKind::kGrammar && c.covariate != kConstant && c.has_mean;
}

// Builds the columns of candidates at one point; what several share is computed once.
class ColumnBuilder {
 public:
  ColumnBuilder(const Observations& obs, const MotionPoint& point)
      : obs_(obs), smooth_(smooth_point(point)), grammar_(obs, smooth_) {}

  // Of a function of a covariate without its mean.
  Columns column(const Candidate& c) {
    if (c.kind == CandidateKind::kNamed) return effect_column(obs_, smooth_, c.effect);
    if (c.kind == CandidateKind::kGrammar) return grammar_.columns({c.hook, c.covariate});
    if (wheels_.steps.empty()) wheels_ = WheelSteps(obs_, smooth_);
    return place_column(wheels_, c.place_x, c.place_y, c.place_radius);
  }
  Columns constant(const std::string& hook) { return grammar_.columns({hook, kConstant}); }

 private:
  static MotionPoint smooth_point(const MotionPoint& point) {
    return {smoothed(point.trajectory), point.effects, {}};
  }
  const Observations& obs_;
  MotionPoint smooth_;
  Grammar grammar_;
  WheelSteps wheels_;
};

// A wheelbase shows only through steering and a steered wheel.
bool shows_motion(const Observations& obs, const MotionEffect& effect) {
  if (!has_streams(obs, effect.streams) || !shows_effect(obs.wheels_read, effect.name))
    return false;
  if (effect.name == kBank && obs.bank_is_known) return false;
  return effect.name != "steering0.wheelbase" || !obs.steering.empty() ||
         obs.wheels_read == WheelsRead::kFront;
}

Candidate motion_term(const std::string& hook, const std::string& covariate) {
  Candidate c;
  c.kind = CandidateKind::kGrammar;
  c.hook = hook;
  c.covariate = covariate;
  c.name = hook + " ~ " + covariate;
  c.named_mean = grammar_constant(hook);
  c.unit = grammar_unit(hook);
  c.tau = grammar_tau(hook);
  c.penalty = kGrammarPenalty;
  return c;
}

}  // namespace

Columns moving_discs(const Observations& obs,
                     const MotionPoint& point,
                     const std::vector<Accepted>& accepted,
                     const std::vector<std::size_t>& places) {
  Columns all;
  if (places.empty()) return all;
  const WheelSteps wheels(obs, {smoothed(point.trajectory), point.effects, {}});
  for (const std::size_t a : places)
    all.append(disc_columns(wheels, accepted[a].candidate, accepted[a].size[0]));
  return all;
}

bool left_out(const LibraryOptions& options, std::string_view name) {
  return holds(options.without, name);
}

bool has_streams(const Observations& obs, unsigned streams) {
  return ((streams & kWheels) != 0 && obs.wheels.size() > 1) ||
         ((streams & kSteeringBit) != 0 && !obs.steering.empty()) ||
         ((streams & kGyroBit) != 0 && !obs.gyro.empty()) || (streams & kPoses) != 0;
}

std::vector<Candidate> list_candidates(const Observations& obs,
                                       const MotionPoint& point,
                                       const LibraryOptions& options) {
  std::vector<Candidate> all;
  for (std::size_t i = 0; options.named && i < motion_effects().size(); ++i) {
    const MotionEffect& effect = motion_effects()[i];
    if (!shows_motion(obs, effect) || left_out(options, effect.name)) continue;
    Candidate c;
    c.name = effect.name;
    c.effect = i;
    c.unit = declaration_of(effect.name).unit;
    c.tau = declaration_of(effect.name).plausible;
    all.push_back(c);
  }
  if (options.places && has_streams(obs, kWheels) && !left_out(options, kWetPatch))
    for (const Candidate& place : wet_places(point.trajectory)) all.push_back(place);
  if (!options.grammar) return all;
  for (const std::string& hook : grammar_hooks(obs)) {
    for (const std::string& covariate : grammar_covariates(hook))
      all.push_back(motion_term(hook, covariate));
    for (const ColumnCovariate& column : obs.columns)
      all.push_back(logged_term(motion_term(hook, column.name())));
  }
  return all;
}

Library build_library(const Observations& obs,
                      const MotionPoint& point,
                      std::vector<Candidate> candidates,
                      Columns front) {
  ColumnBuilder builder(obs, point);
  Library library;
  library.front = front.count();
  library.columns = std::move(front);
  const auto append = [&](Columns columns, std::vector<std::size_t>& indices) {
    for (std::size_t k = 0; k < columns.count(); ++k)
      indices.push_back(library.columns.count() + k);
    library.columns.append(std::move(columns));
  };
  std::map<std::string, std::vector<std::size_t>> constants;  // by hook; shared by its terms
  for (Candidate& c : candidates) {
    c.columns.clear();
    if (has_constant(c)) {
      auto [constant, fresh] = constants.try_emplace(c.hook);
      if (fresh) append(builder.constant(c.hook), constant->second);
      c.columns = constant->second;
    }
    append(builder.column(c), c.columns);
    if (!c.columns.empty()) library.candidates.push_back(std::move(c));
  }
  return library;
}

Columns candidate_columns(const Observations& obs,
                          const MotionPoint& point,
                          const std::vector<Candidate>& of) {
  ColumnBuilder builder(obs, point);
  Columns all;
  for (const Candidate& c : of) {
    if (has_constant(c)) all.append(builder.constant(c.hook));
    all.append(builder.column(c));
  }
  return all;
}

}  // namespace roadbook
