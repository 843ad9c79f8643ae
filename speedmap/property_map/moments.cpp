#include <array>

#include "base/error.hpp"
#include "speedmap/property_map/blend.hpp"
#include "speedmap/property_map/property_map.hpp"

namespace roadbook {

PropertyMoments PropertyMap::knot_moments(std::size_t property, std::size_t knot) const {
  std::array<double, kMaxPropertyClasses> u;
  shares_of(knot, u.data());
  const std::vector<NormalGamma>& ng = properties_[property];
  PropertyMoments result;
  for (std::size_t i = 0; i < ng.size(); ++i) result.mean += u[i] * ng[i].mu;
  for (std::size_t i = 0; i < ng.size(); ++i) {
    const double offset = ng[i].mu - result.mean;
    result.variance += u[i] * (offset * offset + ng[i].predictive_variance());
  }
  return result;
}

PropertyMoments blend(const Interpolation& near, const std::vector<PropertyMoments>& at) {
  PropertyMoments result;
  for (std::size_t n = 0; n < at.size(); ++n) result.mean += near.weights[n] * at[n].mean;
  for (std::size_t n = 0; n < at.size(); ++n) {
    const double offset = at[n].mean - result.mean;
    result.variance += near.weights[n] * (at[n].variance + offset * offset);
  }
  return result;
}

PropertyMomentsDerivatives blend(const Interpolation& near,
                                 const InterpolationDerivatives& d,
                                 const std::vector<PropertyMoments>& at) {
  PropertyMomentsDerivatives result;
  static_cast<PropertyMoments&>(result) = blend(near, at);
  for (std::size_t n = 0; n < at.size(); ++n) {
    // Second moments about the constant m: their gradient needs no term of grad m, since
    // V = E[(y - m)^2] - (E[y] - m)^2 and the last bracket is 0 at v itself.
    const double offset = at[n].mean - result.mean;
    const double second = at[n].variance + offset * offset;
    // sum grad I = 0: means relative to m lose fewer digits.
    result.d_mean += offset * d.gradients[n];
    result.dd_mean += offset * d.hessians[n];
    result.d_variance += second * d.gradients[n];
    result.dd_variance += second * d.hessians[n];
  }
  result.dd_variance -= 2.0 * result.d_mean * result.d_mean.transpose();
  return result;
}

std::optional<PropertyMoments> PropertyMap::moments(std::size_t property,
                                                    const PathPlace& v) const {
  ROADBOOK_ASSERT(property < properties_.size());
  thread_local Interpolation near;
  thread_local std::vector<PropertyMoments> at;
  interpolate(knots_, v, near);
  if (!near.covered()) return std::nullopt;
  at.clear();
  for (const std::int32_t knot : near.knots)
    at.push_back(knot_moments(property, static_cast<std::size_t>(knot)));
  return blend(near, at);
}

std::optional<PropertyMomentsDerivatives> PropertyMap::moments_with_derivatives(
    std::size_t property, const PathPlace& v) const {
  ROADBOOK_ASSERT(property < properties_.size());
  thread_local Interpolation near;
  thread_local InterpolationDerivatives derivatives;
  thread_local std::vector<PropertyMoments> at;
  interpolate(knots_, v, near, derivatives);
  if (!near.covered()) return std::nullopt;
  at.clear();
  for (const std::int32_t knot : near.knots)
    at.push_back(knot_moments(property, static_cast<std::size_t>(knot)));
  return blend(near, derivatives, at);
}

bool PropertyMap::class_shares(const PathPlace& v, std::span<double> shares) const {
  ROADBOOK_ASSERT(shares.size() == classes());
  thread_local Interpolation near;
  interpolate(knots_, v, near);
  std::fill(shares.begin(), shares.end(), 0.0);
  std::array<double, kMaxPropertyClasses> u;
  for (std::size_t n = 0; n < near.size(); ++n) {
    shares_of(static_cast<std::size_t>(near.knots[n]), u.data());
    for (std::size_t i = 0; i < shares.size(); ++i) shares[i] += near.weights[n] * u[i];
  }
  return near.covered();
}

double PropertyMap::evidence(const PathPlace& v) const {
  thread_local Interpolation near;
  interpolate(knots_, v, near);
  double sum = 0.0;
  for (std::size_t n = 0; n < near.size(); ++n)
    sum += near.weights[n] * evidence_[static_cast<std::size_t>(near.knots[n])];
  return sum;
}

}  // namespace roadbook
