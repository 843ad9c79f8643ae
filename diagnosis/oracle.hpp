#pragma once

#include <optional>

#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/streams/streams.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

/// Result of an oracle that knows the hidden sizes: the reference for a diagnosis of the same
/// drive.
struct OracleAnswer {
  double strength = 0.0;  ///< largest size over its standard error with nothing else free
  double gain = 0.0;      ///< [nats] log likelihood gained with the true sizes and nothing fitted
  /// Smallest size over its error with all hidden ones free; nothing where the data show none of
  /// them but as noise.
  std::optional<double> weakest;
};

/// `hidden`: true sizes by effect; those that streams of motion do not carry are left out. Noise is
/// that of the nominal fit. Throws as `prepare_motion`.
[[nodiscard]] OracleAnswer ask_oracle(const MotionStreams& streams, const EffectSizes& hidden);

/// The same of readings: friction, range scanner, detector of people. Of another surface
/// (`friction0.extra_class`) the oracle knows the size, and takes the place where the readings
/// differ most. Sizes of noise are left out.
[[nodiscard]] OracleAnswer ask_oracle(const DriveReadings& readings, const EffectSizes& hidden);

}  // namespace roadbook
