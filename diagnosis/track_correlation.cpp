#include "diagnosis/track_correlation.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace roadbook {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

constexpr std::size_t kLags = 8;
// The sum of so many correlations is itself uncertain; less than this is not told from none.
constexpr double kLeast = 0.05;

// Products of values so many views apart, and of each with itself.
struct Products {
  std::array<double, kLags + 1> residual{};
  std::array<double, kLags + 1> white{};
};

}  // namespace

TrackCorrelation::TrackCorrelation(const ViewData& data)
    : data_(data), tracks_(2 * data.bundle.points.size() * data.bundle.cameras.size()) {}

void TrackCorrelation::add(std::size_t observation, bool second, double residual, double white) {
  const BundleObservation& o = data_.bundle.observations[observation];
  const std::size_t track = at(o.point) * data_.bundle.cameras.size() + at(o.camera);
  tracks_[2 * track + (second ? 1 : 0)].push_back({residual, white});
}

std::vector<double> TrackCorrelation::inflation() const {
  const std::size_t cameras = data_.bundle.cameras.size();
  std::vector<Products> products(cameras);
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const auto& track = tracks_[t];
    Products& sum = products[(t / 2) % cameras];
    for (std::size_t lag = 0; lag <= kLags; ++lag)
      for (std::size_t i = lag; i < track.size(); ++i) {
        sum.residual[lag] += track[i].residual * track[i - lag].residual;
        sum.white[lag] += track[i].white * track[i - lag].white;
      }
  }
  std::vector<double> factors;
  for (const Products& p : products) {
    double sum = 0.0;
    for (std::size_t lag = 1; lag <= kLags && p.residual[0] > 0.0 && p.white[0] > 0.0; ++lag)
      sum += p.residual[lag] / p.residual[0] - p.white[lag] / p.white[0];
    factors.push_back(sum > kLeast ? std::sqrt(1.0 + 2.0 * sum) : 1.0);
  }
  return factors;
}

}  // namespace roadbook
