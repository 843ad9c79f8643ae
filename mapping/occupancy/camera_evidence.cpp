#include "mapping/occupancy/camera_evidence.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>
#include <utility>

#include "mapping/occupancy/cell_rules.hpp"
#include "mapping/occupancy/patch_grid.hpp"

namespace roadbook {
namespace {

// A landmark in a cell of the map, in the first patch that saw it there.
struct CellEvent {
  std::int32_t column = 0;
  std::int32_t row = 0;
  std::size_t patch = 0;
  bool raised = false;
  float weight = 1.0F;
};

std::int32_t cell_of(double p_m, double cell_m) {
  return static_cast<std::int32_t>(std::floor(p_m / cell_m));
}

// Number of the patch of each view.
std::vector<std::size_t> patches_of(std::span<const SightKeyframe> views, double patch_m) {
  constexpr double kGap_m = 2.0;
  std::vector<std::size_t> patch(views.size(), 0);
  double driven = 0.0;
  for (std::size_t i = 1; i < views.size(); ++i) {
    const double step = (views[i].origin - views[i - 1].origin).norm();
    driven += step;
    const bool next = driven >= patch_m || step > kGap_m;
    patch[i] = patch[i - 1] + (next ? 1 : 0);
    if (next) driven = 0.0;
  }
  return patch;
}

void add_low(const CameraSight& sight,
             std::size_t patch,
             double cell_m,
             std::vector<CellEvent>& out) {
  const Eigen::Vector2d way = sight.low - sight.p;
  const int steps = std::max(1, static_cast<int>(std::ceil(2.0 * way.norm() / cell_m)));
  for (int i = 0; i <= steps; ++i) {
    const Eigen::Vector2d p = sight.p + way * (static_cast<double>(i) / steps);
    out.push_back({cell_of(p.x(), cell_m), cell_of(p.y(), cell_m), patch, false, 1.0F});
  }
}

// The cells in which the landmark may lie, with their probabilities.
void add_raised(const CameraSight& sight,
                std::size_t patch,
                double cell_m,
                std::vector<CellEvent>& out) {
  constexpr double kLeast = 0.05;  // smaller probabilities are left out
  const Eigen::Matrix2d covariance =
      sight.covariance + Eigen::Matrix2d::Identity() * (cell_m * cell_m / 12.0);
  const Eigen::Matrix2d information = covariance.inverse();
  const double density =
      cell_m * cell_m / (6.283185307179586 * std::sqrt(covariance.determinant()));
  const int reach =
      static_cast<int>(std::ceil(3.0 * std::sqrt(covariance.diagonal().maxCoeff()) / cell_m));
  const std::int32_t column = cell_of(sight.p.x(), cell_m), row = cell_of(sight.p.y(), cell_m);
  for (int r = row - reach; r <= row + reach; ++r)
    for (int c = column - reach; c <= column + reach; ++c) {
      const Eigen::Vector2d d = cell_m * Eigen::Vector2d(c + 0.5, r + 0.5) - sight.p;
      const double weight = std::min(1.0, density * std::exp(-0.5 * d.dot(information * d)));
      if (weight >= kLeast) out.push_back({c, r, patch, true, static_cast<float>(weight)});
    }
}

// All events, each landmark once in a cell.
std::vector<CellEvent> events_of(std::span<const CameraSight> sights,
                                 const std::vector<std::size_t>& patch_of_view,
                                 double cell_m) {
  std::vector<CellEvent> events;
  std::vector<CellEvent> own;
  const auto place = [](const CellEvent& e) { return std::pair(e.row, e.column); };
  for (std::size_t i = 0; i < sights.size();) {
    own.clear();
    const int landmark = sights[i].landmark;
    if (sights[i].raised) add_raised(sights[i], patch_of_view[sights[i].view], cell_m, own);
    for (; i < sights.size() && sights[i].landmark == landmark; ++i)
      if (!sights[i].raised) add_low(sights[i], patch_of_view[sights[i].view], cell_m, own);
    std::sort(own.begin(), own.end(), [&](const CellEvent& a, const CellEvent& b) {
      return std::tuple(place(a), a.patch) < std::tuple(place(b), b.patch);
    });
    const auto last =
        std::unique(own.begin(), own.end(),
                    [&](const CellEvent& a, const CellEvent& b) { return place(a) == place(b); });
    events.insert(events.end(), own.begin(), last);
  }
  return events;
}

std::vector<CellSights> counts_of(std::vector<CellEvent> events) {
  std::stable_sort(events.begin(), events.end(), [](const CellEvent& a, const CellEvent& b) {
    return std::pair(a.row, a.column) < std::pair(b.row, b.column);
  });
  std::vector<CellSights> counts;
  for (std::size_t i = 0; i < events.size(); ++i) {
    if (i == 0 || events[i].row != events[i - 1].row || events[i].column != events[i - 1].column)
      counts.emplace_back();
    (events[i].raised ? counts.back().raised : counts.back().low) +=
        static_cast<double>(events[i].weight);
  }
  return counts;
}

PatchGrid grid_of(std::span<const CellEvent> events, const SightRates& rates, double cell_m) {
  Eigen::Vector2d least = Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector2d most = -least;
  const auto middle = [&](const CellEvent& e) {
    return Eigen::Vector2d(cell_m * (e.column + 0.5), cell_m * (e.row + 0.5));
  };
  for (const CellEvent& e : events) {
    least = least.cwiseMin(middle(e));
    most = most.cwiseMax(middle(e));
  }
  PatchGrid grid(CellShape::over(least, most, cell_m));
  for (const CellEvent& e : events) {
    const Eigen::Vector2d p = (middle(e) - grid.low) / cell_m;
    const std::size_t i =
        grid.index(static_cast<int>(std::floor(p.x())), static_cast<int>(std::floor(p.y())));
    grid.cells[i].change += e.weight * static_cast<float>(rates.change(e.raised));
    grid.cells[i].seen += e.weight;
    if (e.raised && e.weight >= 0.5F) ++grid.hits[i];
  }
  // The grid counts whole sights. Less than half a sight does not make a cell known.
  for (std::size_t i = 0; i < grid.cells.size(); ++i) {
    OccupancyCell& cell = grid.cells[i];
    if (cell.seen < 0.5F)
      cell = {};
    else
      cell.seen = std::max(1.0F, std::round(cell.seen));
  }
  return grid;
}

// Probability that the cell is occupied, given its counts.
double occupied_given(const SightRates& rates, const CellSights& cell) {
  return probability_of(log_odds(rates.occupied) + cell.raised * rates.change(true) +
                        cell.low * rates.change(false));
}

}  // namespace

double SightRates::change(bool raised) const {
  return raised ? std::log(raised_if_occupied / raised_if_free)
                : std::log((1.0 - raised_if_occupied) / (1.0 - raised_if_free));
}

bool SightRates::shows_obstacles() const {
  return occupied_given(*this, {.raised = 1.0, .low = 0.0}) > 0.5;
}

double SightRates::temper() const {
  // n dependent sights have the variance of n / dispersion = 1 + (n - 1) t independent ones.
  if (sights_a_cell <= 1.0) return 1.0;
  return std::clamp((sights_a_cell / dispersion - 1.0) / (sights_a_cell - 1.0), 0.001, 1.0);
}

std::optional<SightRates> fit_sight_rates(std::span<const CellSights> cells) {
  double raised = 0.0, low = 0.0, sights2 = 0.0;
  for (const CellSights& c : cells) {
    raised += c.raised;
    low += c.low;
    sights2 += (c.raised + c.low) * (c.raised + c.low);
  }
  if (!(raised >= 1.0) || !(low >= 1.0)) return std::nullopt;
  SightRates rates{0.9, 0.02, std::clamp(raised / (raised + low), 0.001, 0.5), 1.0,
                   sights2 / (raised + low)};
  constexpr int kMostSteps = 500;
  constexpr double kSame = 1e-7;
  double chi2 = 0.0, expected = 0.0;
  for (int step = 0; step < kMostSteps; ++step) {
    double all = 0.0, hit = 0.0, all_free = 0.0, hit_free = 0.0, occupied = 0.0;
    chi2 = expected = 0.0;
    for (const CellSights& c : cells) {
      const double p = occupied_given(rates, c);
      const double n = c.raised + c.low;
      occupied += p;
      all += p * n;
      hit += p * c.raised;
      all_free += (1.0 - p) * n;
      hit_free += (1.0 - p) * c.raised;
      for (const auto& [share, rate] :
           {std::pair(p, rates.raised_if_occupied), std::pair(1.0 - p, rates.raised_if_free)}) {
        chi2 += share * (c.raised - n * rate) * (c.raised - n * rate);
        expected += share * n * rate * (1.0 - rate);
      }
    }
    const SightRates before = rates;
    rates.raised_if_occupied = (hit + 1.0) / (all + 2.0);
    rates.raised_if_free = (hit_free + 1.0) / (all_free + 2.0);
    rates.occupied = (occupied + 1.0) / (static_cast<double>(cells.size()) + 2.0);
    if (std::abs(rates.raised_if_occupied - before.raised_if_occupied) < kSame &&
        std::abs(rates.raised_if_free - before.raised_if_free) < kSame &&
        std::abs(rates.occupied - before.occupied) < kSame)
      break;
  }
  if (rates.raised_if_occupied <= rates.raised_if_free) return std::nullopt;
  rates.dispersion = std::max(1.0, chi2 / std::max(expected, 1e-12));
  return rates;
}

std::optional<CameraPatches> build_camera_patches(std::span<const SightKeyframe> views,
                                                  std::span<const CameraSight> sights,
                                                  const std::vector<PatchAnchor>& anchors,
                                                  const std::string& drive,
                                                  const BuildPatchesOptions& options) {
  options.check();
  const auto patch_of_view = patches_of(views, options.patch_m);
  auto events = events_of(sights, patch_of_view, options.cell_m);
  const auto rates = fit_sight_rates(counts_of(events));
  if (!rates) return std::nullopt;
  std::stable_sort(events.begin(), events.end(),
                   [](const CellEvent& a, const CellEvent& b) { return a.patch < b.patch; });
  CameraPatches result{*rates, {}};
  result.built.updates = events.size();
  const std::span<const CellEvent> all(events);
  for (std::size_t first = 0, last = 0; first < events.size(); first = last) {
    const std::size_t number = events[first].patch;
    while (last < events.size() && events[last].patch == number) ++last;
    const auto begin = std::lower_bound(patch_of_view.begin(), patch_of_view.end(), number);
    const auto end = std::upper_bound(begin, patch_of_view.end(), number);
    const auto from = static_cast<std::size_t>(begin - patch_of_view.begin());
    const auto to = static_cast<std::size_t>(end - patch_of_view.begin());
    OccupancyPatch patch =
        cropped_patch(grid_of(all.subspan(first, last - first), *rates, options.cell_m));
    if (patch.columns == 0) continue;
    hang_on(anchors[views[from + (to - from) / 2].anchor], patch);
    patch.drive = drive;
    patch.begin_ns = views[from].t_ns;
    patch.end_ns = views[to - 1].t_ns;
    result.built.patches.push_back(std::move(patch));
  }
  return result;
}

}  // namespace roadbook
