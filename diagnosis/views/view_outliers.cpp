#include "diagnosis/views/view_outliers.hpp"

#include <algorithm>
#include <cmath>

#include "base/index.hpp"
#include "base/parallel.hpp"
#include "diagnosis/numerics/student_noise.hpp"

namespace roadbook {
namespace {

// A landmark is inconsistent if more than this share of its views is off: its track joins several
// corners, or it moves. None of its views is used, because the seemingly good ones are biased.
constexpr double kConsistent = 0.1;
constexpr double kOff = 4.5;  // [sigma]
constexpr int kFewestGood = 4;

void drop_inconsistent(const std::vector<double>& errors,
                       const std::vector<double>& sigma_px,
                       const ViewData& all,
                       std::vector<std::uint8_t>& good) {
  struct Count {
    int views = 0, off = 0, good = 0;
  };
  std::vector<Count> count(all.bundle.points.size());
  for (std::size_t o = 0; o < errors.size(); ++o) {
    const BundleObservation& seen = all.bundle.observations[o];
    ++count[at(seen.point)].views;
    const bool off = errors[o] < 0.0 || errors[o] > kOff * sigma_px[at(seen.camera)];
    count[at(seen.point)].off += off ? 1 : 0;
    count[at(seen.point)].good += good[o];
  }
  for (std::size_t o = 0; o < errors.size(); ++o) {
    const Count& c = count[at(all.bundle.observations[o].point)];
    if (c.off > std::max(1.0, kConsistent * c.views) || c.good < kFewestGood) good[o] = 0;
  }
}

}  // namespace

ViewData kept_views(const ViewData& data, const std::vector<std::uint8_t>& good) {
  ViewData some = data;
  some.bundle.observations.clear();
  for (std::size_t o = 0; o < good.size(); ++o)
    if (good[o] != 0) some.bundle.observations.push_back(data.bundle.observations[o]);
  return some;
}

std::vector<double> view_errors_px(const ViewData& data,
                                   const ViewBasis& basis,
                                   const ViewPoint& point,
                                   int num_threads) {
  BundleProblem problem = data.bundle;
  ViewPrediction(data, basis).apply(point, problem, num_threads);
  std::vector<double> errors(problem.observations.size());
  parallel_for_small(errors.size(), num_threads, [&](std::size_t i) {
    const BundleObservation& o = problem.observations[i];
    const BundleTerm term{o.pose, o.camera, -1, o.pixel, 1.0};
    const TermResidual e = term_residual(problem, term, point.state.poses[at(o.pose)],
                                         point.state.points[at(o.point)], false);
    errors[i] = e.valid ? e.r.norm() : -1.0;
  });
  return errors;
}

std::vector<std::uint8_t> views_within(const std::vector<double>& errors,
                                       const ViewData& data,
                                       double gate,
                                       const std::vector<double>& sigma_px) {
  std::vector<std::uint8_t> good(errors.size());
  for (std::size_t o = 0; o < errors.size(); ++o)
    good[o] =
        errors[o] >= 0.0 && errors[o] < gate * sigma_px[at(data.bundle.observations[o].camera)];
  return good;
}

std::vector<std::uint8_t> weigh_views(const std::vector<double>& errors,
                                      const std::vector<double>& sigma_px,
                                      const std::vector<double>& freedom,
                                      ViewData& all) {
  std::vector<std::uint8_t> good(errors.size());
  for (std::size_t o = 0; o < errors.size(); ++o) {
    BundleObservation& seen = all.bundle.observations[o];
    const double v = freedom[at(seen.camera)];
    const double square = std::pow(errors[o] / sigma_px[at(seen.camera)], 2);
    good[o] = errors[o] >= 0.0 && square < view_gate(v) * view_gate(v) ? 1 : 0;
    seen.sigma_px = 1.0 / std::sqrt(student_weight(square, v));
  }
  drop_inconsistent(errors, sigma_px, all, good);
  return good;
}

}  // namespace roadbook
