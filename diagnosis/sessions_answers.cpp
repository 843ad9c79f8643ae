#include "diagnosis/sessions_problem.hpp"

namespace roadbook {

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
