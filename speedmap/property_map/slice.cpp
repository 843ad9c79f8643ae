#include "speedmap/property_map/slice.hpp"

#include <algorithm>
#include <cmath>

#include "base/digest.hpp"
#include "base/error.hpp"
#include "speedmap/property_map/blend.hpp"

namespace roadbook {

double PropertySlice::coverage() const {
  const auto seen = std::count_if(knots.begin(), knots.end(),
                                  [](const SliceKnot& knot) { return knot.evidence > 0.0; });
  return knots.empty() ? 0.0 : static_cast<double>(seen) / static_cast<double>(knots.size());
}

std::string PropertySlice::digest() const {
  Sha256 digest;
  digest.update(property).update(unit).update(s_begin_m).update(s_end_m);
  digest.update(width.s_m).update(width.e_m).update(period_m.value_or(0.0));
  for (const SliceKnot& knot : knots)
    for (const double x : {knot.s_m, knot.e_m, knot.mean, knot.variance, knot.evidence})
      digest.update(x);
  for (const std::string& name : classes) digest.update(name);
  for (const double share : shares) digest.update(share);
  return digest.hex();
}

void PropertySlice::check(const std::string& file) const {
  const auto fail = [&](const std::string& field, const std::string& got, const std::string& want) {
    throw BadInput(Problem{Severity::kError, file, 0, field, got, want});
  };
  if (!(std::isfinite(s_begin_m) && std::isfinite(s_end_m) && s_end_m > s_begin_m))
    fail("s_end_m", std::to_string(s_end_m), "a number above s_begin_m");
  for (const double w : {width.s_m, width.e_m})
    if (!(std::isfinite(w) && w > 0.0)) fail("kernel", std::to_string(w), "a width above 0");
  if (period_m && !(std::isfinite(*period_m) && *period_m >= s_end_m - s_begin_m))
    fail("period_m", std::to_string(*period_m), "at least the length of the slice");
  if (knots.empty()) fail("knots", "none", "at least one");
  if (shares.size() != knots.size() * classes.size())
    fail("knots", std::to_string(shares.size()) + " shares", "one for each knot and class");
  for (std::size_t i = 0; i < knots.size(); ++i) {
    const SliceKnot& knot = knots[i];
    const std::string field = "knots[" + std::to_string(i) + "]";
    for (const double x : {knot.s_m, knot.e_m, knot.mean, knot.evidence})
      if (!std::isfinite(x)) fail(field, std::to_string(x), "finite numbers");
    if (!(std::isfinite(knot.variance) && knot.variance > 0.0))
      fail(field + ".variance", std::to_string(knot.variance), "a number above 0");
    if (i > 0 && knot.s_m < knots[i - 1].s_m)
      fail(field + ".s", std::to_string(knot.s_m), "knots in the order of s");
  }
}

PropertySlice make_slice(const PropertyMap& map,
                         std::size_t property,
                         double s_begin_m,
                         double s_end_m,
                         const SliceSource& source) {
  const Knots& knots = map.knots();
  const KnotRing* const ring = knots.ring_at(s_begin_m);
  const std::optional<double> period =
      ring != nullptr ? std::optional(ring->length_m) : std::nullopt;
  if (!(std::isfinite(s_begin_m) && std::isfinite(s_end_m) && s_end_m > s_begin_m))
    throw InvalidOption("s_end_m", std::to_string(s_end_m), "a number above s_begin_m");
  if (period && s_end_m - s_begin_m > *period)
    throw InvalidOption("s_end_m", std::to_string(s_end_m), "at most once around the ring");
  if (property >= map.prior().properties.size())
    throw InvalidOption("property", std::to_string(property), "one of the map's");

  const PropertyPrior& about = map.prior().properties[property];
  PropertySlice slice{about.name,    about.unit, source, s_begin_m,           s_end_m,
                      knots.width(), period,     {},     map.prior().classes, {}};
  const double low = s_begin_m - knots.width().s_m;
  const double high = s_end_m + knots.width().s_m;
  // A knot may appear twice: a slice of nearly the whole ring meets itself.
  struct Taken {
    double s_m;
    std::size_t knot;
  };
  std::vector<Taken> taken;
  for (std::size_t l = 0; l < knots.size(); ++l) {
    double s = knots.places()[l].s_m;
    if (knots.ring_at(s) != ring) continue;  // of another path
    if (period) s -= *period * std::floor((s - low) / *period);
    for (; s <= high; s += *period) {
      if (s >= low) taken.push_back({s, l});
      if (!period) break;
    }
  }
  std::stable_sort(taken.begin(), taken.end(),
                   [](const Taken& a, const Taken& b) { return a.s_m < b.s_m; });
  std::vector<double> u(map.classes());
  for (const Taken& one : taken) {
    const PropertyMoments moments = map.knot_moments(property, one.knot);
    slice.knots.push_back({one.s_m, knots.places()[one.knot].e_m, moments.mean, moments.variance,
                           map.knot_evidence(one.knot)});
    map.knot_shares(one.knot, u);
    slice.shares.insert(slice.shares.end(), u.begin(), u.end());
  }
  if (slice.knots.empty())
    throw InvalidOption("s_begin_m", std::to_string(s_begin_m), "a range with knots");
  return slice;
}

struct SliceView::Impl {
  Knots knots;
  std::vector<PropertyMoments> at;
  double s_begin_m, s_end_m;
  std::optional<double> period_m;

  static Knots knots_of(const PropertySlice& slice) {
    std::vector<PathPlace> places;
    for (const SliceKnot& knot : slice.knots) places.push_back({knot.s_m, knot.e_m});
    return {std::move(places), slice.width, std::nullopt};
  }

  [[nodiscard]] std::optional<PathPlace> inside(PathPlace v) const {
    if (period_m) v.s_m -= *period_m * std::floor((v.s_m - s_begin_m) / *period_m);
    if (!(v.s_m >= s_begin_m && v.s_m <= s_end_m)) return std::nullopt;
    return v;
  }

  void gather(const Interpolation& near, std::vector<PropertyMoments>& moments) const {
    moments.clear();
    for (const std::int32_t knot : near.knots)
      moments.push_back(at[static_cast<std::size_t>(knot)]);
  }
};

SliceView::SliceView(const PropertySlice& slice) {
  slice.check("");
  auto impl = std::make_unique<Impl>(
      Impl{Impl::knots_of(slice), {}, slice.s_begin_m, slice.s_end_m, slice.period_m});
  for (const SliceKnot& knot : slice.knots) impl->at.push_back({knot.mean, knot.variance});
  impl_ = std::move(impl);
}

SliceView::~SliceView() = default;

std::optional<PropertyMoments> SliceView::moments(const PathPlace& v) const {
  thread_local Interpolation near;
  thread_local std::vector<PropertyMoments> at;
  const auto place = impl_->inside(v);
  if (!place) return std::nullopt;
  interpolate(impl_->knots, *place, near);
  if (!near.covered()) return std::nullopt;
  impl_->gather(near, at);
  return blend(near, at);
}

std::optional<PropertyMomentsDerivatives> SliceView::moments_with_derivatives(
    const PathPlace& v) const {
  thread_local Interpolation near;
  thread_local InterpolationDerivatives derivatives;
  thread_local std::vector<PropertyMoments> at;
  const auto place = impl_->inside(v);
  if (!place) return std::nullopt;
  interpolate(impl_->knots, *place, near, derivatives);
  if (!near.covered()) return std::nullopt;
  impl_->gather(near, at);
  return blend(near, derivatives, at);
}

}  // namespace roadbook
