#include "diagnosis/motion/motion_problem.hpp"

#include <algorithm>
#include <iterator>

#include "base/error.hpp"
#include "diagnosis/motion/grammar.hpp"
#include "diagnosis/motion/large_effects.hpp"
#include "diagnosis/motion/motion_evidence.hpp"
#include "diagnosis/motion/noise_causes.hpp"
#include "diagnosis/motion/separating_drive.hpp"
#include "diagnosis/motion/wet_place_search.hpp"
#include "diagnosis/motion/wet_places.hpp"
#include "diagnosis/streams/coarse_readings.hpp"
#include "diagnosis/streams/lag_by_correlation.hpp"
#include "diagnosis/streams/window_noise.hpp"

namespace roadbook {
namespace {

const FittedMotion& fitted_motion(const CauseModel& model) {
  const auto* motion = dynamic_cast<const FittedMotion*>(model.state.get());
  ROADBOOK_ASSERT(motion != nullptr);
  return *motion;
}

CauseModel cause_model(const MotionModel& motion) {
  return {motion.accepted, std::make_shared<FittedMotion>(motion), motion.information,
          motion.log_likelihood};
}

// Bounds hold for the sum of known and found size.
void bound(MotionEffects known, Candidate& c) {
  const EffectInfo& info = declaration_of(c.name);
  const double part = c.kind == CandidateKind::kNamed ? size_of(known, c) : 0.0;
  c.lowest = info.lowest - part;
  c.highest = info.highest - part;
}

double level_for(const Observations& obs, const MotionModel& nominal) {
  constexpr double kLevel = 0.002;
  // Autocorrelated errors make standard errors too small; a strict rule tolerates that.
  const bool go_on = obs.poses_of_map || readings_correlate(windows_of_noise(obs, Channel::kGyro),
                                                            smoothed(nominal.point.trajectory));
  return go_on ? 0.0 : kLevel;
}

}  // namespace

MotionModel motion_model(const CauseModel& model) {
  MotionModel motion;
  static_cast<FittedMotion&>(motion) = fitted_motion(model);
  motion.accepted = model.accepted;
  motion.information = model.information;
  motion.log_likelihood = model.log_likelihood;
  motion.point.effects = motion.known;
  for (const Accepted& a : motion.accepted)
    if (a.candidate.kind == CandidateKind::kNamed)
      size_of(motion.point.effects, a.candidate) = size_of(motion.known, a.candidate) + a.size[0];
  return motion;
}

MotionProblem::MotionProblem(Observations obs, const EffectSizes& known, LibraryOptions library)
    : obs_(covered_by_poses(std::move(obs), known)),
      library_(std::move(library)),
      known_(known),
      nominal_(nominal_model(obs_, known)),
      start_(nominal_),
      level_of_names_(level_for(obs_, nominal_)) {
  if (!has_large_effects(obs_, nominal_, known, library_)) return;
  const EffectSizes large = large_effects_of(obs_, known, library_);
  if (large.empty()) return;
  // Noise and trajectory are those of the model that is near the data; about a fit of the nominal
  // one nothing is linear.
  EffectSizes near = known;
  for (const auto& [name, size] : large) near[name] += size;
  obs_ = covered_by_poses(std::move(obs_), near);
  const MotionModel informed = nominal_model(obs_, near);
  const MotionEffects nominal_effects = nominal_.known;
  nominal_ = informed;
  level_of_names_ = level_for(obs_, nominal_);
  nominal_.known = nominal_.point.effects = nominal_effects;
  MotionModel once = nominal_;
  fit_model(obs_, once, 1);
  nominal_.log_likelihood = once.log_likelihood;
  renew_residual(obs_, nominal_);
  start_ = informed;
  start_.known = nominal_effects;
  LibraryOptions names = library_;
  names.places = names.grammar = false;
  for (Candidate c : list_candidates(obs_, start_.point, names)) {
    const auto size = large.find(c.name);
    if (size == large.end()) continue;
    bound(nominal_effects, c);
    c.columns = {start_.accepted.size()};
    start_.accepted.push_back({c, Eigen::VectorXd::Constant(1, size->second)});
  }
  fit_model(obs_, start_, 4);
}

MotionProblem::MotionProblem(Observations obs, MotionModel nominal, LibraryOptions library)
    : obs_(std::move(obs)),
      library_(std::move(library)),
      nominal_(std::move(nominal)),
      start_(nominal_),
      level_of_names_(level_for(obs_, nominal_)) {}

std::vector<ChannelName> MotionProblem::channels() const {
  std::vector<ChannelName> names;
  for (std::size_t c = 0; c < kChannels; ++c) {
    const auto channel = static_cast<Channel>(c);
    names.push_back({std::string(stream_of(channel)), std::string(name_of(channel))});
  }
  return names;
}

CauseModel MotionProblem::nominal() const { return cause_model(nominal_); }
CauseModel MotionProblem::start() const { return cause_model(start_); }

std::vector<Candidate> MotionProblem::candidates(const CauseModel& model) const {
  std::vector<Candidate> all = list_candidates(obs_, fitted_motion(model).point, library_);
  const auto is_place = [](const Candidate& c) { return c.kind == CandidateKind::kPlace; };
  std::vector<Candidate> places;
  std::copy_if(all.begin(), all.end(), std::back_inserter(places), is_place);
  std::erase_if(all, is_place);
  for (const Candidate& c : shortlist_places(obs_, motion_model(model), places)) all.push_back(c);
  for (Candidate& c : all) {
    if (c.kind == CandidateKind::kGrammar) {
      // Its mean has a name already.
      c.has_mean =
          std::none_of(model.accepted.begin(), model.accepted.end(),
                       [&](const Accepted& a) { return a.candidate.name == c.named_mean; });
      continue;
    }
    if (library_.bounds) bound(nominal_.known, c);
  }
  return all;
}

Projection MotionProblem::project(const CauseModel& model,
                                  std::vector<Candidate> candidates) const {
  const MotionModel motion = motion_model(model);
  Library library =
      build_library(obs_, motion.point, std::move(candidates), accepted_columns(obs_, motion));
  const PassOptions options{false, 0, &motion.inflation};
  return {library.front, std::move(library.candidates),
          run_pass(obs_, motion.point, motion.noise, library.columns, options).innovations};
}

void MotionProblem::fit(CauseModel& model, int iterations) const {
  fit_beside(model, iterations, {});
}

void MotionProblem::fit_beside(CauseModel& model, int iterations, const SizePrior& others) const {
  MotionModel motion = motion_model(model);
  fit_model(obs_, motion, iterations, others);
  model = cause_model(motion);
}

std::vector<Candidate> MotionProblem::refinements(const CauseModel& model,
                                                  const Candidate& place) const {
  return places_near(obs_, fitted_motion(model).point, place);
}

std::vector<Candidate> MotionProblem::variations(const CauseModel& /*model*/,
                                                 const Candidate& name) const {
  std::vector<Candidate> terms;
  std::vector<std::string> covariates{"speed",     "yaw rate", "acceleration",
                                      "curvature", "heading",  "time"};
  for (const ColumnCovariate& column : obs_.columns) covariates.push_back(column.name());
  for (const std::string& covariate : covariates) {
    Candidate term;
    term.kind = CandidateKind::kGrammar;
    term.hook = name.name;
    term.covariate = covariate;
    term.name = name.name + " ~ " + covariate;
    term.unit = name.unit;
    term.tau = name.tau;
    term.has_mean = false;
    terms.push_back(term);
  }
  return terms;
}

std::vector<NoiseCause> MotionProblem::noise_causes(const CauseModel& model) const {
  NoiseOptions options;
  options.known = known_;
  std::vector<NoiseCause> causes = roadbook::noise_causes(obs_, motion_model(model), options);
  // That neighbours share their errors is how a map's poses are.
  std::erase_if(causes, [&](const NoiseCause& c) {
    return left_out(library_, c.effect) || (obs_.poses_of_map && c.effect.starts_with("poses."));
  });
  return causes;
}

std::vector<std::size_t> MotionProblem::channels_of_reference() const {
  std::vector<std::size_t> channels;
  if (obs_.poses_of_map) return channels;
  // At their least noise, neighbours correlate because the model's noise is the larger one.
  const auto& sigma = nominal_.noise.pose;
  if (sigma[0] > MotionNoise::kLeastPosition) channels.push_back(index_of(Channel::kPoseAlong));
  if (sigma[1] > MotionNoise::kLeastPosition) channels.push_back(index_of(Channel::kPoseAcross));
  if (sigma[2] > MotionNoise::kLeastHeading) channels.push_back(index_of(Channel::kPoseHeading));
  return channels;
}

std::string MotionProblem::note(const Accepted& cause) const {
  const Candidate& c = cause.candidate;
  if (c.kind != CandidateKind::kPlace) return {};
  return place_text(c);
}

std::string MotionProblem::separating(const CauseModel& model,
                                      std::size_t a,
                                      const std::vector<Candidate>& alternatives,
                                      double threshold) const {
  return separating_drive(obs_, motion_model(model), a, alternatives, threshold);
}

EvidencePlot MotionProblem::evidence(const CauseModel& nominal,
                                     const CauseModel& extended,
                                     const Candidate& cause) const {
  return motion_evidence(obs_, motion_model(nominal), motion_model(extended), cause);
}

}  // namespace roadbook
