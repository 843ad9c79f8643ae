#pragma once

#include <cstdint>
#include <vector>

#include "diagnosis/map_changes/landmark_redetections.hpp"
#include "diagnosis/numerics/group_counts.hpp"

namespace roadbook {

// Square cells of a map in which far fewer landmarks are detected again than chance and the
// variation between cells allow.

struct RemovedCellOptions {
  std::vector<double> sides_m{2.0, 3.0, 4.0};  ///< side lengths of cells; each grid at four offsets
  double least_expected = 4.0;                 ///< expected redetections of a usable cell
  /// p-value below which a cell is provisionally removed. If a fifth of the map is gone, a strict
  /// value would leave half of it among the cells that determine the variation of present cells.
  double try_at = 0.01;
  double apart_m = 1.0;  ///< [m] between lost landmarks of two objects
};

struct RemovedCell {
  std::vector<std::size_t> landmarks;                ///< indices of landmarks
  std::size_t size = 0;                              ///< in `sides_m`
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< lower left corner [m], map frame
  double p = 1.0;  ///< p-value of so few redetections given the present cells; 1 if the cell is not
                   ///< nearly empty
};

/// Cells formed by the landmarks that are still present.
struct PresentCells {
  std::vector<RemovedCell> squares;
  std::vector<double> scatter;         ///< variation between cells, by cell size [log odds]
  std::vector<std::uint8_t> can_tell;  ///< by cell size: 1 if the variation could be estimated

  [[nodiscard]] double widest_scatter() const;  ///< largest estimated variation; 0 if there is none
};

/// Fits the redetection probabilities (`fit_redetection_probabilities`) to the landmarks with a
/// nonzero `stands`, and forms the cells of these landmarks.
[[nodiscard]] PresentCells present_cells(const std::vector<std::uint8_t>& stands,
                                         const RemovedCellOptions& options,
                                         std::vector<LandmarkRedetection>& chances);

struct RemovedCells {
  std::vector<RemovedCell> squares;  ///< removed cells, p below `try_at`, without common landmarks
  std::vector<RemovedCell> tests;    ///< all cells before any removal
  std::size_t neighbours = 0;        ///< largest number of cells that touch one cell
};

/// Removes the cell with the smallest p-value, refits probabilities and variation to the rest, and
/// repeats. The p-value of each removed cell is that given the rest: removed cells must not inform
/// the model of present ones, and similar removed cells would mask each other. Deterministic.
[[nodiscard]] RemovedCells removed_cells(std::vector<LandmarkRedetection>& chances,
                                         const RemovedCellOptions& options = {});

/// Redetections of a set of landmarks with their probabilities.
[[nodiscard]] GroupCount count_of(const std::vector<std::size_t>& landmarks,
                                  const std::vector<LandmarkRedetection>& chances);
/// p-value of so few redetections; 1 if the set is not nearly empty.
[[nodiscard]] double chance_of(const std::vector<std::size_t>& landmarks,
                               double scatter,
                               const std::vector<LandmarkRedetection>& chances);

}  // namespace roadbook
