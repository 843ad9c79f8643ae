#include "diagnosis/friction_problem.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "diagnosis/friction_places.hpp"
#include "diagnosis/friction_variance.hpp"
#include "diagnosis/score_table.hpp"
#include "diagnosis/sequential_projection.hpp"

namespace roadbook {
namespace {

using Eigen::Index;

std::string metres(double value) {
  const std::string text = std::to_string(value);
  return text.substr(0, text.find('.') + 2) + " m";
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
    residual(i, 0) =
        readings_.samples[static_cast<std::size_t>(i)].friction - mean.row(i).dot(noise.mean);
  const Innovations e = innovations(readings_, classes_, cells_, noise, residual);
  const Eigen::VectorXd values = Eigen::Map<const Eigen::VectorXd>(e.values.data(), mean.rows());
  const auto places = resurfaced_places(readings_, classes_, cells_, values, 1);
  return places.empty() ? Candidate{}
                        : resurfaced_near(readings_, classes_, values, places.front());
}

FrictionNoise FrictionProblem::nominal_noise() const {
  const std::vector<Candidate> named = friction_effects(readings_);
  const FrictionMean mean = mean_columns(named);
  const auto flat = static_cast<Index>(classes_.labels.size());
  FrictionNoise smooth = friction_noise(readings_.samples, cells_, mean, flat);
  if (smooth.place_sd == 0.0 || !library_.places || left_out("friction0.extra_class"))
    return smooth;
  // Another surface somewhere looks like a bias of places until it has its own mean.
  const Candidate place = best_place(friction_noise(readings_.samples, cells_, mean, flat, false));
  if (place.name.empty()) return smooth;
  FrictionMean split(mean.rows(), mean.cols() + 1);
  split << friction_columns(readings_, classes_, place), mean;
  FrictionNoise beside = friction_noise(readings_.samples, cells_, split, flat + 1);
  const double price = place.penalty + 0.5 * std::log(static_cast<double>(mean.rows()));
  return beside.log_likelihood - price > smooth.log_likelihood ? beside : smooth;
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
  if (library_.places) {
    const Innovations e = project(model, {}).innovations;
    Eigen::VectorXd residual(static_cast<Index>(e.of.size()));
    for (std::size_t i = 0; i < e.of.size(); ++i) residual[static_cast<Index>(i)] = e.row(i)[0];
    for (const Candidate& place : resurfaced_places(readings_, classes_, cells_, residual, 2))
      all.push_back(resurfaced_near(readings_, classes_, residual, place));
  }
  std::erase_if(all, [&](const Candidate& c) { return left_out(c.name); });
  return all;
}

Projection FrictionProblem::project(const CauseModel& model,
                                    std::vector<Candidate> candidates) const {
  std::vector<Eigen::MatrixXd> parts;
  Eigen::VectorXd residual(static_cast<Index>(rows()));
  for (std::size_t i = 0; i < rows(); ++i)
    residual[static_cast<Index>(i)] = readings_.samples[i].friction;
  Projection projection;
  for (const Accepted& a : model.accepted) {
    parts.push_back(friction_columns(readings_, classes_, a.candidate));
    residual -= parts.back() * a.size;
    projection.accepted += static_cast<std::size_t>(parts.back().cols());
  }
  std::size_t next = projection.accepted;
  for (Candidate& c : candidates) {
    Eigen::MatrixXd columns = friction_columns(readings_, classes_, c);
    if (columns.isZero(0.0)) continue;
    c.columns.clear();
    for (Index k = 0; k < columns.cols(); ++k) c.columns.push_back(next++);
    projection.candidates.push_back(c);
    parts.push_back(std::move(columns));
  }
  FrictionMean sides(residual.size(), static_cast<Index>(1 + next));
  sides.col(0) = residual;
  Index at = 1;
  for (const Eigen::MatrixXd& part : parts) {
    sides.middleCols(at, part.cols()) = part;
    at += part.cols();
  }
  projection.innovations = innovations(readings_, classes_, cells_, noise_, sides);
  return projection;
}

void FrictionProblem::fit(CauseModel& model, int /*iterations*/) const {
  const Projection projection = project(model, {});
  const auto n = static_cast<Index>(projection.accepted);
  const Innovations& e = projection.innovations;
  Eigen::MatrixXd F = Eigen::MatrixXd::Zero(n, n);
  Eigen::VectorXd u = Eigen::VectorXd::Zero(n);
  double squares = 0.0;
  for (std::size_t i = 0; i < e.of.size(); ++i) {
    const Eigen::Map<const Eigen::VectorXd> column(e.row(i) + 1, n);
    F.noalias() += column * column.transpose();
    u += column * e.row(i)[0];
    squares += e.row(i)[0] * e.row(i)[0];
  }
  Eigen::MatrixXd held = F;
  held.diagonal() *= 1.0 + 1e-10;
  const Eigen::VectorXd step = n > 0 ? Eigen::VectorXd(held.ldlt().solve(u)) : u;
  Index at = 0;
  for (Accepted& a : model.accepted) {
    a.size += step.segment(at, a.size.size());
    at += a.size.size();
  }
  model.information = F;
  model.log_likelihood = -0.5 * (squares - u.dot(step));
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
  std::erase_if(causes, [&](const NoiseCause& c) { return left_out(c.effect); });
  std::stable_sort(causes.begin(), causes.end(), [](const NoiseCause& a, const NoiseCause& b) {
    return std::abs(a.z) > std::abs(b.z);
  });
  return causes;
}

std::string FrictionProblem::note(const Accepted& cause) const {
  const Candidate& c = cause.candidate;
  if (c.kind != CandidateKind::kPlace) return {};
  return "ground labelled " + std::to_string(classes_.labels[c.effect]) + " within " +
         metres(c.place_radius) + " of x = " + metres(c.place_x) + ", y = " + metres(c.place_y);
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
  const Eigen::VectorXd values = friction_covariate(readings_.samples, name);
  for (const Innovation& i : innovations.of) {
    const FrictionSample& s = readings_.samples[i.row];
    result.values.push_back(cause.kind == CandidateKind::kPlace
                                ? std::hypot(s.x - cause.place_x, s.y - cause.place_y)
                                : values[static_cast<Index>(i.row)]);
  }
  return result;
}

}  // namespace roadbook
