#pragma once

namespace roadbook {

// The one place where the two signs of e meet. roadbook, ISO 8855 and OpenDRIVE count e positive to
// the left of the direction of travel; document 000, equation (5), counts it positive to the right.
// The same line goes both ways.

[[nodiscard]] constexpr double to_document_sign(double e_m) { return -e_m; }
[[nodiscard]] constexpr double from_document_sign(double e_document_m) { return -e_document_m; }

}  // namespace roadbook
