#include "diagnosis/known_causes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "diagnosis/friction/friction_columns.hpp"
#include "diagnosis/inference/candidate.hpp"
#include "diagnosis/inference/extended_model.hpp"
#include "diagnosis/inference/findings.hpp"
#include "diagnosis/inference/score_table.hpp"
#include "diagnosis/numerics/size_interval.hpp"

namespace roadbook {
namespace {

constexpr double kSurelyBeyond = 0.01;
constexpr std::array kTakenOff{"friction0.slip_bias",   "friction0.speed_bias", "friction0.drying",
                               "friction0.temperature", "range0.bias",          "range0.scale",
                               "detector.foot_point",   "detector.range"};

void note_beyond(FoundCause& cause) {
  cause.note +=
      (cause.note.empty() ? "" : "; ") + std::string("in addition to the known size (--model)");
}

// Difference of an effect from its known size.
void become_difference(double known, double tests, FoundCause& cause) {
  const double sigma = std::max((cause.high - cause.low) / (2.0 * kSigmas95), 1e-300);
  cause.size -= known;
  cause.low -= known;
  cause.high -= known;
  const double z = cause.size / sigma;
  cause.p = std::min(1.0, tests * chi_squared_tail(z * z, 1));
  cause.evidence = 0.5 * z * z - std::log(tests);
  cause.gain = gain_of_large_samples(z);
  note_beyond(cause);
}

// The fit used the known size, so that its result is the difference.
bool is_taken_off(const std::string& effect) {
  return std::find(kTakenOff.begin(), kTakenOff.end(), effect) != kTakenOff.end();
}

}  // namespace

DriveReadings without_known(DriveReadings readings, const EffectSizes& known) {
  take_off_friction(known, readings.friction);
  const double bias = effect_size(known, "range0", "bias");
  const double scale = effect_size(known, "range0", "scale");
  for (BeaconRange& r : readings.beacons.samples) r.read_m -= bias + scale * r.expected_m;
  const double ahead_m = effect_size(known, "detector", "foot_point");
  for (Sighting& s : readings.people.sightings)
    s.foot -= ahead_m * Eigen::Vector2d(s.foot - s.eye).normalized();
  return readings;
}

void note_beyond_known(const EffectSizes& known, Diagnosis& found) {
  for (FoundCause& cause : found.causes)
    if (cause.noise && known.contains(cause.effect)) note_beyond(cause);
}

void take_off_known(const EffectSizes& known, Diagnosis& found) {
  const double tests = static_cast<double>(std::max<std::size_t>(1, found.looked_for.size()));
  std::erase_if(found.causes, [&](FoundCause& cause) {
    const auto size = known.find(cause.effect);
    // A known effect without a place may be any of the places found.
    if (size == known.end() || cause.in_place) return false;
    if (is_taken_off(cause.effect)) {
      note_beyond(cause);
      return false;
    }
    become_difference(size->second, tests, cause);
    return cause.p >= kSurelyBeyond;
  });
  const auto is_judged = [&](const std::string& effect) {
    const auto& names = found.looked_for;
    return holds(names, effect) || found.extended.contains(effect);
  };
  const auto is_judged_of = [&](const char* stream) {
    return std::any_of(found.looked_for.begin(), found.looked_for.end(),
                       [&](const std::string& name) { return name.starts_with(stream); });
  };
  for (const auto& [effect, size] : known)
    if (is_judged(effect)) found.extended[effect] = size;
  for (const FoundCause& cause : found.causes)
    if (known.contains(cause.effect) && cause.session.empty() && !cause.in_place)
      found.extended[cause.effect] += cause.size;
  if (is_judged_of("friction0.")) note_without_place(known, "friction0.", found);
}

}  // namespace roadbook
