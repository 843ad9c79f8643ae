#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <map>
#include <mutex>
#include <utility>
#include <vector>

namespace roadbook {

// What changes smoothly from place to place: a Gaussian process over the cells of a grid that were
// visited, with the Matern 3/2 covariance (Rasmussen and Williams 2006, equation 4.17).

struct PlaceCells {
  double size_m = 2.0;
  std::vector<Eigen::Vector2d> centres;
  std::vector<std::size_t> of;  ///< cell of each reading
};

/// The finest grid, from 2 m upwards in powers of two, with at most `most` visited cells. Cells in
/// order of the first visit.
[[nodiscard]] PlaceCells place_cells(const std::vector<Eigen::Vector2d>& places,
                                     std::size_t most = 400);

/// Functions of place of unit variance: cells x terms, such that terms with independent standard
/// normal weights have the process's covariance; the smallest are left out.
[[nodiscard]] Eigen::MatrixXd place_basis(const PlaceCells& cells,
                                          double length_m,
                                          std::size_t most = 120);

/// The functions of one place for the lengths that were asked for. Each takes an
/// eigendecomposition, and a search for noise asks for the same ones dozens of times. Any number of
/// threads may ask.
class PlaceBases {
 public:
  explicit PlaceBases(PlaceCells cells) : cells_(std::move(cells)) {}
  [[nodiscard]] const PlaceCells& cells() const { return cells_; }
  [[nodiscard]] const Eigen::MatrixXd& of_length(double length_m);

 private:
  PlaceCells cells_;
  std::mutex asked_;
  std::map<double, Eigen::MatrixXd> known_;
};

}  // namespace roadbook
