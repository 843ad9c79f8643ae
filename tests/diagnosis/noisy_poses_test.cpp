#include <gtest/gtest.h>

#include "diagnosis/diagnose.hpp"
#include "tests/diagnosis/hidden_effects/recorded_streams.hpp"

namespace roadbook {
namespace {

// Drives without effects and with pose noise of 10 cm. A poor start of the fit would lead to false
// pose outliers with gains of thousands of nats.
TEST(NoisyPoses, OfADriveWithoutACauseNothingIsNamed) {
  for (const std::uint64_t seed :
       {1101882511600489675U, 6437465535154237369U, 1892249233277630238U, 5576168547682782675U,
        4601364459963537505U, 4381324483239627636U}) {
    test::HiddenDriveOptions options;
    options.seed = seed;
    options.pose_sigma_m = 0.1;
    const Diagnosis d = diagnose(test::streams_of(test::record_drive(options)), "drive");
    for (const FoundCause& c : d.causes) ADD_FAILURE() << seed << ": " << c.effect << " " << c.size;
    for (const UnknownCause& u : d.unknown)
      ADD_FAILURE() << seed << ": " << u.hook << " ~ " << u.depends_on;
  }
}

}  // namespace
}  // namespace roadbook
