#include "diagnosis/views/view_alternatives.hpp"

#include <algorithm>

namespace roadbook {
namespace {

// The members of the equivalence set of `cause` with the evidence that the motion still supports
// beside each, least first; empty if the motion cannot decide.
std::vector<std::pair<double, std::string>> by_wants(const Diagnosis& d,
                                                     const FoundCause& cause,
                                                     const RemainingMotionEvidence& wants) {
  EffectSizes others = d.extended;
  others.erase(cause.effect);
  EffectSizes names = cause.instead;
  names[cause.effect] = cause.size;
  std::vector<std::pair<double, std::string>> wanted;
  for (const auto& [name, size] : names) {
    EffectSizes effects = others;
    effects[name] += size;
    const std::optional<double> more = wants(d, effects);
    if (!more) return {};
    wanted.emplace_back(*more, name);
  }
  std::sort(wanted.begin(), wanted.end());
  return wanted;
}

// Removes the effects `out` from the equivalence set and notes which data excluded them.
void narrow(const std::vector<std::string>& out, const std::string& witness, FoundCause& cause) {
  std::string names;
  for (const std::string& name : out) {
    std::erase(cause.inseparable, name);
    cause.instead.erase(name);
    names += (names.empty() ? "" : ", ") + name;
  }
  cause.note += (cause.note.empty() ? "" : "; ") + ("separated from " + names + " by " + witness);
  if (cause.inseparable.empty()) cause.separating.clear();
}

FoundCause* find_cause(Diagnosis& d, const std::string& effect) {
  const auto found = std::find_if(d.causes.begin(), d.causes.end(),
                                  [&](const FoundCause& c) { return c.effect == effect; });
  return found == d.causes.end() ? nullptr : &*found;
}

}  // namespace

ViewAnswers diagnose_views(const ViewProblem& views,
                           SearchOptions options,
                           const RemainingMotionEvidence& wants,
                           const std::string& witness) {
  ViewAnswers answers{diagnose(views, options), {}};
  std::map<std::string, std::vector<std::string>> told;  // effect -> members excluded from its set
  for (const FoundCause& cause : answers.found.causes) {
    if (cause.inseparable.empty()) continue;
    const auto wanted = by_wants(answers.found, cause, wants);
    std::vector<std::string> out;
    for (const auto& [more, name] : wanted)
      if (more > wanted.front().first + options.confounded_loss) out.push_back(name);
    if (out.empty()) continue;
    const bool renamed = holds(out, cause.effect);
    if (renamed) options.instead[cause.effect] = wanted.front().second;
    told[renamed ? wanted.front().second : cause.effect] = std::move(out);
  }
  if (!options.instead.empty()) answers.found = diagnose(views, options);
  for (const auto& [name, out] : told)
    if (FoundCause* cause = find_cause(answers.found, name)) {
      narrow(out, witness, *cause);
      answers.contradicted.insert(answers.contradicted.end(), out.begin(), out.end());
    }
  return answers;
}

}  // namespace roadbook
