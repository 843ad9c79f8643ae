#pragma once

#include <vector>

#include "diagnosis/view_data.hpp"

namespace roadbook {

// How alike the errors of one landmark's successive views are. A corner that a detector sets beside
// the true one stays beside it from image to image: such views together say less than as many
// independent ones, and a slow cause seems surer than it is.
class TrackCorrelation {
 public:
  explicit TrackCorrelation(const ViewData& data);

  /// Views of a landmark come in driving order. `white`: the same row of unit noise with the same
  /// unknowns projected out, which are what neighbours have in common without any correlation.
  void add(std::size_t observation, bool second, double residual, double white);

  /// Factor on the standard deviation of each camera's views by which sums of neighbours scatter
  /// more than if they were independent: sqrt(1 + 2 sum of correlations), at least 1.
  [[nodiscard]] std::vector<double> inflation() const;

 private:
  struct Value {
    double residual;
    double white;
  };
  const ViewData& data_;
  std::vector<std::vector<Value>> tracks_;  ///< by landmark, camera and coordinate
};

}  // namespace roadbook
