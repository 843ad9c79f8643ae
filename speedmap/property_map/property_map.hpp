#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "speedmap/property_map/interpolation.hpp"
#include "speedmap/property_map/knots.hpp"
#include "speedmap/property_map/property_map_options.hpp"

namespace roadbook {

/// Mean and variance of the next measurement at a position.
struct PropertyMoments {
  double mean = 0.0;
  double variance = 0.0;
};
/// The same with first and second derivatives in (s, e).
struct PropertyMomentsDerivatives : PropertyMoments {
  Eigen::Vector2d d_mean = Eigen::Vector2d::Zero();  ///< d / ds, d / de
  Eigen::Vector2d d_variance = Eigen::Vector2d::Zero();
  Eigen::Matrix2d dd_mean = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d dd_variance = Eigen::Matrix2d::Zero();
};

enum class PropertyUpdate {
  kDone,
  kUncovered,          ///< no knot near
  kTooLittleEvidence,  ///< fewer labels there than `gate_counts`; map unchanged
  kRejected,           ///< the projected result was not proper; map unchanged
};

/// The effect of one property measurement.
struct PropertyUpdateResult {
  PropertyUpdate status = PropertyUpdate::kDone;
  double log_evidence = 0.0;  ///< log p(y) before the update, outlier component included
  double inlier = 1.0;        ///< probability that some class explains it
};

/// A semantic property map [SPM, section 3]. Each knot in path coordinates has a belief about its
/// class (Dirichlet proportions, or one class with kDiscrete). For every property, all knots share
/// one normal-gamma for each class.
///
/// Updates cost O(knots near x classes). Not for concurrent change; const members may run
/// concurrently. Deterministic.
class PropertyMap {
 public:
  /// Throws InvalidOption.
  PropertyMap(Knots knots, PropertyMapPrior prior, PropertyMapOptions options = {});

  [[nodiscard]] const Knots& knots() const { return knots_; }
  [[nodiscard]] const PropertyMapPrior& prior() const { return prior_; }
  [[nodiscard]] const PropertyMapOptions& options() const { return options_; }
  [[nodiscard]] std::size_t classes() const { return prior_.classes.size(); }

  /// Adds a label of class `label` at `v` that counts as `weight` independent labels (for pixels
  /// see ground_table.hpp). Returns false if no knot is near. Throws BadInput for a class that does
  /// not exist, a position that is not finite or a weight below 0; the map is then unchanged.
  bool add_label(const PathPlace& v, int label, double weight = 1.0);
  /// Adds several labels at one position, `weights[c]` of class c, with one interpolation.
  bool add_labels(const PathPlace& v, std::span<const double> weights);

  /// Adds a measurement of property `property` at `v`. Throws BadInput for one outside the
  /// plausible range or not finite, and for a negative `sigma`; the map is then unchanged.
  ///
  /// `sigma`: standard deviation of the sensor. The variances of the classes are then those of the
  /// ground only. The measurement counts Q / (Q + sigma^2), with the variance Q within the class
  /// (noisy_value.hpp).
  PropertyUpdateResult add_value(std::size_t property,
                                 const PathPlace& v,
                                 double y,
                                 double sigma = 0.0);

  /// Lets `seconds` pass: beliefs fade with the half-lives of the options.
  void forget(double seconds);

  /// Moments of the next measurement at `v`; empty if no knot is near.
  [[nodiscard]] std::optional<PropertyMoments> moments(std::size_t property,
                                                       const PathPlace& v) const;
  [[nodiscard]] std::optional<PropertyMomentsDerivatives> moments_with_derivatives(
      std::size_t property, const PathPlace& v) const;
  /// Expected class proportions at `v`, written to `shares` (K numbers); false where uncovered.
  bool class_shares(const PathPlace& v, std::span<double> shares) const;
  /// Effective labels seen around `v`: sum_l I_l (counts of l).
  [[nodiscard]] double evidence(const PathPlace& v) const;

  /// Expected class proportions u^l of a knot.
  void knot_shares(std::size_t knot, std::span<double> shares) const;
  /// Mean and variance of a knot alone: sum_i u_i (...).
  [[nodiscard]] PropertyMoments knot_moments(std::size_t property, std::size_t knot) const;
  [[nodiscard]] double knot_evidence(std::size_t knot) const { return evidence_[knot]; }

  /// Dirichlet counts (or, with kDiscrete, logarithms of class probabilities) of a knot.
  [[nodiscard]] std::span<const double> belief(std::size_t knot) const {
    return {&belief_[knot * classes()], classes()};
  }
  [[nodiscard]] const std::vector<NormalGamma>& property(std::size_t property) const {
    return properties_[property];
  }

  /// Sets the belief of a knot or the classes of a property, for maps that are read from a file or
  /// carried over. Throws InvalidOption.
  void set_belief(std::size_t knot, std::span<const double> belief, double evidence);
  void set_property(std::size_t property, const std::vector<NormalGamma>& classes);

 private:
  void shares_of(std::size_t knot, double* shares) const;
  void add_geometric(std::span<const double> weights);
  void add_linear(std::span<const double> weights);
  void add_discrete(std::span<const double> weights);
  [[nodiscard]] double gate_evidence() const;

  Knots knots_;
  PropertyMapPrior prior_;
  PropertyMapOptions options_;
  std::vector<double> confusion_;      ///< C row by row; the identity where none was given
  std::vector<double> log_confusion_;  ///< for kDiscrete
  std::vector<double> belief_;         ///< L x K
  std::vector<double> evidence_;       ///< labels seen by each knot, in effective counts
  std::vector<std::vector<NormalGamma>> properties_;
  Interpolation near_;  ///< of the update at work
};

}  // namespace roadbook
