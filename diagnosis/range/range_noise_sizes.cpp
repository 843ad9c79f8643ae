#include "diagnosis/range/range_noise_sizes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/random.hpp"
#include "diagnosis/numerics/size_interval.hpp"
#include "diagnosis/range/range_noise.hpp"
#include "sensors/stream_noise.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kReplicates = 4;
constexpr double kUnsure = 0.25;  // share of the correction that is uncertain: the simulated
                                  // surfaces are not the true ones
constexpr double kReach = 45.0;  // [sigma] reach of hits, including outliers of ten times the noise

EffectSizes measured(const RangeReadings& readings, const RangeMixture& m) {
  EffectSizes sizes;
  sizes["range0.outliers"] = m.share[kOutliers] / (m.hit() + m.share[kOutliers]);
  for (const NoiseCause& n : measured_range_noise(readings, m)) sizes[n.effect] = n.size;
  return sizes;
}

// The readings of the drive with simulated noise on all hits, and a map made of them.
class DrawnAgain {
 public:
  DrawnAgain(RangeReadings readings, const RangeMixture& mixture)
      : readings_(std::move(readings)),
        reach_m_(kReach * mixture.sigma_m),
        pose_sigma_(pose_scatter(readings_, mixture)) {
    smooth();
  }

  [[nodiscard]] RangeReadings draw(const EffectSizes& noise,
                                   double sigma_m,
                                   std::uint64_t replicate) const {
    Random random(replicate, "hits drawn again");
    Random of_poses(replicate, "poses drawn again");
    std::map<std::size_t, StreamNoise> of_beam;
    Eigen::Vector3d off = Eigen::Vector3d::Zero();
    double last_s = -1e300;
    return replaced([&](const RangeBeam& b, const ExpectedRange* hit) {
      StreamNoise& own = of_beam.try_emplace(b.beam, noise, "range0").first->second;
      const double drawn = sigma_m * own.next(random, b.speed, b.yaw_rate);
      if (b.t_s != last_s)
        for (int k = 0; k < 3; ++k) off[k] = pose_sigma_[k] * of_poses.normal();
      last_s = b.t_s;
      return hit == nullptr ? b.range_m : hit->expected_m + hit->by_pose.dot(off) + drawn;
    });
  }

 private:
  // Readings with ranges from `range_of(beam, sample)`. `sample` is null if the beam is not a hit
  // or has no expected range.
  template <typename RangeOf>
  [[nodiscard]] RangeReadings replaced(const RangeOf& range_of) const {
    RangeReadings all;
    all.max_m = readings_.max_m;
    std::size_t next = 0;
    for (std::vector<RangeBeam> beams : readings_.beams) {
      for (RangeBeam& b : beams) {
        const ExpectedRange* hit = nullptr;
        if (next < readings_.samples.size()) {
          const ExpectedRange& r = readings_.samples[next];
          const bool is_this = r.t_s == b.t_s && r.beam == b.beam;
          next += is_this ? 1 : 0;
          if (is_this && r.read_m < readings_.max_m - 1e-9 &&
              std::abs(r.read_m - r.expected_m) < reach_m_)
            hit = &r;
        }
        b.range_m = std::clamp(range_of(b, hit), 0.0, std::max(readings_.max_m, b.range_m));
      }
      const RangeReadings drive = expect_ranges(beams, readings_.max_m);
      all.samples.insert(all.samples.end(), drive.samples.begin(), drive.samples.end());
    }
    return all;
  }

  // The expected surfaces contain noise of the readings. A map made of expected ranges has less.
  void smooth() {
    const RangeReadings smoother = replaced([](const RangeBeam& b, const ExpectedRange* hit) {
      return hit == nullptr ? b.range_m : hit->expected_m;
    });
    std::size_t i = 0;
    for (const ExpectedRange& r : smoother.samples) {
      while (i < readings_.samples.size() && readings_.samples[i].t_s < r.t_s) ++i;
      for (std::size_t k = i; k < readings_.samples.size() && readings_.samples[k].t_s == r.t_s;
           ++k)
        if (readings_.samples[k].beam == r.beam) readings_.samples[k].expected_m = r.expected_m;
    }
  }

  RangeReadings readings_;
  double reach_m_;
  Eigen::Vector3d pose_sigma_;
};

// Map errors reduce a size by a factor; for a correlation they add uncorrelated noise, so the
// factor applies to 1 - size.
double corrected(const FoundCause& cause, double again) {
  if (cause.effect.ends_with("correlation"))
    return 1.0 - (1.0 - cause.size) * (1.0 - cause.size) / (1.0 - again);
  return cause.size * cause.size / again;
}

void correct(double size, FoundCause& cause) {
  const double by =
      cause.effect.ends_with("correlation") ? (1.0 - size) / (1.0 - cause.size) : size / cause.size;
  const double scatter = 0.5 * (cause.high - cause.low) * by * std::sqrt(1.0 + 1.0 / kReplicates);
  const double half = std::hypot(scatter, kSigmas95 * kUnsure * (size - cause.size));
  cause.size = size;
  const SizeInterval interval = interval95(cause.effect, size, half / kSigmas95);
  cause.low = interval.low;
  cause.high = interval.high;
}

}  // namespace

void correct_noise_sizes(const RangeReadings& readings,
                         const RangeMixture& mixture,
                         const RangeParts& parts,
                         std::vector<FoundCause>& causes) {
  EffectSizes found;
  for (const FoundCause& c : causes)
    if (c.noise) found[c.effect] = c.size;
  if (found.empty() || readings.beams.empty()) return;
  const DrawnAgain drawn(readings, mixture);
  // White noise such that the simulated drive has the same scatter as the measured one.
  const RangeMixture once = fit_mixture(drawn.draw(found, mixture.sigma_m, 0), parts);
  const double sigma_m = mixture.sigma_m * std::clamp(mixture.sigma_m / once.sigma_m, 0.5, 2.0);
  EffectSizes mean;
  for (std::size_t k = 1; k <= kReplicates; ++k) {
    const RangeReadings again = drawn.draw(found, sigma_m, k);
    for (const auto& [name, size] : measured(again, fit_mixture(again, parts)))
      mean[name] += size / kReplicates;
  }
  for (FoundCause& cause : causes) {
    if (!cause.noise) continue;
    const double size = corrected(cause, mean[cause.effect]);
    if (size / cause.size > 0.5 && size / cause.size < 2.0)
      correct(size, cause);
    else
      cause.note +=
          "; the size is unreliable, because it also contains errors of the surfaces that these "
          "readings map";
  }
}

}  // namespace roadbook
