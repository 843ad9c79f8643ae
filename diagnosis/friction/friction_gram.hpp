#pragma once

#include <Eigen/Core>

#include "diagnosis/friction/friction_noise.hpp"

namespace roadbook {

/// Products of readings, mean columns and cells, whitened by each reading's own noise: all that
/// fits of mean and place need of the rows.
class FrictionGram {
 public:
  FrictionGram(const std::vector<FrictionSample>& samples,
               const PlaceCells& cells,
               const FrictionMean& mean,
               Eigen::Index flat,
               const FrictionNoise& noise);

  struct Fit {
    double log_likelihood = -1e300;  ///< the scale of the noise profiled out; but for constants
    double scale = 1.0;              ///< of the noise, over what it was taken to be
    Eigen::VectorXd mean;            ///< weights of the mean's columns
    Eigen::VectorXd place;           ///< of the basis
  };
  /// With a bias of places of standard deviation `size`; `basis` cells x terms.
  [[nodiscard]] Fit fit(const Eigen::MatrixXd& basis, double size) const;
  /// Products once transformed by a basis, for many sizes.
  class Basis {
   public:
    Basis(const FrictionGram& gram, const Eigen::MatrixXd& basis);
    [[nodiscard]] Fit fit(double size) const;

   private:
    Eigen::MatrixXd products_;  ///< of reading, mean, basis
    Eigen::Index columns_, flat_;
    double rows_, log_scale_;
  };

 private:
  Eigen::MatrixXd dense_;  ///< reading and mean's columns
  Eigen::MatrixXd cross_;  ///< the same times cells
  Eigen::MatrixXd cells_;
  Eigen::Index flat_;
  double rows_ = 0.0;
  double log_scale_ = 0.0;  ///< sum of the logarithms of the readings' deviations
};

}  // namespace roadbook
