#include "speedmap/property_map/knots.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/require_option.hpp"

namespace roadbook {
namespace {

bool positive(double x) { return std::isfinite(x) && x > 0.0; }

// The place farthest from all knots of a grid is the middle of a cell: the kernel must reach it,
// or (6) would be 0/0 there.
bool leaves_holes(double spacing_s, double spacing_e, const KernelWidth& width) {
  return std::hypot(0.5 * spacing_s / width.s_m, 0.5 * spacing_e / width.e_m) >= 1.0;
}

}  // namespace

void KnotGridOptions::check() const {
  require_option(positive(length_m), "length_m", length_m, "a length above 0");
  require_option(std::isfinite(e_min_m), "e_min_m", e_min_m, "a finite number");
  require_option(std::isfinite(e_max_m) && e_max_m > e_min_m, "e_max_m", e_max_m,
                 "more than e_min_m");
  require_option(positive(spacing_s_m), "spacing_s_m", spacing_s_m, "a length above 0");
  require_option(positive(spacing_e_m), "spacing_e_m", spacing_e_m, "a length above 0");
  require_option(positive(width.s_m), "width.s_m", width.s_m, "a length above 0");
  require_option(positive(width.e_m), "width.e_m", width.e_m, "a length above 0");
  require_option(!leaves_holes(spacing_s_m, spacing_e_m, width), "width", width.s_m,
                 "more than half the diagonal of a grid cell");
  const double count = (length_m / spacing_s_m + 1.0) * ((e_max_m - e_min_m) / spacing_e_m + 1.0);
  require_option(count < 1e8, "spacing_s_m", spacing_s_m, "fewer than 1e8 knots");
}

Knots Knots::grid(const KnotGridOptions& options) {
  options.check();
  const double intervals_s =
      std::max(1.0, std::ceil(options.length_m / options.spacing_s_m - 1e-9));
  const double span_e = options.e_max_m - options.e_min_m;
  const double intervals_e = std::max(1.0, std::ceil(span_e / options.spacing_e_m - 1e-9));
  const int rows = static_cast<int>(intervals_s) + (options.closed ? 0 : 1);
  const int columns = static_cast<int>(intervals_e) + 1;
  std::vector<PathPlace> places;
  places.reserve(static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns));
  for (int i = 0; i < rows; ++i)
    for (int j = 0; j < columns; ++j)
      places.push_back(
          {options.length_m * i / intervals_s, options.e_min_m + span_e * j / intervals_e});
  return {std::move(places), options.width,
          options.closed ? std::optional<double>(options.length_m) : std::nullopt};
}

Knots::Knots(std::vector<PathPlace> places,
             const KernelWidth& width,
             std::optional<double> period_m)
    : places_(std::move(places)), width_(width), period_m_(period_m) {
  if (period_m_) rings_.push_back({0.0, *period_m_});
  check();
  hash();
}

Knots::Knots(std::vector<PathPlace> places, const KernelWidth& width, std::vector<KnotRing> rings)
    : places_(std::move(places)), width_(width), rings_(std::move(rings)) {
  check();
  hash();
}

void Knots::check() const {
  if (places_.empty()) throw InvalidOption("knots", "none", "at least one");
  require_option(positive(width_.s_m), "width.s_m", width_.s_m, "a length above 0");
  require_option(positive(width_.e_m), "width.e_m", width_.e_m, "a length above 0");
  for (const KnotRing& ring : rings_)
    require_option(ring.length_m >= 4.0 * width_.s_m && std::isfinite(ring.length_m), "period_m",
                   ring.length_m, "at least four kernel widths");
  for (const PathPlace& place : places_) {
    require_option(std::isfinite(place.s_m), "knots.s_m", place.s_m, "a finite number");
    require_option(std::isfinite(place.e_m), "knots.e_m", place.e_m, "a finite number");
  }
}

