#include <algorithm>

#include "diagnosis/sessions_problem.hpp"

namespace roadbook {
namespace {

constexpr const char* kWhose =
    "a further drive would show whether the vehicle has the effect, or this drive alone";

}  // namespace

// What single drives answer.

std::vector<Candidate> SessionsProblem::refinements(const CauseModel& model,
                                                    const Candidate& place) const {
  std::vector<Candidate> finer;
  for (std::size_t s = 0; s < sessions_.size(); ++s)
    if (const auto mine = in(s, place))
      for (const Candidate& c : sessions_[s].problem->refinements(of(model, s), *mine))
        finer.push_back(of_session(c, sessions_[s].name));
  return finer;
}

std::vector<Candidate> SessionsProblem::variations(const CauseModel& model,
                                                   const Candidate& name) const {
  for (std::size_t s = 0; s < sessions_.size(); ++s) {
    const auto mine = in(s, name);
    if (!mine) continue;
    std::vector<Candidate> terms = sessions_[s].problem->variations(of(model, s), *mine);
    if (!name.session.empty())
      for (Candidate& c : terms) c = of_session(c, name.session);
    return terms;
  }
  return {};
}

std::vector<NoiseCause> SessionsProblem::noise_causes(const CauseModel& model) const {
  std::vector<NoiseCause> all;
  for (std::size_t s = 0; s < sessions_.size(); ++s)
    for (NoiseCause n : sessions_[s].problem->noise_causes(of(model, s))) {
      n.session = sessions_[s].name;
      all.push_back(std::move(n));
    }
  return all;
}

std::string SessionsProblem::note(const Accepted& cause) const {
  for (std::size_t s = 0; s < sessions_.size(); ++s)
    if (const auto mine = in(s, cause.candidate))
      return sessions_[s].problem->note({*mine, cause.size});
  return {};
}

double SessionsProblem::level_of_names() const {
  double level = 1.0;
  for (const SessionProblem& s : sessions_) level = std::min(level, s.problem->level_of_names());
  return level;
}

std::vector<std::size_t> SessionsProblem::channels_of_reference() const {
  std::vector<std::size_t> all;
  std::size_t first = 0;
  for (const SessionProblem& s : sessions_) {
    for (const std::size_t c : s.problem->channels_of_reference()) all.push_back(first + c);
    first += s.problem->channels().size();
  }
  return all;
}

bool SessionsProblem::intervals_of_blocks() const {
  return std::any_of(sessions_.begin(), sessions_.end(),
                     [](const SessionProblem& s) { return s.problem->intervals_of_blocks(); });
}

bool SessionsProblem::gains_need_refit() const {
  return std::any_of(sessions_.begin(), sessions_.end(),
                     [](const SessionProblem& s) { return s.problem->gains_need_refit(); });
}

std::string SessionsProblem::separating(const CauseModel& model,
                                        std::size_t a,
                                        const std::vector<Candidate>& alternatives,
                                        double threshold) const {
  const Candidate& cause = model.accepted[a].candidate;
  std::size_t s = 0;
  while (!in(s, cause)) ++s;
  std::size_t own_a = 0;
  for (std::size_t b = 0; b < a; ++b) own_a += in(s, model.accepted[b].candidate) ? 1 : 0;
  std::vector<Candidate> others;
  bool whose = false;
  for (const Candidate& c : alternatives) {
    if (shared_name(c) == shared_name(cause)) {
      whose = true;
      continue;
    }
    auto mine = in(s, c);
    if (mine && named(others, mine->name) == nullptr) others.push_back(std::move(*mine));
  }
  std::string text;
  if (!others.empty())
    text = sessions_[s].problem->separating(of(model, s), own_a, others, threshold);
  if (whose) text += (text.empty() ? "" : "; ") + std::string(kWhose);
  return text;
}

EvidencePlot SessionsProblem::evidence(const CauseModel& nominal,
                                       const CauseModel& extended,
                                       const Candidate& cause) const {
  for (std::size_t s = 0; s < sessions_.size(); ++s)
    if (const auto mine = in(s, cause)) {
      EvidencePlot plot = sessions_[s].problem->evidence(of(nominal, s), of(extended, s), *mine);
      if (!plot.bins.empty()) plot.channel += " in " + sessions_[s].name;
      return plot;
    }
  return {};
}

}  // namespace roadbook
