#include "diagnosis/friction_problem.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/friction_places.hpp"
#include "diagnosis/friction_variance.hpp"
#include "diagnosis/linear_fit.hpp"
#include "diagnosis/sequential_projection.hpp"

namespace roadbook {
namespace {

using Eigen::Index;

// A sliver along the edge of a disc that was found is part of the same surface.
bool touches_accepted(const CauseModel& model, const Candidate& place) {
  return std::any_of(model.accepted.begin(), model.accepted.end(), [&](const Accepted& a) {
    const Candidate& c = a.candidate;
    return c.kind == CandidateKind::kPlace && c.effect == place.effect &&
           std::hypot(c.place_x - place.place_x, c.place_y - place.place_y) <
               1.2 * (c.place_radius + place.place_radius);
  });
}

// Residual readings and columns with the unknowns taken out and the noise made white.
Innovations innovations(const FrictionReadings& readings,
                        const SurfaceClasses& classes,
                        const PlaceCells& cells,
                        const FrictionNoise& noise,
                        const FrictionMean& sides) {
  const auto classes_count = static_cast<Index>(classes.labels.size());
  const Index terms = noise.place_terms.cols();
  constexpr double kClassPrior = 4.0;  // variance of a class's mean: friction is of order 1
  Eigen::VectorXd prior = Eigen::VectorXd::Ones(classes_count + terms);
  prior.head(classes_count).setConstant(kClassPrior);
  SequentialProjection projection(prior, sides.cols());
  const ReadingNoise own = reading_noise(readings.samples, noise);
  const double fresh = std::sqrt(1.0 - noise.correlation * noise.correlation);
  Innovations result;
  result.sides = static_cast<std::size_t>(sides.cols());
  result.values.reserve(readings.samples.size() * result.sides);
  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(prior.size()), last_unknowns = unknowns;
  Eigen::RowVectorXd row(sides.cols()), last_row = row;
  for (std::size_t i = 0; i < readings.samples.size(); ++i) {
    const double weight = 1.0 / own.sigma[i];
    Eigen::VectorXd at = Eigen::VectorXd::Zero(prior.size());
    at[static_cast<Index>(classes.of[i])] = weight;
    if (terms > 0) at.tail(terms) = weight * noise.place_terms.row(static_cast<Index>(cells.of[i]));
    const Eigen::RowVectorXd now = weight * sides.row(static_cast<Index>(i));
    const bool goes_on = own.goes_on[i] && noise.correlation != 0.0;
    unknowns = goes_on ? ((at - noise.correlation * last_unknowns) / fresh).eval() : at;
    row = goes_on ? ((now - noise.correlation * last_row) / fresh).eval() : now;
    last_unknowns = at;
    last_row = now;
    const double variance = projection.next(unknowns, row);
    result.of.push_back({i, 0, readings.samples[i].t_s, variance});
    result.values.insert(result.values.end(), row.data(), row.data() + row.size());
  }
  return result;
}

}  // namespace

FrictionProblem::FrictionProblem(FrictionReadings readings, LibraryOptions library)
    : readings_(std::move(readings)),
      library_(std::move(library)),
      classes_(surface_classes(readings_.samples)) {
  std::vector<Eigen::Vector2d> places;
  for (const FrictionSample& s : readings_.samples) places.emplace_back(s.x, s.y);
  cells_ = place_cells(places);
  noise_ = nominal_noise();
}

bool FrictionProblem::left_out(const std::string& name) const {
  return std::find(library_.without.begin(), library_.without.end(), name) !=
         library_.without.end();
}

std::vector<ChannelName> FrictionProblem::channels() const { return {{"friction0", "friction"}}; }

FrictionMean FrictionProblem::mean_columns(const std::vector<Candidate>& beside) const {
  const auto n = static_cast<Index>(readings_.samples.size());
  const auto k = static_cast<Index>(classes_.labels.size());
  FrictionMean mean = FrictionMean::Zero(n, k + static_cast<Index>(beside.size()));
  for (Index i = 0; i < n; ++i)
    mean(i, static_cast<Index>(classes_.of[static_cast<std::size_t>(i)])) = 1.0;
  for (std::size_t c = 0; c < beside.size(); ++c)
    mean.col(k + static_cast<Index>(c)) =
        beside[c].tau * friction_columns(readings_, classes_, beside[c]).col(0);
  return mean;
}

Candidate FrictionProblem::best_place(const FrictionNoise& noise) const {
  const FrictionMean mean = mean_columns(friction_effects(readings_));
  FrictionMean residual(mean.rows(), 1);
  for (Index i = 0; i < mean.rows(); ++i)
    residual(i, 0) = readings_.samples[static_cast<std::size_t>(i)].friction -
                     mean.row(i).dot(noise.mean.tail(mean.cols()));
  const Innovations e = innovations(readings_, classes_, cells_, noise, residual);
  const Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(e.values.data(), mean.rows());
  const auto places = resurfaced_places(readings_, classes_, cells_, values, 1);
  return places.empty() ? Candidate{} : places.front();
}

FrictionNoise FrictionProblem::nominal_noise() const {
  const std::vector<Candidate> named = friction_effects(readings_);
  const FrictionMean mean = mean_columns(named);
  const auto flat = static_cast<Index>(classes_.labels.size());
  FrictionNoise smooth = friction_noise(readings_.samples, cells_, mean, flat);
  if (!looks_for_surfaces() || left_out("friction0.extra_class")) return smooth;
  // Another surface somewhere looks like a bias of places, or like outliers, until it has its own
  // mean: it is looked for with all readings of full weight first, then with the outliers that are
  // left beside it.
  FrictionNoise without = friction_noise(readings_.samples, cells_, mean, flat, false);
  without.outlier_part.assign(readings_.samples.size(), 0.0);
  const auto beside = [&](const Candidate& place, bool places) {
    FrictionMean split(mean.rows(), mean.cols() + 1);
    split << friction_columns(readings_, classes_, place), mean;
    return friction_noise(readings_.samples, cells_, split, flat + 1, places);
  };
  Candidate place = best_place(without);
  if (place.name.empty()) return smooth;
  place = best_place(beside(place, false));
  if (place.name.empty()) return smooth;
  FrictionNoise split = beside(place, smooth.place_sd > 0.0);
  const double price = place.penalty + 0.5 * std::log(static_cast<double>(mean.rows()));
  return split.log_likelihood - price > smooth.log_likelihood ? split : smooth;
}

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
    for (const Candidate& place : resurfaced_places(readings_, classes_, cells_, residual, 2))
      if (!touches_accepted(model, place)) all.push_back(place);
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
        return innovations(readings_, classes_, cells_, noise_, sides);
      });
}

