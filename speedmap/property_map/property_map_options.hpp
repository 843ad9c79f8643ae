#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "speedmap/property_map/normal_gamma.hpp"
#include "speedmap/property_map/projection.hpp"

namespace roadbook {

/// How a class label changes the knots around it.
enum class SemanticModel {
  /// [SPM, eq. 9a] for the pseudo-likelihood of equation 8: a geometric mean over the knots. It is
  /// not normalised over the classes and spreads labels over class borders.
  kGeometricPool,
  /// p(c) = sum_l I_l sum_i C[i][c] w_i^l, the mixture that the property has in [SPM, eq. 10]. A
  /// label updates the knots and classes that explain it.
  kLinearPool,
  /// One class for each knot instead of proportions: log p_l(i) += weight I_l log C[i][c].
  kDiscrete,
};

struct PropertyMapOptions {
  SemanticModel semantics = SemanticModel::kLinearPool;
  NormalGammaProjection normal_gamma = NormalGammaProjection::kPredictive;
  DirichletProjection dirichlet = DirichletProjection::kTrace;
  /// [SPM, eq. 12c] as printed, with the gamma ratio inside the root: classes with different alpha
  /// get wrong weights.
  bool literal_root = false;
  /// The "weight update similar to (9)" of [SPM] for several knots, as printed: a_i^l += I_l q_i.
  bool literal_counts = false;

  /// Confusion matrix of the segmentation, row by row: C[i][c] = p(label c | class i). Empty:
  /// labels are never wrong. kDiscrete refuses an empty matrix, because one label would fix a knot
  /// for ever.
  std::vector<double> confusion;

  /// Limits the confidence of the prior. The standard deviation of a class mean is at least this
  /// share of the property's plausible range, and alpha at most `prior_alpha`. A class with a
  /// confident wrong prior loses its measurements to another class for ever. 0: the prior as given.
  double prior_mean_sigma = 1.0 / 3.0;
  double prior_alpha = 2.0;

  /// Prior share of measurements that no class explains (uniform over the plausible range). They
  /// change nothing. Values of 0.01 to 0.05 gave equally good results.
  double outlier_weight = 0.02;
  /// Labels (effective counts) that a position needs before a measurement there may change a class.
  /// Without labels, the prior alone would choose the class (docs/results/friction.md).
  double gate_counts = 5.0;

  /// A class forgets half of its measurements after this many of its own; 0: never.
  double half_life_values = 0.0;
  /// Classes lose half of their evidence after this time [s], and knots after
  /// `knot_half_life_s`; 0: never.
  double half_life_s = 0.0;
  double knot_half_life_s = 0.0;

  /// Throws InvalidOption.
  void check(std::size_t classes) const;
};

/// A property of the road whose value depends on the class: friction, roughness, ...
struct PropertyPrior {
  std::string name = "friction";
  std::string unit = "-";
  double min = 0.0;  ///< plausible range: measurements outside are refused
  double max = 1.5;
  std::vector<NormalGamma> classes;
};

/// Returns `ng` with the same mean and expected variance, and its confidence limited: standard
/// deviation of the mean at least `mean_sigma`, alpha at most `alpha`.
[[nodiscard]] NormalGamma calibrated(NormalGamma ng, double mean_sigma, double alpha);

/// The beliefs before the first measurement.
struct PropertyMapPrior {
  std::vector<std::string> classes;  ///< their names: K of them
  std::vector<double> counts;        ///< Dirichlet a of every knot
  std::vector<PropertyPrior> properties;

  /// Throws InvalidOption.
  void check() const;
};

constexpr std::size_t kMaxPropertyClasses = 32;

}  // namespace roadbook
