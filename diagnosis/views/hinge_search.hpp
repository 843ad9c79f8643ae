#pragma once

#include <string>

#include "diagnosis/views/hinge.hpp"
#include "diagnosis/views/view_prediction.hpp"

namespace roadbook {

inline constexpr std::size_t kHingeLines = 4500;  ///< candidate lines of the search grid
inline constexpr double kHingeTau = 0.05;         ///< prior standard deviation of a hinge [rad]

/// Finds the lines along which the ground may be bent and stores them, best first, as hinges of
/// size 0: in `point.hinges`, with their number in `basis.hinges`. Earlier hinges are replaced.
///
/// First, all lines of a grid are scored by how well they explain height, roll and pitch of the
/// motions between keyframes; the best are refined. Then the best of those take two Gauss-Newton
/// steps against all rows, with poses and landmarks projected out. `num_threads`: 0 for all cores;
/// the result does not depend on it.
void find_hinge_lines(const ViewData& data,
                      const ViewNoise& noise,
                      int num_threads,
                      ViewBasis& basis,
                      ViewPoint& point);

/// Text for the report: "the ground bends in the line through x = ... m, y = ... m at ... degrees".
[[nodiscard]] std::string hinge_note(const HingeLine& line);

}  // namespace roadbook
