#include "diagnosis/inference/cause_problem.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"

namespace roadbook {
namespace {

std::string metres(double value) {
  const std::string text = std::to_string(value);
  return text.substr(0, text.find('.') + 2) + " m";
}

// The channel in which the candidate's columns are largest.
std::size_t telling_channel(const Projection& p, std::size_t channels) {
  std::vector<double> weight(std::max<std::size_t>(channels, 1), 0.0);
  for (std::size_t i = 0; i < p.innovations.of.size(); ++i)
    for (const std::size_t column : p.candidates.front().columns)
      weight[p.innovations.of[i].channel] += std::pow(p.innovations.row(i)[1 + column], 2);
  return static_cast<std::size_t>(std::max_element(weight.begin(), weight.end()) - weight.begin());
}

std::vector<EvidenceValue> values_of(const Innovations& in,
                                     const RowCovariate& x,
                                     std::size_t channel) {
  ROADBOOK_ASSERT(x.values.size() == in.of.size());
  std::vector<EvidenceValue> values;
  for (std::size_t i = 0; i < in.of.size(); ++i)
    if (in.of[i].channel == channel) values.emplace_back(x.values[i], in.row(i)[0]);
  return values;
}

}  // namespace

std::string shared_name(const Candidate& c) {
  return c.session.empty() ? c.name : c.name.substr(0, c.name.size() - c.session.size() - 4);
}

bool holds(const std::vector<std::string>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string place_text(const Candidate& place) {
  return "within " + metres(place.place_radius) + " of x = " + metres(place.place_x) +
         ", y = " + metres(place.place_y);
}

const Candidate* named(const std::vector<Candidate>& all, const std::string& name) {
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const Candidate& c) { return c.name == name; });
  return found == all.end() ? nullptr : &*found;
}

Candidate of_session(Candidate candidate, const std::string& session) {
  candidate.name += " in " + session;
  candidate.session = session;
  return candidate;
}

bool is_local(const Candidate& c) {
  return c.kind == CandidateKind::kPlace || c.covariate == "place" || c.covariate == "time";
}

std::vector<Candidate> CauseProblem::refinements(const CauseModel&, const Candidate&) const {
  return {};
}

std::vector<Candidate> CauseProblem::variations(const CauseModel&, const Candidate&) const {
  return {};
}

std::vector<NoiseCause> CauseProblem::noise_causes(const CauseModel&) const { return {}; }

std::string CauseProblem::separating(const CauseModel& /*model*/,
                                     std::size_t /*a*/,
                                     const std::vector<Candidate>& /*alternatives*/,
                                     double /*threshold*/) const {
  return {};
}

void CauseProblem::fit_beside(CauseModel&, int, const SizePrior&) const {
  ROADBOOK_ASSERT(!"a problem that several drives share");
}

std::string CauseProblem::note(const Accepted&) const { return {}; }

RowCovariate CauseProblem::covariate(const CauseModel&,
                                     const Candidate&,
                                     const Innovations& innovations) const {
  RowCovariate time{"time [s]", {}};
  for (const Innovation& i : innovations.of) time.values.push_back(i.t_s);
  return time;
}

EvidencePlot CauseProblem::evidence(const CauseModel& nominal,
                                    const CauseModel& extended,
                                    const Candidate& cause) const {
  EvidencePlot plot;
  const Projection before = project(nominal, {cause});
  if (before.candidates.empty()) return plot;
  const std::vector<ChannelName> names = channels();
  const std::size_t channel = telling_channel(before, names.size());
  plot.channel = names[channel].stream + " " + names[channel].channel;
  const Innovations after = project(extended, {}).innovations;
  const RowCovariate x = covariate(nominal, cause, before.innovations);
  plot.covariate = x.axis;
  plot.bins = evidence_bins(values_of(before.innovations, x, channel),
                            values_of(after, covariate(extended, cause, after), channel));
  return plot;
}

Eigen::VectorXd sizes_of(const CauseModel& model) {
  Eigen::Index count = 0;
  for (const Accepted& a : model.accepted) count += a.size.size();
  Eigen::VectorXd sizes(count);
  Eigen::Index at = 0;
  for (const Accepted& a : model.accepted) {
    sizes.segment(at, a.size.size()) = a.size;
    at += a.size.size();
  }
  return sizes;
}

void accept(CauseModel& model, const Candidate& candidate) {
  model.accepted.push_back(
      {candidate, Eigen::VectorXd::Zero(static_cast<Eigen::Index>(candidate.columns.size()))});
}

void drop(CauseModel& model, std::size_t a) {
  model.accepted.erase(model.accepted.begin() + static_cast<std::ptrdiff_t>(a));
}

}  // namespace roadbook
