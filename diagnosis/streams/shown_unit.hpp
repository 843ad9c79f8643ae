#pragma once

#include "diagnosis/streams/observations.hpp"

namespace roadbook {

/// The unit in which reports show residuals of a channel, and the factor from the channel's own
/// unit.
struct ShownUnit {
  const char* name = "";
  double factor = 1.0;
};
/// Degrees, centimetres, and rates of them: increments of wheels are divided by their mean
/// interval.
[[nodiscard]] ShownUnit shown_unit(const Observations& obs, Channel channel);

}  // namespace roadbook
