#include "roadnet/paths/path_tube.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

#include "base/error.hpp"
#include "roadnet/paths/path_clearance.hpp"

namespace roadbook {
namespace {

struct Stretch {
  double begin = 0.0;
  double end = 0.0;
};

// Runs of samples whose flag is set, as stretches of s; a run over the seam of a ring is one.
std::vector<Stretch> runs(const std::vector<bool>& flags, double step_m, bool closed) {
  std::vector<Stretch> found;
  const std::size_t n = flags.size();
  for (std::size_t i = 0; i < n; ++i) {
    if (!flags[i]) continue;
    if (i == 0 || !flags[i - 1]) found.push_back({step_m * static_cast<double>(i), 0.0});
    found.back().end = step_m * static_cast<double>(i);
  }
  if (closed && found.size() > 1 && flags.front() && flags.back()) {
    found.front().begin = found.back().begin;
    found.pop_back();
  }
  return found;
}

bool within(const Stretch& stretch, double s) {
  return stretch.begin <= stretch.end ? s >= stretch.begin && s <= stretch.end
                                      : s >= stretch.begin || s <= stretch.end;
}

// Stretches bent as tightly as the limit. Samples a twentieth of the limit's radius apart cannot
// skip a bend that matters: to turn by a tenth of a radian takes two of them.
void add_bends(const PathCurve& curve, double e_max, std::vector<TubeViolation>& violations) {
  const double limit = 1.0 / e_max;
  const int steps =
      std::max(8, static_cast<int>(std::ceil(curve.length_m() / std::min(0.05 * e_max, 0.5))));
  const double step = curve.length_m() / steps;
  std::vector<double> size;
  for (int i = 0; i < steps + (curve.closed() ? 0 : 1); ++i)
    size.push_back(std::abs(curve.at(step * i).curvature));
  std::vector<bool> tight(size.size());
  for (std::size_t i = 0; i < size.size(); ++i) tight[i] = size[i] >= limit;
  // A peak between two samples that are near the limit.
  for (std::size_t i = 1; i + 1 < size.size(); ++i) {
    const bool peak = size[i] >= size[i - 1] && size[i] >= size[i + 1];
    if (tight[i] || !peak || size[i] < 0.5 * limit) continue;
    const double s = step * static_cast<double>(i);
    tight[i] = std::abs(curvature_peak(curve, s - step, s + step, step).curvature) >= limit;
  }
  for (const Stretch& run : runs(tight, step, curve.closed())) {
    const double end = run.end >= run.begin ? run.end : run.end + curve.length_m();
    const CurvaturePeak peak =
        curvature_peak(curve, curve.closed() ? run.begin - step : std::max(0.0, run.begin - step),
                       curve.closed() ? end + step : std::min(curve.length_m(), end + step), step);
    TubeViolation v{TubeCondition::kCurvature,
                    run.begin,
                    run.end,
                    curve.wrapped(peak.s_m),
                    curve.wrapped(peak.s_m),
                    std::abs(peak.curvature),
                    limit,
                    {}};
    v.position = curve.at(v.s_m).position;
    violations.push_back(v);
  }
}

void add_meetings(const PathCurve& curve,
                  const NearPairs& pairs,
                  double e_max,
                  std::vector<TubeViolation>& violations) {
  for (const Stretch& run : runs(pairs.sample_near, pairs.step_m, curve.closed())) {
    const NearPair* worst = nullptr;
    for (const NearPair& pair : pairs.worst)
      if (within({run.begin - pairs.step_m, run.end + pairs.step_m}, pair.s_m) &&
          (worst == nullptr || pair.distance_m < worst->distance_m))
        worst = &pair;
    if (worst == nullptr) continue;  // pairs kept apart along the path by less than they must be
    violations.push_back({TubeCondition::kClearance, run.begin, run.end, worst->s_m,
                          worst->other_s_m, worst->distance_m, 2.0 * e_max,
                          curve.at(worst->s_m).position});
  }
}

// A foot point is the only one where the path bends gently for pi e_max to both sides and no other
// part of the path comes near (proof of Lemma 1, read place by place).
std::vector<bool> safe_pieces(const PathCurve& curve,
                              const NearPairs& pairs,
                              const std::vector<TubeViolation>& violations,
                              double e_max) {
  std::vector<bool> safe(curve.pieces().size(), true);
  for (std::size_t i = 0; i < pairs.sample_maybe_near.size(); ++i) {
    if (!pairs.sample_maybe_near[i]) continue;
    for (const double shift : {-pairs.step_m, 0.0, pairs.step_m})
      safe[curve.piece_at(curve.wrapped(pairs.step_m * static_cast<double>(i) + shift))] = false;
  }
  for (std::size_t k = 0; k < safe.size(); ++k) {
    const PathPiece& piece = curve.pieces()[k];
    const double reach = std::numbers::pi * e_max + 1.0;
    for (const TubeViolation& v : violations) {
      if (v.condition != TubeCondition::kCurvature) continue;
      const Stretch bend{v.s_begin_m, v.s_end_m};
      const double end = piece.s_begin_m + piece.length_m;
      if (within(bend, piece.s_begin_m) || within(bend, end) ||
          curve.distance_along(piece.s_begin_m, bend.end) < reach ||
          curve.distance_along(end, bend.begin) < reach ||
          within({piece.s_begin_m, end}, bend.begin))
        safe[k] = false;
    }
  }
  return safe;
}

}  // namespace

double Tube::half_width_m() const { return std::max(std::abs(e_min_m), std::abs(e_max_m)); }

void Tube::check() const {
  if (!(std::isfinite(e_min_m) && e_min_m <= 0.0))
    throw InvalidOption("e_min_m", std::to_string(e_min_m), "0 or less: the right side");
  if (!(std::isfinite(e_max_m) && e_max_m >= 0.0))
    throw InvalidOption("e_max_m", std::to_string(e_max_m), "0 or more: the left side");
  if (half_width_m() < 0.01)
    throw InvalidOption("tube", std::to_string(half_width_m()), "a half width of 0.01 m or more");
}

std::string TubeViolation::text() const {
  std::array<char, 200> line{};
  const bool bend = condition == TubeCondition::kCurvature;
  std::snprintf(line.data(), line.size(), "s %.2f m (%.2f, %.2f): ", s_m, position.x(),
                position.y());
  std::string text = line.data();
  if (bend)
    std::snprintf(line.data(), line.size(), "curvature: got %.4f 1/m, want less than %.4f", got,
                  limit);
  else
    std::snprintf(line.data(), line.size(),
                  "distance to s %.2f m: got %.3f m, want more than %.3f m", other_s_m, got, limit);
  return text + line.data();
}

TubeCheck check_tube(const PathCurve& curve, const Tube& tube) {
  tube.check();
  const double e_max = tube.half_width_m();
  TubeCheck check;
  add_bends(curve, e_max, check.violations);
  const NearPairs pairs = near_pairs(curve, 2.0 * e_max, std::numbers::pi * e_max);
  add_meetings(curve, pairs, e_max, check.violations);
  check.safe_piece = safe_pieces(curve, pairs, check.violations, e_max);
  return check;
}

void require_one_to_one(const TubeCheck& check, const std::string& name) {
  std::vector<Problem> problems;
  for (const TubeViolation& v : check.violations)
    problems.push_back({Severity::kError, "", 0, name, v.text(),
                        "a tube that does not touch or fold onto itself"});
  if (!problems.empty()) throw BadInput(problems);
}

double widest_tube_m(const PathCurve& curve, double most_m, double step_m) {
  const auto fits = [&](double e) { return check_tube(curve, {-e, e}).one_to_one(); };
  if (fits(most_m)) return most_m;
  double good = 0.0;
  double bad = most_m;
  while (bad - good > step_m) {
    const double middle = 0.5 * (good + bad);
    (fits(middle) ? good : bad) = middle;
  }
  return good;
}

}  // namespace roadbook
