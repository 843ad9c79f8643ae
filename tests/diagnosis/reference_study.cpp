#include <cstdio>
#include <cstdlib>
#include <string>

#include "base/parallel.hpp"
#include "diagnosis/diagnose.hpp"
#include "tests/diagnosis/hill_car.hpp"
#include "tests/diagnosis/rough_positions.hpp"

// reference_study positions|hills DRIVES SEED THREADS: drives whose reference has rough positions
// and no heading, or leads over hills, of a car that an independent program drives. Half of them
// are sound. One line for each kind: alarms of sound cars, and faults that are named.

namespace roadbook::test {
namespace {

struct Outcome {
  bool alarm = false;   // a name that is not that of the hidden fault
  bool named = false;   // the hidden radius
  bool inside = false;  // its interval holds
  double sigmas = 0.0;  // its size over its standard error
};

Outcome judge(const MotionStreams& streams, double radius) {
  const Diagnosis d = diagnose(streams, "drive");
  Outcome outcome;
  outcome.alarm = !d.unknown.empty();
  for (const FoundCause& c : d.causes) {
    if (radius == 0.0 || c.effect != "wheels0.radius") {
      outcome.alarm = true;
      std::printf("  %s = %.4g (%.4g to %.4g)\n", c.effect.c_str(), c.size, c.low, c.high);
      continue;
    }
    outcome.named = true;
    outcome.inside = c.low < radius && radius < c.high;
    outcome.sigmas = std::abs(radius) / ((c.high - c.low) / 3.92);
  }
  return outcome;
}

MotionStreams with_radius(MotionStreams streams, double radius) {
  for (WheelSample& w : streams.wheels) {
    w.left_rad /= 1.0 + radius;
    w.right_rad /= 1.0 + radius;
  }
  return streams;
}

template <typename Record>
void study(
    const char* kind, std::size_t drives, std::uint64_t seed, int threads, const Record& record) {
  for (const double radius : {0.0, 0.03}) {
    std::vector<Outcome> outcomes(drives);
    parallel_for(drives, threads, [&](std::size_t i) {
      const double signed_radius = i % 2 == 0 ? radius : -radius;
      outcomes[i] = judge(record(seed + i, signed_radius), signed_radius);
    });
    std::size_t alarms = 0, named = 0, inside = 0;
    for (const Outcome& o : outcomes) {
      alarms += o.alarm ? 1U : 0U;
      named += o.named ? 1U : 0U;
      inside += o.inside ? 1U : 0U;
    }
    std::printf("%s, radius %.0f %%: %zu of %zu with a wrong name, %zu named, %zu intervals hold\n",
                kind, 100.0 * radius, alarms, drives, named, inside);
  }
}

void study_positions(std::size_t drives, std::uint64_t seed, int threads) {
  for (const double noise_m : {0.3, 0.5, 1.0, 2.0})
    for (const std::size_t every : {std::size_t{1}, std::size_t{10}}) {
      const std::string kind = std::to_string(noise_m) + " m, " + (every == 1 ? "10 Hz" : "1 Hz");
      study(kind.c_str(), drives, seed, threads, [&](std::uint64_t one, double radius) {
        return with_radius(with_rough_positions(one, noise_m, every), radius);
      });
    }
}

void study_hills(std::size_t drives, std::uint64_t seed, int threads) {
  for (const double share : {0.06, 0.12})
    for (const bool levelled : {false, true}) {
      Hills hills;
      hills.share = share;
      const std::string kind =
          std::to_string(share) + (levelled ? ", levelled" : ", as it is read");
      study(kind.c_str(), drives, seed, threads, [&](std::uint64_t one, double radius) {
        HillDrive drive = drive_over(hills, one, radius);
        if (levelled)
          level_motion(drive.attitudes, drive.attitudes, drive.pitch_rates, drive.streams);
        return drive.streams;
      });
    }
}

}  // namespace
}  // namespace roadbook::test

int main(int count, char** words) {
  if (count < 5) {
    std::fprintf(stderr, "usage: %s positions|hills DRIVES SEED THREADS\n", words[0]);
    return 1;
  }
  const auto drives = static_cast<std::size_t>(std::atoll(words[2]));
  const auto seed = static_cast<std::uint64_t>(std::atoll(words[3]));
  const int threads = std::atoi(words[4]);
  if (std::string(words[1]) == "positions")
    roadbook::test::study_positions(drives, seed, threads);
  else
    roadbook::test::study_hills(drives, seed, threads);
  return 0;
}
