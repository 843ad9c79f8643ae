#pragma once

#include <optional>

#include "diagnosis/reading_diagnosis.hpp"
#include "diagnosis/streams/streams.hpp"
#include "sensors/effects.hpp"

namespace roadbook {

/// Result of an oracle that knows the hidden sizes: the reference for a diagnosis of the same
/// drive.
struct OracleAnswer {
  double strength = 0.0;  ///< largest true size over its standard error, each effect fitted alone
  double gain = 0.0;      ///< [nats] log likelihood gained with the true sizes and nothing fitted
  /// Smallest true size over its standard error with all hidden effects free. No value if the data
  /// show no hidden effect, except noise effects.
  std::optional<double> weakest;
};

/// `hidden`: true sizes by effect; effects that motion streams do not show are ignored. The noise
/// is that of the nominal fit. Throws as `prepare_motion`.
[[nodiscard]] OracleAnswer ask_oracle(const MotionStreams& streams, const EffectSizes& hidden);

/// The same for readings of friction, range scanner and detector. For another surface
/// (`friction0.extra_class`) the oracle knows the size and takes the place where readings differ
/// most. Sizes of noise effects are ignored.
[[nodiscard]] OracleAnswer ask_oracle(const DriveReadings& readings, const EffectSizes& hidden);

}  // namespace roadbook
