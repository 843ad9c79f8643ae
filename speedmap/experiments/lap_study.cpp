#include "speedmap/experiments/lap_study.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/text.hpp"
#include "base/text_file.hpp"
#include "roadnet/paths/path_fit.hpp"
#include "speedmap/property_map/gaussian_process.hpp"
#include "speedmap/property_map/property_map.hpp"

namespace roadbook {
namespace {

constexpr double kHalfWidth = 8.0;
constexpr double kHistory = 100.0;
constexpr int kHorizon = 80;

struct Row {
  double t, x, y, vx, roll;
};

std::vector<Row> read_rows(const std::filesystem::path& csv) {
  require_regular_file(csv, "a table");
  std::ifstream in(csv);
  if (!in)
    throw BadInput(Problem{Severity::kError, csv.string(), 0, "", "no such file", "a table"});
  std::vector<Row> rows;
  std::int64_t line = 0;
  for (std::string text; std::getline(in, text);) {
    ++line;
    if (text.empty() || text.front() == '#') continue;
    const auto fields = split(text);
    std::vector<double> v;
    for (const auto field : fields)
      if (const auto number = parse_double(field)) v.push_back(*number);
    if (v.size() != fields.size() || v.size() < 15)
      throw BadInput(Problem{Severity::kError, csv.string(), line, "row",
                             std::to_string(v.size()) + " numbers", "15 or more"});
    if (v[3] > 3.0) rows.push_back({v[0], v[1], v[2], v[3], v[14]});
  }
  return rows;
}

// First rows of the rounds: where the start is passed again after 500 m.
std::vector<std::size_t> lap_starts(const std::vector<Row>& rows) {
  // A place well into the recording, where the car is at speed.
  const std::size_t first = rows.size() / 8;
  std::vector<std::size_t> starts = {first};
  double travelled = 0.0;
  for (std::size_t i = first + 1; i + 1 < rows.size(); ++i) {
    travelled += std::hypot(rows[i].x - rows[i - 1].x, rows[i].y - rows[i - 1].y);
    const auto distance = [&](std::size_t k) {
      return std::hypot(rows[k].x - rows[first].x, rows[k].y - rows[first].y);
    };
    if (travelled > 500.0 && distance(i) < 15.0 && distance(i) <= distance(i + 1)) {
      starts.push_back(i);
      travelled = 0.0;
    }
  }
  return starts;
}

std::vector<LapSample> samples_of(const std::vector<Row>& rows,
                                  std::size_t begin,
                                  std::size_t end,
                                  const PathFrame& frame) {
  std::vector<LapSample> samples;
  PathCursor cursor;
  for (std::size_t i = begin; i < end; ++i) {
    const PathProjection at = frame.project({rows[i].x, rows[i].y}, cursor);
    if (!at.inside()) continue;
    samples.push_back({rows[i].t, {at.s_m, at.e_m}, rows[i].roll});
  }
  return samples;
}

PropertyMap empty_map(double length_m) {
  KnotGridOptions grid;
  grid.length_m = length_m;
  grid.closed = true;
  grid.e_min_m = -kHalfWidth;
  grid.e_max_m = kHalfWidth;
  grid.spacing_s_m = 3.0;
  grid.spacing_e_m = 2.0 * kHalfWidth;  // a lap gives two values a metre: none to spare across
  grid.width = {6.0, 4.0 * kHalfWidth};
  PropertyMapPrior prior;
  PropertyPrior roll;
  roll.name = "roll";
  roll.unit = "deg";
  roll.min = -15.0;
  roll.max = 15.0;
  for (const double level : {-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0}) {
    prior.classes.push_back("level");
    prior.counts.push_back(0.02);  // a knot gets some ten values a lap
    roll.classes.push_back({level, 20.0, 3.0, 0.3});
  }
  prior.properties.push_back(roll);
  PropertyMapOptions options;
  options.gate_counts = 0.0;       // no camera: the values alone tell the classes
  options.prior_mean_sigma = 0.0;  // levels must stay apart
  return {Knots::grid(grid), prior, options};
}

// Last values of the lap before index `now`, within the history.
std::vector<LapSample> lap_before(const std::vector<LapSample>& lap, std::size_t now) {
  std::vector<LapSample> result;
  for (std::size_t i = 0; i < now; ++i)
    if (lap[now].place.s_m - lap[i].place.s_m < kHistory && lap[i].place.s_m < lap[now].place.s_m)
      result.push_back(lap[i]);
  return result;
}

GaussianProcess process_of(const std::vector<LapSample>& samples) {
  std::vector<PathPlace> places;
  std::vector<double> values;
  for (const LapSample& sample : samples) {
    places.push_back(sample.place);
    values.push_back(sample.roll_deg);
  }
  return GaussianProcess::fit(places, values, {2, 40});
}

}  // namespace

LapData read_laps(const std::filesystem::path& csv) {
  const std::vector<Row> rows = read_rows(csv);
  const auto starts = rows.size() > 100 ? lap_starts(rows) : std::vector<std::size_t>{};
  if (starts.size() < 3)
    throw BadInput(Problem{Severity::kError, csv.string(), 0, "laps",
                           std::to_string(starts.empty() ? 0 : starts.size() - 1), "2 full ones"});
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = starts[0]; i < starts[1]; ++i) {
    const Eigen::Vector3d p(rows[i].x, rows[i].y, 0.0);
    if (points.empty() || (p - points.back()).norm() > 2.0) points.push_back(p);
  }
  if ((points.back() - points.front()).norm() < 2.0) points.pop_back();
  PathFitOptions fit;
  fit.closed = true;
  fit.segments = 80;
  fit.smooth_below_m = 20.0;
  const PathFrame frame(PathCurve(fit_path(points, fit).path), Tube{-kHalfWidth, kHalfWidth});
  return {samples_of(rows, starts[0], starts[1], frame),
          samples_of(rows, starts[1], starts[2], frame), frame.curve().length_m()};
}

