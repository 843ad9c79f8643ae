#include "diagnosis/numerics/place_basis.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>

#include "base/cell_grid.hpp"

namespace roadbook {
namespace {

PlaceCells cells_of_size(const std::vector<Eigen::Vector2d>& places, double size) {
  PlaceCells cells;
  cells.size_m = size;
  std::map<GridCell<2>, std::size_t> known;
  for (const Eigen::Vector2d& p : places) {
    const GridCell<2> key = cell_at<2>(p, size);
    const auto [at, fresh] = known.try_emplace(key, cells.centres.size());
    if (fresh)
      cells.centres.emplace_back((static_cast<double>(key[0]) + 0.5) * size,
                                 (static_cast<double>(key[1]) + 0.5) * size);
    cells.of.push_back(at->second);
  }
  return cells;
}

}  // namespace

PlaceCells place_cells(const std::vector<Eigen::Vector2d>& places, std::size_t most) {
  double size = 2.0;
  PlaceCells cells = cells_of_size(places, size);
  while (cells.centres.size() > most) cells = cells_of_size(places, size *= 2.0);
  return cells;
}

Eigen::MatrixXd place_basis(const PlaceCells& cells, double length_m, std::size_t most) {
  const auto n = static_cast<Eigen::Index>(cells.centres.size());
  Eigen::MatrixXd K(n, n);
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j <= i; ++j) {
      const double r =
          std::sqrt(3.0) / length_m *
          (cells.centres[static_cast<std::size_t>(i)] - cells.centres[static_cast<std::size_t>(j)])
              .norm();
      K(i, j) = K(j, i) = (1.0 + r) * std::exp(-r);
    }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(K);
  const Eigen::VectorXd& value = eigen.eigenvalues();  // ascending
  Eigen::Index terms = 0;
  while (terms < std::min<Eigen::Index>(n, static_cast<Eigen::Index>(most)) &&
         value[n - 1 - terms] > 1e-3 * value[n - 1])
    ++terms;
  Eigen::MatrixXd basis(n, terms);
  for (Eigen::Index k = 0; k < terms; ++k) {
    // The sign of an eigenvector is the library's; fixed so that results are the same everywhere.
    Eigen::VectorXd v = eigen.eigenvectors().col(n - 1 - k);
    Eigen::Index largest = 0;
    v.cwiseAbs().maxCoeff(&largest);
    if (v[largest] < 0.0) v = -v;
    basis.col(k) = std::sqrt(value[n - 1 - k]) * v;
  }
  return basis;
}

const Eigen::MatrixXd& PlaceBases::of_length(double length_m) {
  const std::lock_guard lock(asked_);
  const auto found = known_.find(length_m);
  if (found != known_.end()) return found->second;
  return known_.emplace(length_m, place_basis(cells_, length_m)).first->second;
}

}  // namespace roadbook
