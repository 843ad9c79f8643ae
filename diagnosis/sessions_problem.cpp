#include "diagnosis/sessions_problem.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/error.hpp"
#include "diagnosis/inference/size_exchange.hpp"

namespace roadbook {
namespace {

struct SessionStates final : CauseState {
  explicit SessionStates(std::vector<CauseModel> m) : of(std::move(m)) {}
  std::vector<CauseModel> of;
};

const SessionStates& states_of(const CauseModel& model) {
  const auto* states = dynamic_cast<const SessionStates*>(model.state.get());
  ROADBOOK_ASSERT(states != nullptr);
  return *states;
}

std::vector<Candidate> names_of(const CauseModel& model) {
  std::vector<Candidate> names;
  for (const Accepted& a : model.accepted) names.push_back(a.candidate);
  return names;
}

// Whether all drives start with the cause, with sizes that agree to a fifth.
bool is_gross_in_all(const Accepted& cause, const std::vector<CauseModel>& drives) {
  constexpr double kAgree = 0.2;
  return std::all_of(drives.begin(), drives.end(), [&](const CauseModel& drive) {
    return std::any_of(drive.accepted.begin(), drive.accepted.end(), [&](const Accepted& a) {
      return a.candidate.name == cause.candidate.name &&
             std::abs(a.size[0] - cause.size[0]) <=
                 kAgree * std::max(std::abs(a.size[0]), std::abs(cause.size[0]));
    });
  });
}

bool is_same(const Candidate& a, const Candidate& b) {
  return a.name == b.name && a.effect == b.effect && a.place_x == b.place_x &&
         a.place_y == b.place_y && a.place_radius == b.place_radius &&
         a.place_heading == b.place_heading;
}

// Places of one drive are where its own fit has moved them.
void move_places(const CauseModel& own, const std::string& session, CauseModel& model) {
  auto at = own.accepted.begin();
  for (Accepted& a : model.accepted) {
    if (a.candidate.kind != CandidateKind::kPlace || a.candidate.session != session) continue;
    at = std::find_if(at, own.accepted.end(),
                      [](const Accepted& o) { return o.candidate.kind == CandidateKind::kPlace; });
    ROADBOOK_ASSERT(at != own.accepted.end());
    a.candidate.place_x = at->candidate.place_x;
    a.candidate.place_y = at->candidate.place_y;
    a.candidate.place_radius = at->candidate.place_radius;
    a.candidate.place_heading = at->candidate.place_heading;
    ++at;
  }
}

}  // namespace

SessionsProblem::SessionsProblem(std::vector<SessionProblem> sessions)
    : sessions_(std::move(sessions)) {
  ROADBOOK_ASSERT(sessions_.size() > 1);
  for (const SessionProblem& s : sessions_) {
    ROADBOOK_ASSERT(s.problem->channels().size() == sessions_[0].problem->channels().size());
    listed_.push_back(s.problem->candidates(s.problem->nominal()));
    std::erase_if(listed_.back(),
                  [](const Candidate& c) { return c.kind == CandidateKind::kPlace; });
  }
}

std::vector<ChannelName> SessionsProblem::channels() const {
  std::vector<ChannelName> names;
  for (const SessionProblem& s : sessions_)
    for (const ChannelName& c : s.problem->channels())
      names.push_back({c.stream, c.channel + " in " + s.name});
  return names;
}

std::size_t SessionsProblem::rows() const {
  std::size_t rows = 0;
  for (const SessionProblem& s : sessions_) rows += s.problem->rows();
  return rows;
}

CauseModel SessionsProblem::nominal() const {
  CauseModel model;
  std::vector<CauseModel> of;
  for (const SessionProblem& s : sessions_) {
    of.push_back(s.problem->nominal());
    model.log_likelihood += of.back().log_likelihood;
  }
  model.state = std::make_shared<SessionStates>(std::move(of));
  return model;
}

CauseModel SessionsProblem::start() const {
  CauseModel model = nominal();
  std::vector<CauseModel> of;
  for (const SessionProblem& s : sessions_) of.push_back(s.problem->start());
  // A large effect common to all drives belongs to the vehicle, else to the drives that show it: a
  // gyro error in one of four drives must not be subtracted from the others.
  for (std::size_t s = 0; s < of.size(); ++s)
    for (const Accepted& a : of[s].accepted) {
      if (!is_gross_in_all(a, of)) {
        model.accepted.push_back({of_session(a.candidate, sessions_[s].name), a.size});
      } else if (named(names_of(model), a.candidate.name) == nullptr) {
        model.accepted.push_back(a);
      }
    }
  if (model.accepted.empty()) return model;
  model.state = std::make_shared<SessionStates>(std::move(of));
  fit(model, 4);
  return model;
}

std::optional<Candidate> SessionsProblem::in(std::size_t s, const Candidate& candidate) const {
  if (!candidate.session.empty() && candidate.session != sessions_[s].name) return std::nullopt;
  Candidate own = candidate;
  own.name = shared_name(candidate);
  own.session.clear();
  if (own.kind == CandidateKind::kPlace) return own;
  if (const Candidate* listed = named(listed_[s], own.name)) {
    own.effect = listed->effect;
    own.least_statistic = listed->least_statistic;
    return own;
  }
  // Terms by which a name's size may vary are listed nowhere.
  const bool varies = own.kind == CandidateKind::kGrammar && named(listed_[s], own.hook) != nullptr;
  return varies ? std::optional(own) : std::nullopt;
}

CauseModel SessionsProblem::of(const CauseModel& model, std::size_t session) const {
  CauseModel own = states_of(model).of[session];
  own.accepted.clear();
  for (const Accepted& a : model.accepted)
    if (auto candidate = in(session, a.candidate))
      own.accepted.push_back({std::move(*candidate), a.size});
  return own;
}

std::vector<Eigen::Index> SessionsProblem::sizes_in(std::size_t s, const CauseModel& model) const {
  std::vector<Eigen::Index> sizes;
  Eigen::Index at = 0;
  for (const Accepted& a : model.accepted) {
    const bool own = in(s, a.candidate).has_value();
    for (Eigen::Index k = 0; k < a.size.size(); ++k, ++at)
      if (own) sizes.push_back(at);
  }
  return sizes;
}

std::vector<Candidate> SessionsProblem::candidates(const CauseModel& model) const {
  std::vector<Candidate> all;
  std::map<std::string, std::size_t> of_all;  // position of each name
  std::map<std::string, std::vector<std::size_t>> sessions_with;
  std::vector<Candidate> places;
  for (std::size_t s = 0; s < sessions_.size(); ++s)
    for (const Candidate& c : sessions_[s].problem->candidates(of(model, s))) {
      if (c.kind == CandidateKind::kPlace) {
        places.push_back(of_session(c, sessions_[s].name));
        continue;
      }
      const auto [at, fresh] = of_all.try_emplace(c.name, all.size());
      if (fresh) {
        all.push_back(c);
      } else {
        Candidate& shared = all[at->second];
        shared.has_mean = shared.has_mean && c.has_mean;
        shared.least_statistic += c.least_statistic;
      }
      if (c.kind == CandidateKind::kNamed) sessions_with[c.name].push_back(s);
    }
  const std::size_t shared = all.size();
  for (std::size_t i = 0; i < shared; ++i)
    for (const std::size_t s : sessions_with[all[i].name]) {
      if (sessions_with[all[i].name].size() < 2) break;  // of one drive alone anyway
      Candidate own = of_session(all[i], sessions_[s].name);
      own.least_statistic = in(s, own)->least_statistic;
      all.push_back(own);
    }
  all.insert(all.end(), places.begin(), places.end());
  return all;
}

std::optional<std::vector<SharedSide>> SessionsProblem::columns_of(
    const Candidate& candidate, const std::vector<Projection>& own) const {
  std::vector<SharedSide> columns;
  for (std::size_t s = 0; s < own.size(); ++s) {
    const auto mine = in(s, candidate);
    if (!mine) continue;
    const auto& list = own[s].candidates;
    const auto shown = std::find_if(list.begin(), list.end(),
                                    [&](const Candidate& c) { return is_same(c, *mine); });
    if (shown == list.end()) continue;
    if (columns.empty()) columns.assign(shown->columns.size(), SharedSide(own.size(), -1));
    if (columns.size() != shown->columns.size()) return std::nullopt;
    for (std::size_t k = 0; k < columns.size(); ++k)
      columns[k][s] = static_cast<long>(1 + shown->columns[k]);
  }
  return columns.empty() ? std::nullopt : std::optional(columns);
}

std::vector<Projection> SessionsProblem::each_projected(
    const CauseModel& model, const std::vector<Candidate>& candidates) const {
  std::vector<Projection> own;
  for (std::size_t s = 0; s < sessions_.size(); ++s) {
    std::vector<Candidate> asked;
    std::set<std::string> names;
    for (const Candidate& c : candidates)
      if (auto mine = in(s, c);
          mine && (mine->kind == CandidateKind::kPlace || names.insert(mine->name).second))
        asked.push_back(std::move(*mine));
    own.push_back(sessions_[s].problem->project(of(model, s), std::move(asked)));
  }
  return own;
}

Projection SessionsProblem::project(const CauseModel& model,
                                    std::vector<Candidate> candidates) const {
  const std::vector<Projection> own = each_projected(model, candidates);
  Projection joint;
  joint.accepted = static_cast<std::size_t>(sizes_of(model).size());
  SharedSides sides(sessions_.size(), joint.accepted);
  std::vector<const Innovations*> rows;
  for (std::size_t s = 0; s < own.size(); ++s) {
    const std::vector<Eigen::Index> mine = sizes_in(s, model);
    for (std::size_t k = 0; k < mine.size(); ++k)
      sides.set_accepted(s, static_cast<std::size_t>(mine[k]), k);
    rows.push_back(&own[s].innovations);
  }
  for (Candidate& c : candidates) {
    const auto columns = columns_of(c, own);
    if (!columns) continue;
    c.columns.clear();
    for (const SharedSide& column : *columns) c.columns.push_back(sides.column(column));
    joint.candidates.push_back(std::move(c));
  }
  joint.innovations = joined_rows(rows, sides.all(), sessions_.front().problem->channels().size());
  return joint;
}

void SessionsProblem::fit(CauseModel& model, int iterations) const {
  const std::size_t n = sessions_.size();
  Eigen::VectorXd tau(sizes_of(model).size());
  Eigen::Index at = 0;
  for (const Accepted& a : model.accepted)
    for (Eigen::Index k = 0; k < a.size.size(); ++k) tau[at++] = a.candidate.tau;
  SizeExchange exchange(n, tau);
  std::vector<CauseModel> own;
  for (std::size_t s = 0; s < n; ++s) own.push_back(of(model, s));
  // One step each, so that all have spoken; then to the end.
  for (const bool first : {true, false})
    for (std::size_t s = 0; s < n; ++s) {
      const std::vector<Eigen::Index> mine = sizes_in(s, model);
      const SizePrior others = exchange.others(s, mine, first);
      sessions_[s].problem->fit_beside(own[s], first ? 1 : iterations, others);
      exchange.hear(s, mine, own[s].information, sizes_of(own[s]), others);
    }
  model.information = exchange.information();
  const Eigen::VectorXd sizes = exchange.sizes();
  at = 0;
  for (Accepted& a : model.accepted) {
    a.size = sizes.segment(at, a.size.size());
    at += a.size.size();
  }
  for (std::size_t s = 0; s < n; ++s) move_places(own[s], sessions_[s].name, model);
  model.log_likelihood = 0.0;
  for (const CauseModel& m : own) model.log_likelihood += m.log_likelihood;
  model.state = std::make_shared<SessionStates>(std::move(own));
}

}  // namespace roadbook