std::vector<LapScore> run_lap_study(const LapData& laps, int num_threads) {
  std::vector<LapScore> scores = {{"property map", {}},
                                  {"KF on the last 100 m", {}},
                                  {"GP on the last 100 m", {}},
                                  {"GP on the first lap around the horizon", {}},
                                  {"first lap's nearest value", {}}};
  PropertyMap map = empty_map(laps.length_m);
  for (const LapSample& sample : laps.first) map.add_value(0, sample.place, sample.roll_deg);

  // Horizons every 50 m. The map predicts in the order of time, and continues to learn meanwhile.
  struct Horizon {
    std::size_t now;
    std::vector<LapSample> ahead;
    std::vector<double> map;
  };
  std::vector<Horizon> horizons;
  double next = kHistory;
  for (std::size_t i = 0; i < laps.second.size(); ++i) {
    const double s0 = laps.second[i].place.s_m;
    if (s0 >= next && s0 + kHorizon < laps.length_m) {
      next = s0 + 50.0;
      Horizon horizon{i, {}, {}};
      for (std::size_t k = i + 1; k < laps.second.size(); ++k) {
        const LapSample& sample = laps.second[k];
        if (sample.place.s_m <= s0 || sample.place.s_m > s0 + kHorizon) continue;
        const auto moments = map.moments(0, sample.place);
        if (!moments) continue;
        horizon.ahead.push_back(sample);
        horizon.map.push_back(moments->mean);
      }
      if (!horizon.ahead.empty()) horizons.push_back(std::move(horizon));
    }
    map.add_value(0, laps.second[i].place, laps.second[i].roll_deg);
  }

  for (LapScore& score : scores) score.mean_abs.assign(horizons.size(), 0.0);
  parallel_for(horizons.size(), num_threads, [&](std::size_t h) {
    const Horizon& horizon = horizons[h];
    const auto history = lap_before(laps.second, horizon.now);
    std::vector<double> values;
    for (const LapSample& sample : history) values.push_back(sample.roll_deg);
    const double kalman = kalman_constant(values, 0.2, 0.05).mean;
    const GaussianProcess recent = process_of(history);
    const double s0 = laps.second[horizon.now].place.s_m;
    std::vector<LapSample> remembered;
    for (const LapSample& sample : laps.first)
      if (sample.place.s_m > s0 - 20.0 && sample.place.s_m < s0 + kHorizon + 20.0)
        remembered.push_back(sample);
    const GaussianProcess memory = process_of(remembered);
    for (std::size_t k = 0; k < horizon.ahead.size(); ++k) {
      const LapSample& want = horizon.ahead[k];
      const auto nearest =
          std::min_element(remembered.begin(), remembered.end(), [&](const auto& a, const auto& b) {
            return std::abs(a.place.s_m - want.place.s_m) < std::abs(b.place.s_m - want.place.s_m);
          });
      const double got[] = {horizon.map[k], kalman, recent.predict(want.place).mean,
                            memory.predict(want.place).mean, nearest->roll_deg};
      for (std::size_t m = 0; m < scores.size(); ++m)
        scores[m].mean_abs[h] +=
            std::abs(got[m] - want.roll_deg) / static_cast<double>(horizon.ahead.size());
    }
  });
  return scores;
}

}  // namespace roadbook
