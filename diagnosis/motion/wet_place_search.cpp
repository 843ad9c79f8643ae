#include "diagnosis/motion/wet_place_search.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/cell_grid.hpp"
#include "diagnosis/motion/effect_columns.hpp"
#include "diagnosis/motion/motion_library.hpp"
#include "diagnosis/motion/regularised_effects.hpp"
#include "diagnosis/motion/wet_places.hpp"
#include "diagnosis/streams/normal_equations.hpp"

namespace roadbook {
namespace {

// What a slip of 1 during one step of the wheels adds to the score and to its information.
struct Push {
  double score = 0.0;
  double square = 0.0;
};

std::vector<Push> pushes(const Observations& obs, const MotionModel& model, const WheelSteps& s) {
  const Pass pass = run_pass(obs, model.point, model.noise, Columns{}, {true, 0, &model.inflation});
  const auto solution = pass.elimination.back_substitute({1.0});
  const auto first = obs.offsets();
  std::vector<Push> all(s.steps.size());
  const auto add = [&](std::size_t k, Channel channel, double moved, double sigma, double left) {
    sigma *= model.inflation[first[index_of(channel)] + k];
    all[k].score += left * moved / sigma;
    all[k].square += moved * moved / (sigma * sigma);
  };
  // The solution's walks begin at the end; the last one belongs to the last step.
  const std::size_t walks = solution.walk_residuals.size();
  for (std::size_t k = 0; k < std::min(walks, s.steps.size()); ++k) {
    const auto& left = solution.walk_residuals[walks - 1 - k];
    const double root = std::sqrt(std::abs(s.steps[k].distance_m) + 1e-6);
    add(k, Channel::kWheelDistance, s.steps[k].distance_m, model.noise.distance_per_sqrt_m * root,
        left[0]);
    if (obs.wheels_read == WheelsRead::kBoth)
      add(k, Channel::kWheelHeading, s.steps[k].turn_rad, model.noise.heading_per_sqrt_m * root,
          left[1]);
  }
  return all;
}

// The place with the largest statistic in addition to the catalogued effects, with its slip.
struct ScoredPlace {
  Accepted place;
  double statistic = 0.0;
};

ScoredPlace best_place(const Observations& obs,
                       const MotionModel& model,
                       const HeldEffects& s,
                       const std::vector<Candidate>& places) {
  const auto n = static_cast<Eigen::Index>(s.library.columns.count());
  Columns columns = s.library.columns;
  columns.append(candidate_columns(obs, model.point, places));
  const Innovations in =
      run_pass(obs, model.point, model.noise, columns, {false, 0, &model.inflation}).innovations;
  const Normal normal = normal_equations(in, columns.count());
  Eigen::MatrixXd held = normal.F.topLeftCorner(n, n);
  held.diagonal() += s.precision;
  const Eigen::MatrixXd across = normal.F.topRightCorner(n, normal.F.cols() - n);
  const Eigen::MatrixXd beside = held.ldlt().solve(across);
  ScoredPlace best;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto c = static_cast<Eigen::Index>(k);
    const double information = normal.F(n + c, n + c) - across.col(c).dot(beside.col(c));
    const double score = normal.u[n + c] - beside.col(c).dot(normal.u.head(n));
    if (!(score * score > best.statistic * information)) continue;
    best = {{places[k], Eigen::VectorXd::Constant(1, score / information)},
            score * score / information};
  }
  return best;
}

}  // namespace

std::vector<Candidate> shortlist_places(const Observations& obs,
                                        const MotionModel& model,
                                        const std::vector<Candidate>& places,
                                        std::size_t most) {
  if (places.size() <= most) return places;
  const WheelSteps wheels(obs, {smoothed(model.point.trajectory), model.point.effects, {}});
  const std::vector<Push> push = pushes(obs, model, wheels);
  CellGrid<std::size_t> steps(kPuddleRadius_m + 1.0);
  for (std::size_t k = 0; k < wheels.steps.size(); ++k)
    steps.insert({wheels.steps[k].x, wheels.steps[k].y}, k);
  std::vector<double> statistic;
  for (const Candidate& place : places) {
    double score = 0.0;
    double square = 0.0;
    steps.visit_near({place.place_x, place.place_y}, [&](std::size_t k) {
      const WheelSteps::Step& s = wheels.steps[k];
      const double away = std::hypot(s.x - place.place_x, s.y - place.place_y);
      const double share = share_inside(s, away, place.place_radius);
      score += share * push[k].score;
      square += share * share * push[k].square;
    });
    statistic.push_back(square > 0.0 ? score * score / square : 0.0);
  }
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return statistic[a] > statistic[b]; });
  order.resize(most);
  std::sort(order.begin(), order.end());
  std::vector<Candidate> shortlist;
  for (const std::size_t i : order) shortlist.push_back(places[i]);
  return shortlist;
}

std::vector<Accepted> slipping_places(const Observations& obs, const MotionModel& model) {
  constexpr std::size_t kMost = 3;
  constexpr double kSlipsClearly = 20.0;  // twice the log likelihood, beyond the count of places
  std::vector<Accepted> found;
  if (obs.wheels.size() < 2) return found;
  const std::vector<Candidate> all = wet_places(model.point.trajectory);
  const std::vector<Candidate> shortlist = shortlist_places(obs, model, all);
  while (!shortlist.empty()) {
    const HeldEffects beside = saturated_library(obs, model.point, found);
    const ScoredPlace coarse = best_place(obs, model, beside, shortlist);
    if (coarse.statistic < kSlipsClearly + 2.0 * shortlist.front().penalty) break;
    // That many places mean an error along the whole way (an axle without differential in every
    // bend of a race track).
    if (found.size() == kMost) return {};
    const ScoredPlace fine =
        best_place(obs, model, beside, places_near(obs, model.point, coarse.place.candidate));
    found.push_back((fine.statistic > coarse.statistic ? fine : coarse).place);
  }
  return found;
}

}  // namespace roadbook
