#pragma once

#include "diagnosis/streams/streams.hpp"
#include "tests/diagnosis/hidden_effects/injector.hpp"

namespace roadbook::test {

/// A recording as plain streams, without files.
[[nodiscard]] MotionStreams streams_of(const Recording& recording);

}  // namespace roadbook::test