void FrictionProblem::fit(CauseModel& model, int iterations) const {
  fit_beside(model, iterations, {});
}

void FrictionProblem::fit_beside(CauseModel& model,
                                 int /*iterations*/,
                                 const SizePrior& others) const {
  linear_fit(project(model, {}), model, others);
}

std::vector<Candidate> FrictionProblem::refinements(const CauseModel& /*model*/,
                                                    const Candidate& place) const {
  return {place};  // discs come refined from `candidates`
}

std::vector<NoiseCause> FrictionProblem::noise_causes(const CauseModel& model) const {
  FrictionMean mean = mean_columns({});
  for (const Accepted& a : model.accepted) {
    const Eigen::MatrixXd columns = friction_columns(readings_, classes_, a.candidate);
    mean.conservativeResize(Eigen::NoChange, mean.cols() + columns.cols());
    mean.rightCols(columns.cols()) = columns;
  }
  const FrictionNoise noise =
      friction_noise(readings_.samples, cells_, mean, mean.cols(), library_.places);
  FrictionMean residual(mean.rows(), 1);
  for (Index i = 0; i < mean.rows(); ++i)
    residual(i, 0) =
        readings_.samples[static_cast<std::size_t>(i)].friction - mean.row(i).dot(noise.mean);
  const Innovations e = innovations(readings_, classes_, cells_, noise, residual);
  std::vector<NoiseCause> causes = noise_parts(noise);
  for (const NoiseCause& c : variance_causes(readings_.samples, e)) causes.push_back(c);
  // Of surfaces that the readings themselves told apart, their bias of places is a part.
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
