#include "diagnosis/motion_library.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/effect_columns.hpp"
#include "diagnosis/grammar.hpp"
#include "diagnosis/motion_prediction.hpp"

namespace roadbook {
namespace {

constexpr double kPlaceRadius = 3.0;   // [m] of a puddle that scanning looks for
constexpr double kPlaceSpacing = 2.0;  // [m] between places tried
constexpr double kGrammarPenalty = 2.0;

std::vector<Candidate> places_along(const Trajectory& trajectory) {
  std::vector<Candidate> places;
  double last = -1e9;
  for (std::size_t j = 0; j < trajectory.knots(); ++j) {
    const MotionState s = trajectory.after(std::min(j, trajectory.knots() - 2), 0.0);
    if (s.distance_m - last < kPlaceSpacing) continue;
    last = s.distance_m;
    const bool near = std::any_of(places.begin(), places.end(), [&](const Candidate& p) {
      return std::hypot(p.place_x - s.x, p.place_y - s.y) < 0.7 * kPlaceSpacing;
    });
    if (near) continue;
    Candidate place;
    place.kind = CandidateKind::kPlace;
    place.name = "wheels0.wet_patch";
    place.unit = declaration_of(place.name).unit;
    place.tau = declaration_of(place.name).plausible;
    place.place_x = s.x;
    place.place_y = s.y;
    place.place_radius = kPlaceRadius;
    places.push_back(place);
  }
  for (Candidate& p : places) p.penalty = std::log(static_cast<double>(places.size()));
  return places;
}

bool left_out(const LibraryOptions& options, std::string_view name) {
  return std::find(options.without.begin(), options.without.end(), name) != options.without.end();
}

constexpr const char* kConstant = "constant";

// A smooth function of a covariate has a mean.
bool has_constant(const Candidate& c) {
  return c.kind == CandidateKind::kGrammar && c.covariate != kConstant;
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

}  // namespace

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
    if (!has_streams(obs, effect.streams) || left_out(options, effect.name)) continue;
    Candidate c;
    c.name = effect.name;
    c.effect = i;
    c.unit = declaration_of(effect.name).unit;
    c.tau = declaration_of(effect.name).plausible;
    all.push_back(c);
  }
  if (options.places && has_streams(obs, kWheels) && !left_out(options, "wheels0.wet_patch"))
    for (const Candidate& place : places_along(smoothed(point.trajectory))) all.push_back(place);
  if (!options.grammar) return all;
  for (const std::string& hook : grammar_hooks(obs))
    for (const std::string& covariate : grammar_covariates(hook)) {
      Candidate c;
      c.kind = CandidateKind::kGrammar;
      c.hook = hook;
      c.covariate = covariate;
      c.name = hook + " ~ " + covariate;
      c.unit = grammar_unit(hook);
      c.tau = grammar_tau(hook);
      c.penalty = kGrammarPenalty;
      all.push_back(c);
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

std::vector<Candidate> places_near(const Observations& obs,
                                   const MotionPoint& point,
                                   const Candidate& place) {
  std::vector<Candidate> near;
  for (const PoseSample& p : obs.poses) {
    const double away = std::hypot(p.x - place.place_x, p.y - place.place_y);
    const bool tried = std::any_of(near.begin(), near.end(), [&](const Candidate& c) {
      return std::hypot(c.place_x - p.x, c.place_y - p.y) < 0.25 * kPlaceSpacing;
    });
    if (away > 1.5 * kPlaceSpacing || tried) continue;
    const MotionState s = point.trajectory.at(p.t_s);
    for (const double radius : {1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0, 6.0}) {
      Candidate c = place;
      c.place_x = s.x;
      c.place_y = s.y;
      c.place_radius = radius;
      near.push_back(c);
    }
  }
  return near;
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
