#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnosis/friction/friction_columns.hpp"
#include "diagnosis/numerics/place_basis.hpp"

namespace roadbook {

// Ground within a disc that carries the label of one class and is another surface: candidates
// "friction0.extra_class", whose `effect` is the index of the class.

/// The discs about visited cells, of several radii, in which the residuals (unit variance) of one
/// class differ most from those outside, centre and radius moved to where they do; one a class,
/// strongest first. Their penalty is the logarithm of the number of discs looked at.
[[nodiscard]] std::vector<Candidate> resurfaced_places(const FrictionReadings& readings,
                                                       const SurfaceClasses& classes,
                                                       const PlaceCells& cells,
                                                       const Eigen::VectorXd& residuals,
                                                       std::size_t most);

/// A disc moved, from where it stands, to where the residuals of its class differ most; the
/// residuals are those without it.
[[nodiscard]] Candidate moved_surface(const FrictionReadings& readings,
                                      const SurfaceClasses& classes,
                                      const Eigen::VectorXd& residuals,
                                      const Candidate& place);

/// Whether a disc lies within or beside one of these: a sliver along an edge is part of the same
/// surface.
[[nodiscard]] bool touches_disc(const std::vector<Candidate>& discs, const Candidate& place);

}  // namespace roadbook
