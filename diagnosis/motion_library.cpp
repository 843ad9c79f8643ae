#include "diagnosis/motion_library.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "diagnosis/columns.hpp"
#include "diagnosis/grammar.hpp"
#include "diagnosis/motion_prediction.hpp"

namespace roadbook {
namespace {

constexpr double kPlaceRadius = 3.0;   // [m] of a puddle that scanning looks for
constexpr double kPlaceSpacing = 2.0;  // [m] between places tried
constexpr double kGrammarPenalty = 2.0;

// Wheels that turn more by a share inside a disc.
std::vector<double> place_column(const Observations& obs,
                                 const MotionPoint& point,
                                 const Candidate& place) {
  const auto first = obs.offsets();
  std::vector<double> column(first.back(), 0.0);
  const RowTimes times = row_times(obs, point.effects);
  for (std::size_t k = 0; k + 1 < obs.wheels.size(); ++k) {
    const MotionState a = point.trajectory.at(times.wheels[k]);
    const MotionState b = point.trajectory.at(times.wheels[k + 1]);
    const double away =
        std::hypot(0.5 * (a.x + b.x) - place.place_x, 0.5 * (a.y + b.y) - place.place_y);
    // A row that straddles the edge counts in part.
    const double reach = 0.5 * std::abs(b.distance_m - a.distance_m) + 1e-6;
    const double share = std::clamp(0.5 + 0.5 * (place.place_radius - away) / reach, 0.0, 1.0);
    column[first[index_of(Channel::kWheelDistance)] + k] = share * (b.distance_m - a.distance_m);
    column[first[index_of(Channel::kWheelHeading)] + k] = share * (b.turned - a.turned);
  }
  return column;
}

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

// Of a function of a covariate without its mean.
Columns candidate_column(const Observations& obs,
                         const MotionPoint& smooth,
                         const Candidate& c,
                         Grammar& grammar) {
  if (c.kind == CandidateKind::kNamed) return effect_columns(obs, smooth, {c.effect});
  if (c.kind == CandidateKind::kGrammar) return grammar.columns({c.hook, c.covariate});
  return {1, place_column(obs, smooth, c)};
}

MotionPoint smooth_point(const MotionPoint& point) {
  return {smoothed(point.trajectory), point.effects, {}};
}

Columns side_by_side(const std::vector<Columns>& parts, std::size_t rows) {
  Columns all;
  for (const Columns& p : parts) all.count += p.count;
  all.values.resize(rows * std::max<std::size_t>(all.count, 1));
  std::size_t at = 0;
  for (const Columns& p : parts) {
    for (std::size_t i = 0; i < rows && p.count > 0; ++i)
      std::copy_n(p.row(i), p.count, all.values.data() + i * all.count + at);
    at += p.count;
  }
  return all;
}

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
  const MotionPoint smooth = smooth_point(point);
  Grammar grammar(obs, smooth);
  Library library;
  library.front = front.count;
  std::size_t at = front.count;
  std::vector<Columns> parts;
  parts.push_back(std::move(front));
  const auto append = [&](Columns columns, std::vector<std::size_t>& indices) {
    for (std::size_t k = 0; k < columns.count; ++k) indices.push_back(at++);
    parts.push_back(std::move(columns));
  };
  std::map<std::string, std::vector<std::size_t>> constants;  // by hook; shared by its terms
  for (Candidate& c : candidates) {
    c.columns.clear();
    if (has_constant(c)) {
      auto [constant, fresh] = constants.try_emplace(c.hook);
      if (fresh) append(grammar.columns({c.hook, kConstant}), constant->second);
      c.columns = constant->second;
    }
    append(candidate_column(obs, smooth, c, grammar), c.columns);
    if (!c.columns.empty()) library.candidates.push_back(std::move(c));
  }
  library.columns = side_by_side(parts, obs.offsets().back());
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
  const MotionPoint smooth = smooth_point(point);
  Grammar grammar(obs, smooth);
  std::vector<Columns> parts;
  for (const Candidate& c : of) {
    if (has_constant(c)) parts.push_back(grammar.columns({c.hook, kConstant}));
    parts.push_back(candidate_column(obs, smooth, c, grammar));
  }
  return side_by_side(parts, obs.offsets().back());
}

}  // namespace roadbook
