#include "diagnosis/friction/friction_problem.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/friction/friction_innovations.hpp"
#include "diagnosis/friction/friction_places.hpp"
#include "diagnosis/friction/friction_variance.hpp"
#include "diagnosis/inference/linear_fit.hpp"

namespace roadbook {
namespace {

using Eigen::Index;

std::vector<Candidate> place_discs(const CauseModel& model) {
  std::vector<Candidate> discs;
  for (const Accepted& a : model.accepted)
    if (a.candidate.kind == CandidateKind::kPlace) discs.push_back(a.candidate);
  return discs;
}

}  // namespace

FrictionProblem::FrictionProblem(FrictionReadings readings, LibraryOptions library)
    : readings_(std::move(readings)),
      library_(std::move(library)),
      classes_(surface_classes(readings_.samples)) {
  std::vector<Eigen::Vector2d> places;
  for (const FrictionSample& s : readings_.samples) places.emplace_back(s.x, s.y);
  cells_ = place_cells(places);
  bases_ = std::make_shared<PlaceBases>(cells_);
  noise_ = nominal_noise();
}

bool FrictionProblem::left_out(const std::string& name) const {
  return std::find(library_.without.begin(), library_.without.end(), name) !=
         library_.without.end();
}

std::vector<ChannelName> FrictionProblem::channels() const { return {{"friction0", "friction"}}; }

CauseModel FrictionProblem::nominal() const {
  CauseModel model;
  model.state = std::make_shared<CauseState>();
  fit(model, 1);
  return model;
}

std::vector<Candidate> FrictionProblem::candidates(const CauseModel& model) const {
  std::vector<Candidate> all;
  if (library_.named) all = friction_effects(readings_);
  if (library_.grammar)
    for (const Candidate& c : friction_grammar(readings_, classes_)) all.push_back(c);
  if (looks_for_surfaces()) {
    const Innovations e = project(model, {}).innovations;
    Eigen::VectorXd residual(static_cast<Index>(e.of.size()));
    for (std::size_t i = 0; i < e.of.size(); ++i) residual[static_cast<Index>(i)] = e.row(i)[0];
    const std::vector<Candidate> discs = place_discs(model);
    for (const Candidate& place : resurfaced_places(readings_, classes_, cells_, residual, 2))
      if (!touches_disc(discs, place)) all.push_back(place);
  }
  std::erase_if(all, [&](const Candidate& c) { return left_out(c.name); });
  return all;
}

Projection FrictionProblem::project(const CauseModel& model,
                                    std::vector<Candidate> candidates) const {
  Eigen::VectorXd residual(static_cast<Index>(rows()));
  for (std::size_t i = 0; i < rows(); ++i)
    residual[static_cast<Index>(i)] = readings_.samples[i].friction;
  return linear_projection(
      model, std::move(candidates), std::move(residual),
      [&](const Candidate& c) { return friction_columns(readings_, classes_, c); },
      [&](const Eigen::MatrixXd& sides) {
        return friction_innovations(readings_, classes_, cells_, noise_, sides);
      });
}

void FrictionProblem::fit(CauseModel& model, int iterations) const {
  fit_beside(model, iterations, {});
}

void FrictionProblem::fit_beside(CauseModel& model, int iterations, const SizePrior& others) const {
  linear_fit(project(model, {}), model, others);
  // Only discs are nonlinear.
  for (int i = 1; i < iterations; ++i) {
    constexpr double kBetter = 0.1;  // [nats]
    CauseModel moved = model;
    if (!move_discs(moved)) return;
    linear_fit(project(moved, {}), moved, others);
    if (moved.log_likelihood < model.log_likelihood + kBetter) return;
    model = std::move(moved);
  }
}

// Refines each disc with everything else in the model.
bool FrictionProblem::move_discs(CauseModel& model) const {
  const std::vector<Candidate> before = place_discs(model);
  if (before.empty()) return false;
  const Projection p = project(model, {});
  std::size_t side = 1;
  for (Accepted& a : model.accepted) {
    if (a.candidate.kind == CandidateKind::kPlace) {
      Eigen::VectorXd without(static_cast<Index>(rows()));
      for (std::size_t i = 0; i < rows(); ++i)
        without[static_cast<Index>(i)] =
            p.innovations.row(i)[0] + a.size[0] * p.innovations.row(i)[side];
      a.candidate = moved_surface(readings_, classes_, without, a.candidate);
    }
    side += static_cast<std::size_t>(a.size.size());
  }
  const std::vector<Candidate> after = place_discs(model);
  return !std::equal(before.begin(), before.end(), after.begin(), [](const auto& a, const auto& b) {
    return a.place_x == b.place_x && a.place_y == b.place_y && a.place_radius == b.place_radius;
  });
}

std::vector<Candidate> FrictionProblem::refinements(const CauseModel& /*model*/,
                                                    const Candidate& place) const {
  return {place};  // candidates are refined already
}

std::vector<NoiseCause> FrictionProblem::noise_causes(const CauseModel& model) const {
  FrictionMean mean = mean_columns({});
  for (const Accepted& a : model.accepted) {
    const Eigen::MatrixXd columns = friction_columns(readings_, classes_, a.candidate);
    mean.conservativeResize(Eigen::NoChange, mean.cols() + columns.cols());
    mean.rightCols(columns.cols()) = columns;
  }
  const FrictionNoise noise =
      friction_noise(readings_.samples, *bases_, mean, mean.cols(), library_.places);
  FrictionMean residual(mean.rows(), 1);
  for (Index i = 0; i < mean.rows(); ++i)
    residual(i, 0) =
        readings_.samples[static_cast<std::size_t>(i)].friction - mean.row(i).dot(noise.mean);
  const Innovations e = friction_innovations(readings_, classes_, cells_, noise, residual);
  std::vector<NoiseCause> causes = noise_parts(noise);
  for (const NoiseCause& c : variance_causes(readings_.samples, e)) causes.push_back(c);
  // Inferred surfaces already contain part of the spatial bias.
  std::erase_if(causes, [&](const NoiseCause& c) {
    return left_out(c.effect) || (!readings_.has_surface && c.effect == "friction0.spatial_bias");
  });
  std::stable_sort(causes.begin(), causes.end(), [](const NoiseCause& a, const NoiseCause& b) {
    return std::abs(a.z) > std::abs(b.z);
  });
  return causes;
}

std::string FrictionProblem::note(const Accepted& cause) const {
  const Candidate& c = cause.candidate;
  if (c.kind != CandidateKind::kPlace) return {};
  return "ground labelled " + std::to_string(classes_.labels[c.effect]) + " " + place_text(c);
}

RowCovariate FrictionProblem::covariate(const CauseModel& /*model*/,
                                        const Candidate& cause,
                                        const Innovations& innovations) const {
  RowCovariate result{"time [s]", {}};
  std::string name = cause.covariate;
  if (cause.name == "friction0.slip_bias") name = "friction in use";
  if (cause.name == "friction0.speed_bias") name = "speed";
  if (cause.name == "friction0.temperature") name = "temperature";
  if (!name.empty()) result.axis = name;
  if (cause.kind == CandidateKind::kPlace) result.axis = "distance from the place [m]";
  Eigen::VectorXd values = friction_covariate(readings_.samples, name);
  for (const ColumnCovariate& column : readings_.columns) {
    if (column.name() != name) continue;
    result.axis = column.axis();
    for (Index k = 0; k < values.size(); ++k)
      values[k] =
          column.at(readings_.samples[static_cast<std::size_t>(k)].t_s).value_or(column.mean());
  }
  for (const Innovation& i : innovations.of) {
    const FrictionSample& s = readings_.samples[i.row];
    result.values.push_back(cause.kind == CandidateKind::kPlace
                                ? std::hypot(s.x - cause.place_x, s.y - cause.place_y)
                                : values[static_cast<Index>(i.row)]);
  }
  return result;
}

}  // namespace roadbook
