#pragma once

namespace roadbook {

// Conversion between the two signs of e. In roadbook, ISO 8855 and OpenDRIVE, e is positive to the
// left of the direction of travel. In [SPM, eq. 5] it is positive to the right. The paper is
// converted here only.

[[nodiscard]] constexpr double to_paper_sign(double e_m) { return -e_m; }
[[nodiscard]] constexpr double from_paper_sign(double e_paper_m) { return -e_paper_m; }

}  // namespace roadbook
