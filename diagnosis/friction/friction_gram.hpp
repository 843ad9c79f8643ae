#pragma once

#include <Eigen/Core>

#include "diagnosis/friction/friction_noise_model.hpp"
#include "diagnosis/numerics/place_basis.hpp"

namespace roadbook {

/// Products of readings, mean columns and place cells, whitened by the noise of each reading. They
/// are sufficient for all fits of mean and spatial bias.
class FrictionGram {
 public:
  FrictionGram(const std::vector<FrictionSample>& samples,
               const PlaceCells& cells,
               const FrictionMean& mean,
               Eigen::Index flat,
               const FrictionNoise& noise);

  struct Fit {
    double log_likelihood = -1e300;  ///< noise scale profiled out; without constants
    double scale = 1.0;              ///< estimated over assumed noise
    Eigen::VectorXd mean;            ///< coefficients of the mean columns
    Eigen::VectorXd place;           ///< coefficients of the spatial basis
  };
  /// Fits the mean and a spatial bias of standard deviation `size`. `basis`: one row a cell, one
  /// column a basis function.
  [[nodiscard]] Fit fit(const Eigen::MatrixXd& basis, double size) const;
  /// Products transformed by a basis once, for fits with many sizes.
  class Basis {
   public:
    Basis(const FrictionGram& gram, const Eigen::MatrixXd& basis);
    [[nodiscard]] Fit fit(double size) const;

   private:
    Eigen::MatrixXd products_;  ///< reading, mean columns, basis
    Eigen::Index columns_, flat_;
    double rows_, log_scale_;
  };

 private:
  Eigen::MatrixXd dense_;  ///< products of reading and mean columns
  Eigen::MatrixXd cross_;  ///< products of these with the cells
  Eigen::MatrixXd cells_;
  Eigen::Index flat_;
  double rows_ = 0.0;
  double log_scale_ = 0.0;  ///< sum of the logs of the readings' standard deviations
};

}  // namespace roadbook
