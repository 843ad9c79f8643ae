#include "diagnosis/separating_causes.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include "base/error.hpp"
#include "sensors/effects.hpp"

namespace roadbook {
namespace {

bool wants_separating(const FoundCause& cause) {
  return !cause.inseparable.empty() && cause.separating.empty() && !cause.noise;
}

std::string declared_covariate(const std::string& effect) {
  const auto info = declared_effect(effect);
  return info ? std::string(info->covariate) : std::string();
}

// What has to vary otherwise than together.
std::string varying_apart(const FoundCause& cause) {
  const std::string own = declared_covariate(cause.effect);
  std::set<std::string> others;
  for (const std::string& name : cause.inseparable)
    if (const std::string other = declared_covariate(name); other != own) others.insert(other);
  // Two that grow with the same, or are constant both: nothing that a drive could vary.
  if (others.size() < 1) return "none of the manoeuvres tried would separate them";
  std::string list = own;
  for (const std::string& other : others)
    if (!other.empty()) list += (list.empty() ? "" : " and ") + other;
  const bool one = list.find(" and ") == std::string::npos;
  return "a drive in which " + list + (one ? " varies more" : " vary more, and independently,") +
         " would separate them";
}

// Of effects that motion shows, all of them; none where one is not among them.
std::optional<std::string> by_manoeuvre(const MotionProblem& problem,
                                        const FoundCause& cause,
                                        double threshold) {
  CauseModel model = problem.nominal();
  const std::vector<Candidate> all = problem.candidates(model);
  const Candidate* own = named(all, cause.effect);
  std::vector<Candidate> alternatives;
  for (const std::string& name : cause.inseparable) {
    const Candidate* other = named(all, name);
    if (other == nullptr) return std::nullopt;
    alternatives.push_back(*other);
  }
  if (own == nullptr) return std::nullopt;
  model.accepted = {{*own, Eigen::VectorXd::Constant(1, cause.size)}};
  return problem.separating(model, 0, alternatives, threshold);
}

}  // namespace

void name_separating_drives(const MotionStreams& streams,
                            const DiagnosisOptions& options,
                            Diagnosis& d) {
  if (std::none_of(d.causes.begin(), d.causes.end(), wants_separating)) return;
  DiagnosisOptions of_names = options;
  of_names.library.grammar = of_names.library.places = false;
  PreparedMotion prepared;
  try {
    prepared = prepare_motion(streams, "drive", of_names);
  } catch (const BadInput&) {
    // Of a drive whose motion says nothing the covariates are left.
  }
  for (FoundCause& cause : d.causes) {
    if (!wants_separating(cause)) continue;
    std::optional<std::string> text;
    if (prepared.problem)
      text = by_manoeuvre(*prepared.problem, cause, options.search.confounded_loss);
    cause.separating = text ? *text : varying_apart(cause);
  }
}

}  // namespace roadbook