const KnotRing* Knots::ring_at(double s_m) const {
  if (rings_.empty()) return nullptr;
  if (period_m_) return &rings_.front();
  // Up to a kernel width beyond a ring's ends is still the ring.
  const auto after =
      std::upper_bound(rings_.begin(), rings_.end(), s_m + width_.s_m,
                       [](double s, const KnotRing& ring) { return s < ring.begin_m; });
  if (after == rings_.begin()) return nullptr;
  const KnotRing& ring = *(after - 1);
  return s_m < ring.begin_m + ring.length_m + width_.s_m ? &ring : nullptr;
}

double Knots::wrapped(const KnotRing& ring, double s_m) {
  const double along = s_m - ring.begin_m;
  const double s = along - ring.length_m * std::floor(along / ring.length_m);
  // A tiny negative number rounds up to the length itself.
  return ring.begin_m + (s < ring.length_m ? s : 0.0);
}

double Knots::difference_along(double s_m, double other_s_m) const {
  const double difference = s_m - other_s_m;
  const KnotRing* const ring = ring_at(s_m);
  return ring != nullptr ? difference - ring->length_m * std::round(difference / ring->length_m)
                         : difference;
}

std::size_t Knots::row_of(double s_m) const {
  const double row = (s_m - low_s_m_) * inverse_cell_s_;
  return row <= 0.0 ? 0 : std::min(rows_ - 1, static_cast<std::size_t>(row));
}

std::size_t Knots::column_of(double e_m) const {
  const double column = (e_m - low_e_m_) * inverse_cell_e_;
  return column <= 0.0 ? 0 : std::min(columns_ - 1, static_cast<std::size_t>(column));
}

void Knots::hash() {
  std::vector<Entry> unsorted;
  unsorted.reserve(places_.size());
  for (std::size_t l = 0; l < places_.size(); ++l) {
    const KnotRing* const ring = ring_at(places_[l].s_m);
    unsorted.push_back({ring != nullptr ? wrapped(*ring, places_[l].s_m) : places_[l].s_m,
                        places_[l].e_m, static_cast<std::int32_t>(l)});
  }
  const auto by_s = [](const Entry& a, const Entry& b) { return a.s_m < b.s_m; };
  const auto by_e = [](const Entry& a, const Entry& b) { return a.e_m < b.e_m; };
  const auto [first_s, last_s] = std::minmax_element(unsorted.begin(), unsorted.end(), by_s);
  const auto [first_e, last_e] = std::minmax_element(unsorted.begin(), unsorted.end(), by_e);
  low_s_m_ = first_s->s_m, high_s_m_ = last_s->s_m;
  low_e_m_ = first_e->e_m, high_e_m_ = last_e->e_m;

  // Half a kernel width a cell; larger where knots are so far apart that most cells would be empty.
  double cells_s = std::floor((high_s_m_ - low_s_m_) / (0.5 * width_.s_m)) + 1.0;
  double cells_e = std::floor((high_e_m_ - low_e_m_) / (0.5 * width_.e_m)) + 1.0;
  const double most = 8.0 * static_cast<double>(places_.size()) + 64.0;
  while (cells_s * cells_e > most) {
    cells_s = std::ceil(0.5 * cells_s);
    cells_e = std::ceil(0.5 * cells_e);
  }
  rows_ = static_cast<std::size_t>(cells_s);
  columns_ = static_cast<std::size_t>(cells_e);
  inverse_cell_s_ = high_s_m_ > low_s_m_ ? cells_s / (high_s_m_ - low_s_m_) : 1.0;
  inverse_cell_e_ = high_e_m_ > low_e_m_ ? cells_e / (high_e_m_ - low_e_m_) : 1.0;

  begin_.assign(rows_ * columns_ + 1, 0);
  const auto cell_of = [&](const Entry& e) { return row_of(e.s_m) * columns_ + column_of(e.e_m); };
  for (const Entry& entry : unsorted) ++begin_[cell_of(entry) + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  entries_.resize(unsorted.size());
  for (const Entry& entry : unsorted) entries_[next[cell_of(entry)]++] = entry;
}

}  // namespace roadbook
