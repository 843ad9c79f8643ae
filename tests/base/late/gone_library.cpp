#include "tests/base/late/far_library.hpp"

namespace gone {

int answer(double value) { return static_cast<int>(value); }

}  // namespace gone
