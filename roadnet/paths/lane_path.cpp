#include "roadnet/paths/lane_path.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "roadnet/lane_samples.hpp"
#include "roadnet/paths/path_fit.hpp"
#include "roadnet/paths/path_frame.hpp"
#include "roadnet/samples.hpp"

namespace roadbook {
namespace {

constexpr double kPassStep_m = 0.5;  // between the positions of a pass that count
constexpr double kCentreWeight =
    0.1;  // of a point of the polyline: it decides where nothing else does
constexpr double kSamePoint_m = 1e-6;
constexpr double kStretch_m = 1.0;  // over which deviations are averaged
// Smoothing of the rounds in which the positions are given to the path anew, in units of the last:
// kinks of the polyline must be gone before projection on the path means something.
constexpr double kFitRounds[] = {2.5, 1.6, 1.0, 1.0};
constexpr double kWeaker = 0.8;

// Points with their places along the lane.
struct LaneData {
  std::vector<Eigen::Vector3d> points;
  std::vector<double> t;
  std::vector<double> weights;

  void add(const Eigen::Vector3d& p, double at, double weight) {
    points.push_back(p);
    t.push_back(at);
    weights.push_back(weight);
  }
};

// The polyline without repetitions; a ring without its repeated first point.
std::vector<Eigen::Vector3d> distinct_points(const Lane& lane) {
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& p : lane.centre) {
    if (!p.allFinite())
      throw BadInput(Problem{Severity::kError, "", 0, "lane " + std::to_string(lane.id),
                             "a point that is not finite", "metres"});
    if (points.empty() || (p - points.back()).head<2>().norm() > kSamePoint_m) points.push_back(p);
  }
  while (lane.closed && points.size() > 1 &&
         (points.back() - points.front()).head<2>().norm() <= kSamePoint_m)
    points.pop_back();
  return points;
}

// Everything by the share of the way along the polyline. First and last point are the lane's ends.
LaneData by_polyline(const std::vector<Eigen::Vector3d>& centre,
                     const Lane& lane,
                     const LaneSamples& samples,
                     double& t_end) {
  LaneData data;
  std::vector<double> s{0.0};
  for (std::size_t i = 0; i + 1 < centre.size(); ++i)
    s.push_back(s.back() + (centre[i + 1] - centre[i]).head<2>().norm());
  t_end = s.back() + (lane.closed ? (centre.front() - centre.back()).head<2>().norm() : 0.0);
  for (std::size_t i = 0; i + 1 < centre.size(); ++i) data.add(centre[i], s[i], kCentreWeight);
  for (std::size_t i = 0; i < samples.points.size(); ++i)
    data.add(samples.points[i], samples.share[i] * t_end, 1.0);
  data.add(centre.back(), s.back(), kCentreWeight);
  return data;
}

// The same points by projection on a path; those it does not know the place of are left out.
LaneData by_path(const LaneData& data, const PathFrame& frame) {
  const double length = frame.curve().length_m();
  LaneData moved;
  PathCursor cursor;
  for (std::size_t i = 0; i < data.points.size(); ++i) {
    const bool end = !frame.curve().closed() && (i == 0 || i + 1 == data.points.size());
    if (end) {
      moved.add(data.points[i], i == 0 ? 0.0 : length, data.weights[i]);
      continue;
    }
    const auto at = frame.project(data.points[i].head<2>(), cursor);
    // At an end of the path rounding may put a point just beyond it.
    if (at.inside()) moved.add(data.points[i], std::clamp(at.s_m, 0.0, length), data.weights[i]);
  }
  return moved;
}

PathFrame fit_once(const LaneData& data,
                   double t_end,
                   bool closed,
                   double smooth_m,
                   double reach_m,
                   const LanePathOptions& options) {
  PathFitOptions fit;
  fit.degree = options.degree;
  fit.closed = closed;
  fit.pin_ends = !closed;
  fit.smooth_below_m = smooth_m;
  fit.segments = std::max(closed ? 3 : 1, static_cast<int>(std::ceil(t_end / options.segment_m)));
  const PathFit result = fit_path(data.points, data.t, t_end, fit, data.weights);
  return {PathCurve(result.path), {-reach_m, reach_m}};
}

// Distances of the driven positions from a path.
struct Beside {
  double worst_m = 0.0;
  double worst_s_m = 0.0;
  double variance = 0.0;  // [m^2]
};

Beside measure_beside(const LaneSamples& samples, const PathFrame& frame) {
  std::map<int, std::pair<double, int>> stretches;
  Beside beside;
  double sum2 = 0.0;
  int count = 0;
  PathCursor cursor;
  for (const Eigen::Vector3d& p : samples.points) {
    const auto at = frame.project(p.head<2>(), cursor);
    if (!at.inside()) continue;
    auto& [sum, n] = stretches[static_cast<int>(at.s_m / kStretch_m)];
    sum += at.e_m;
    ++n;
    sum2 += at.e_m * at.e_m;
    ++count;
  }
  for (const auto& [index, stretch] : stretches) {
    const double mean = std::abs(stretch.first / stretch.second);
    if (mean <= beside.worst_m) continue;
    beside.worst_m = mean;
    beside.worst_s_m = (index + 0.5) * kStretch_m;
  }
  if (count > 0) beside.variance = sum2 / count;
  return beside;
}

struct Fitted {
  PathFrame frame;
  Beside beside;
  CurvaturePeak peak;
};

Fitted fit_rounds(const LaneData& polyline,
                  double t_end,
                  const Lane& lane,
                  const LaneSamples& samples,
                  double smooth_m,
                  double reach_m,
                  const LanePathOptions& options) {
  LaneData data = polyline;
  double length_m = t_end;
  std::optional<PathFrame> frame;
  for (const double factor : kFitRounds) {
    if (frame) {
      data = by_path(polyline, *frame);
      length_m = frame->curve().length_m();
    }
    frame = fit_once(data, length_m, lane.closed, factor * smooth_m, reach_m, options);
  }
  const Beside beside = measure_beside(samples, *frame);
  const CurvaturePeak peak = curvature_peak(frame->curve(), 0.0, frame->curve().length_m(), 0.1);
  return {std::move(*frame), beside, peak};
}

// The smoothest path that follows the positions well enough; otherwise the one that follows best
// among those that a car can drive.
Fitted fit_lane(const std::vector<Eigen::Vector3d>& centre,
                const Lane& lane,
                const LaneSamples& samples,
                double reach_m,
                const LanePathOptions& options) {
  double t_end = 0.0;
  const LaneData data = by_polyline(centre, lane, samples, t_end);
  double smooth_m = options.smooth_below_m;
  Fitted best = fit_rounds(data, t_end, lane, samples, smooth_m, reach_m, options);
  while (best.beside.worst_m > options.max_deviation_m && smooth_m > options.least_smooth_m) {
    smooth_m *= kWeaker;
    Fitted next = fit_rounds(data, t_end, lane, samples, smooth_m, reach_m, options);
    if (std::abs(next.peak.curvature) > options.tightest_turn) break;
    if (next.beside.worst_m < best.beside.worst_m) best = std::move(next);
  }
  return best;
}

LanePath path_of(const Lane& lane,
                 const LaneSamples& samples,
                 double reach_m,
                 const LanePathOptions& options) {
  LanePath result;
  result.lane = lane.id;
  const auto centre = distinct_points(lane);
  if (centre.size() < (lane.closed ? 3U : 2U)) {
    result.status = LanePathStatus::kDegenerate;
    return result;
  }
  const Fitted fitted = fit_lane(centre, lane, samples, reach_m, options);
  const PathCurve& curve = fitted.frame.curve();
  result.path = curve.bezier();
  result.length_m = curve.length_m();
  result.deviation_m = fitted.beside.worst_m;
  result.deviation_s_m = fitted.beside.worst_s_m;
  result.max_curvature = std::abs(fitted.peak.curvature);
  result.max_curvature_s_m = fitted.peak.s_m;
  result.width_m = options.vehicle_width_m + 4.0 * std::sqrt(fitted.beside.variance);
  result.tube_m = widest_tube_m(curve, options.widest_tube_m);
  if (!(result.deviation_m <= options.max_deviation_m)) result.status = LanePathStatus::kDeviates;
  return result;
}

}  // namespace

