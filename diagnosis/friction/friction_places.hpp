#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/friction/friction_columns.hpp"
#include "diagnosis/numerics/place_basis.hpp"

namespace roadbook {

// Patches of another surface: the ground within a disc has the label of one class but another
// friction. Candidates "friction0.extra_class"; `effect` is the index of the class.

/// The discs in which the residuals (unit variance) of one class differ most from those outside.
/// Start: discs of several radii about visited cells; centre and radius are then refined. At most
/// one a class and `most` in total, most significant first. Their penalty is the log of the number
/// of discs tested.
[[nodiscard]] std::vector<Candidate> resurfaced_places(const FrictionReadings& readings,
                                                       const SurfaceClasses& classes,
                                                       const PlaceCells& cells,
                                                       const Eigen::VectorXd& residuals,
                                                       std::size_t most);

/// The disc with centre and radius refined from their current values, so that the residuals of its
/// class differ most. `residuals`: those without this disc.
[[nodiscard]] Candidate moved_surface(const FrictionReadings& readings,
                                      const SurfaceClasses& classes,
                                      const Eigen::VectorXd& residuals,
                                      const Candidate& place);

/// True if the disc lies within one of `discs` or touches it. A strip along an edge belongs to the
/// same surface.
[[nodiscard]] bool touches_disc(const std::vector<Candidate>& discs, const Candidate& place);

}  // namespace roadbook
