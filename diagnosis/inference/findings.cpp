#include "diagnosis/inference/findings.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "diagnosis/inference/check_notes.hpp"
#include "diagnosis/inference/extended_model.hpp"
#include "diagnosis/inference/plausible_size.hpp"
#include "diagnosis/inference/search.hpp"
#include "diagnosis/numerics/size_interval.hpp"

namespace roadbook {
namespace {

// Least size, in its standard deviations, of an effect that is named without a significant gain.
constexpr double kLeastSigmas = 3.0;

FoundCause found_cause(const CauseProblem& problem, const AcceptedEffect& v) {
  FoundCause cause;
  const Candidate& c = v.cause.candidate;
  cause.effect = shared_name(c);
  cause.session = c.session;
  cause.in_place = c.kind == CandidateKind::kPlace;
  cause.at_known = c.at_known;
  cause.size = v.cause.size[0];
  cause.unit = c.unit;
  cause.low = cause.size - kSigmas95 * v.sigma;
  cause.high = cause.size + kSigmas95 * v.sigma;
  cause.p = v.p;
  cause.evidence = v.evidence;
  cause.gain = v.gain;
  cause.inseparable = v.inseparable;
  for (std::size_t k = 0; k < v.inseparable.size(); ++k)
    cause.instead[v.inseparable[k]] = v.instead[k];
  cause.note = problem.note(v.cause);
  return cause;
}

// The drive that would tell a cause from those it may be mistaken for.
std::string separating(const CauseProblem& problem,
                       const CauseModel& model,
                       const AcceptedEffect& v,
                       const SearchOptions& options) {
  std::vector<Candidate> alternatives;
  for (const Candidate& c : problem.candidates(model))
    if (c.kind == CandidateKind::kNamed &&
        std::find(v.inseparable.begin(), v.inseparable.end(), c.name) != v.inseparable.end())
      alternatives.push_back(c);
  for (std::size_t a = 0; a < model.accepted.size() && !alternatives.empty(); ++a)
    if (model.accepted[a].candidate.name == v.cause.candidate.name)
      return problem.separating(model, a, alternatives, options.confounded_loss);
  return {};
}

UnknownCause unknown(const AcceptedEffect& v) {
  UnknownCause cause;
  const Candidate& c = v.cause.candidate;
  const auto dot = c.hook.find('.');
  cause.stream = c.hook.substr(0, dot);
  cause.hook = c.hook.substr(dot + 1);
  cause.depends_on = c.covariate;
  cause.terms.assign(v.cause.size.begin(), v.cause.size.end());
  cause.inseparable = v.covariates;
  cause.unit = c.unit;
  cause.p = v.p;
  cause.gain = v.gain;
  return cause;
}

std::string unit_after(const std::string& unit) { return unit == "1" ? "" : " " + unit; }

std::string impossible(const Impossible& i) {
  char text[200];
  std::snprintf(text, sizeof text,
                "resembles %s = %.3g%s, but this size is physically impossible (bounds %.3g to "
                "%.3g)",
                i.candidate.name.c_str(), i.size, unit_after(i.candidate.unit).c_str(),
                i.candidate.lowest, i.candidate.highest);
  const std::string mistake = likely_mistake(i.candidate.name, i.size);
  return text + (mistake.empty() ? "" : ": " + mistake);
}

// Reason why an accepted effect is not reported; empty if it is. The model keeps it, so that no
// other effect absorbs its part of the data.
std::string no_answer(const AcceptedEffect& v) {
  const Candidate& c = v.cause.candidate;
  const double size = v.cause.size[0];
  if (!is_possible(c, size)) return impossible({c, size});
  char text[200];
  if (std::abs(size) > kFarBeyondPlausible * c.tau && v.gain.low <= 0.0 && v.gain.total >= 0.0) {
    std::snprintf(text, sizeof text,
                  "resembles %s = %.3g%s, but this size is far beyond the plausible size and its "
                  "held-out gain is not significant",
                  c.name.c_str(), size, unit_after(c.unit).c_str());
    return text;
  }
  if (v.gain.total < 0.0) {
    std::snprintf(
        text, sizeof text,
        "resembles %s = %.3g%s, but it predicts held-out blocks worse than the model without it",
        c.name.c_str(), size, unit_after(c.unit).c_str());
    return text;
  }
  // The p-value takes rows for independent; sigma and gain allow for errors that last.
  if (v.gain.low <= 0.0 && std::abs(size) < kLeastSigmas * v.sigma) {
    std::snprintf(text, sizeof text,
                  "resembles %s = %.3g%s, but this size is only %.1f standard deviations and its "
                  "held-out gain is not significant",
                  c.name.c_str(), size, unit_after(c.unit).c_str(), std::abs(size) / v.sigma);
    return text;
  }
  return {};
}

// Of an effect that two kinds of data show.
std::string also_found(const FoundCause& other) {
  char text[120];
  std::snprintf(text, sizeof text, "estimate from other data: %.4g (%.4g to %.4g)", other.size,
                other.low, other.high);
  return text;
}

void merge_cause(const FoundCause& cause, std::vector<FoundCause>& all) {
  // One name can have several places. Each place is a separate finding.
  const auto same = std::find_if(all.begin(), all.end(), [&](const FoundCause& c) {
    return c.effect == cause.effect && c.session == cause.session && !c.in_place && !cause.in_place;
  });
  if (same == all.end()) {
    all.push_back(cause);
    return;
  }
  FoundCause tight = *same;
  FoundCause wide = cause;
  if (cause.high - cause.low < same->high - same->low) std::swap(tight, wide);
  tight.note += (tight.note.empty() ? "" : "; ") + also_found(wide);
  *same = tight;
}

}  // namespace

HeldOutGain gain_of_large_samples(double z) {
  HeldOutGain gain;
  gain.total = 0.5 * z * z - 1.0;
  gain.low = gain.total - kSigmas95 * std::abs(z);
  gain.high = gain.total + kSigmas95 * std::abs(z);
  return gain;
}

FoundCause found_noise(const NoiseCause& n) {
  FoundCause cause;
  cause.effect = n.effect;
  cause.session = n.session;
  cause.unit = n.unit;
  cause.size = n.size;
  const SizeInterval interval = interval95(n.effect, n.size, n.sigma);
  cause.low = interval.low;
  cause.high = interval.high;
  cause.p = n.p;
  cause.evidence = 0.5 * n.z * n.z;
  cause.gain = gain_of_large_samples(n.z);
  cause.noise = true;
  cause.note = "noise effect: the gain is a large-sample approximation";
  const bool counted = n.effect.starts_with("cam");  // else the share is estimated
  if (counted && n.effect.ends_with("outliers")) cause.note += "; the share is a lower bound";
  return cause;
}

Diagnosis diagnose(const CauseProblem& problem, const SearchOptions& options) {
  Diagnosis d;
  const CauseModel nominal = problem.nominal();
  d.before = check_innovations(problem.project(nominal, {}).innovations, problem.channels());
  const SearchResult result = search_causes(problem, options);
  const Innovations left = problem.project(result.model, {}).innovations;
  d.after = check_innovations(left, problem.channels());
  d.notes = check_notes(problem.channels(), left, d.after);
  d.looked_for = result.looked_for;
  d.not_observable = result.not_observable;
  // The drive decides neither for nor against such an effect, so it does not count as looked for.
  for (const HiddenEffect& h : result.hidden) {
    d.notes.push_back(h.name + " is not separable in this drive from " + h.by);
    std::erase(d.looked_for, h.name);
  }
  d.samples = problem.rows();
  d.fit_gain = result.model.log_likelihood - nominal.log_likelihood;
  for (const AcceptedEffect& v : result.verdicts) {
    const bool term = v.cause.candidate.kind == CandidateKind::kGrammar;
    // With the later causes in the model, this term predicts worse than its absence, or the errors
    // of the reference last. It is not a finding. It stays in the model so that no other effect is
    // blamed.
    if (term && (v.gain.total < 0.0 || v.of_lasting_errors)) continue;
    const EvidencePlot plot = problem.evidence(nominal, result.model, v.cause.candidate);
    if (const std::string why = term ? "" : no_answer(v); !why.empty()) {
      d.unexplained.push_back(why);
      std::erase(d.looked_for, v.cause.candidate.name);  // neither found nor fine
      continue;
    }
    if (term) {
      d.unknown.push_back(unknown(v));
      d.unknown.back().plot = plot;
      continue;
    }
    d.causes.push_back(found_cause(problem, v));
    d.causes.back().plot = plot;
    d.causes.back().separating = separating(problem, result.model, v, options);
  }
  for (const NoiseCause& n : problem.noise_causes(result.model)) d.causes.push_back(found_noise(n));
  extend_model(d);
  for (const Impossible& i : result.impossible)
    if (std::none_of(result.verdicts.begin(), result.verdicts.end(), [&](const AcceptedEffect& v) {
          return v.cause.candidate.name == i.candidate.name;
        }))
      d.unexplained.push_back(impossible(i));
  for (const FitWarning& doubt : result.doubts)
    d.unexplained.push_back(doubt.name + ": " + doubt.text);
  std::vector<std::string> correlated;
  for (const FoundCause& c : d.causes)
    if (const auto dot = c.effect.find(".correlation"); dot != std::string::npos)
      correlated.push_back(c.effect.substr(0, dot));
  for (std::string& line : autocorrelations(problem.channels(), left, d.after, correlated))
    d.unexplained.push_back(std::move(line));
  return d;
}

Diagnosis merged(std::span<const Diagnosis> parts) {
  Diagnosis all;
  for (const Diagnosis& d : parts) {
    for (const FoundCause& c : d.causes) merge_cause(c, all.causes);
    add_lists(d, all);
    all.samples += d.samples;
    for (const std::string& name : d.looked_for)
      if (!holds(all.looked_for, name)) all.looked_for.push_back(name);
  }
  sort_causes(all.causes);
  std::stable_sort(
      all.unknown.begin(), all.unknown.end(),
      [](const UnknownCause& a, const UnknownCause& b) { return a.gain.total > b.gain.total; });
  extend_model(all);
  for (const std::string& name : all.looked_for) {
    const bool shown =
        std::any_of(parts.begin(), parts.end(), [&](const Diagnosis& d) { return shows(d, name); });
    if (!shown) all.not_observable.push_back(name);
  }
  return all;
}

Diagnosis diagnose(std::span<const CauseProblem* const> problems, const SearchOptions& options) {
  if (problems.size() == 1) return diagnose(*problems.front(), options);
  std::vector<Diagnosis> parts;
  for (const CauseProblem* problem : problems) parts.push_back(diagnose(*problem, options));
  return merged(parts);
}

}  // namespace roadbook