void LanePathOptions::check() const {
  const auto positive = [](const char* field, double value) {
    if (!(std::isfinite(value) && value > 0.0))
      throw InvalidOption(field, std::to_string(value), "more than 0");
  };
  positive("max_deviation_m", max_deviation_m);
  positive("smooth_below_m", smooth_below_m);
  positive("least_smooth_m", least_smooth_m);
  positive("tightest_turn", tightest_turn);
  positive("segment_m", segment_m);
  positive("junction_m", junction_m);
  positive("vehicle_width_m", vehicle_width_m);
  positive("widest_tube_m", widest_tube_m);
  if (degree < kMinPathDegree || degree > kMaxPathDegree)
    throw InvalidOption("degree", std::to_string(degree), "3 to 9");
}

const char* to_text(LanePathStatus status) {
  switch (status) {
    case LanePathStatus::kOk:
      return "ok";
    case LanePathStatus::kDeviates:
      return "deviates";
    case LanePathStatus::kDegenerate:
      return "degenerate";
  }
  return "";
}

std::vector<LanePath> lane_paths(const RoadNetwork& network,
                                 const std::vector<DrivenPass>& passes,
                                 const LanePathOptions& options,
                                 int num_threads) {
  options.check();
  check_passes(passes);
  const double reach_m = network.reach_m > 0.0 ? network.reach_m : 3.0;
  const auto samples = samples_by_lane(network, passes, kPassStep_m, reach_m, options.junction_m);
  std::vector<LanePath> paths(network.lanes.size());
  parallel_for(paths.size(), num_threads, [&](std::size_t i) {
    paths[i] = path_of(network.lanes[i], samples[i], reach_m, options);
  });
  return paths;
}

}  // namespace roadbook
