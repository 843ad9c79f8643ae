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
  /// (9a) of the document, for its pseudo-likelihood (8): a geometric mean over the knots, which is
  /// not normalised over the classes and spreads labels over class borders.
  kGeometricPool,
  /// p(c) = sum_l I_l sum_i C[i][c] w_i^l, the same mixture as the property's (10): a label goes to
  /// the knots and classes that explain it.
  kLinearPool,
  /// One class a knot instead of proportions: log p_l(i) += weight I_l log C[i][c].
  kDiscrete,
};

struct PropertyMapOptions {
  SemanticModel semantics = SemanticModel::kLinearPool;
  NormalGammaProjection normal_gamma = NormalGammaProjection::kPredictive;
  DirichletProjection dirichlet = DirichletProjection::kTrace;
  /// (12c) as printed, gamma ratio inside the root: classes of unequal alpha get wrong weights.
  bool literal_root = false;
  /// "Weight update similar to (9)" for several knots, as printed: a_i^l += I_l q_i.
  bool literal_counts = false;

  /// Confusion matrix of the segmentation, row by row: C[i][c] = p(label c | class i). Empty:
  /// labels are never wrong (kLinearPool), which kDiscrete refuses: one label would settle a knot
  /// for ever.
  std::vector<double> confusion;

  /// A prior is believed no more than this: the standard deviation of a class mean is at least this
  /// share of the property's plausible range, and alpha at most `prior_alpha`. A confident wrong
  /// prior loses its measurements to another class for good. 0: the prior as given.
  double prior_mean_sigma = 1.0 / 3.0;
  double prior_alpha = 2.0;

  /// Share of measurements that no class explains (spread evenly over the property's plausible
  /// range); they then change nothing. 0.01 to 0.05 measured equally good.
  double outlier_weight = 0.02;
  /// Labels (effective counts) that must have been seen at a place before a measurement there may
  /// change a class: without them it is the prior that decides which. Measured in
  /// docs/guide/friction.md.
  double gate_counts = 5.0;

  /// A class forgets half of its measurements after this many of its own; 0: never.
  double half_life_values = 0.0;
  /// Classes forget half of what they know after this time [s], and so do the knots; 0: never.
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

/// `ng` with the same mean and expected variance, believed no more than the limits say.
[[nodiscard]] NormalGamma calibrated(NormalGamma ng, double mean_sigma, double alpha);

/// What is believed before the first measurement.
struct PropertyMapPrior {
  std::vector<std::string> classes;  ///< their names: K of them
  std::vector<double> counts;        ///< Dirichlet a of every knot
  std::vector<PropertyPrior> properties;

  /// Throws InvalidOption.
  void check() const;
};

constexpr std::size_t kMaxPropertyClasses = 32;

}  // namespace roadbook
