#include "diagnosis/map_changes/removed_regions.hpp"

#include <algorithm>

namespace roadbook {
namespace {

using Landmarks = std::vector<std::size_t>;

bool touch(const Landmarks& a,
           const Landmarks& b,
           double apart_m,
           const std::vector<LandmarkRedetection>& chances) {
  for (const std::size_t i : a)
    for (const std::size_t j : b)
      if (!chances[i].found && !chances[j].found &&
          (chances[i].p_map - chances[j].p_map).head<2>().norm() < apart_m)
        return true;
  return false;
}

// p-values of all cells (sorted) and of the provisionally removed ones (most significant first),
// given the present cells.
struct JudgedSquares {
  std::vector<double> all;
  double scatter = 0.0;
};

JudgedSquares judge_squares(const RemovedCellOptions& options,
                            std::vector<LandmarkRedetection>& chances,
                            RemovedCells& fallen) {
  std::vector<std::uint8_t> stands(chances.size(), 1);
  for (const RemovedCell& square : fallen.squares)
    for (const std::size_t i : square.landmarks) stands[i] = 0;
  const PresentCells rest = present_cells(stands, options, chances);
  const auto now = [&](const RemovedCell& square) {
    return chance_of(square.landmarks, rest.scatter[square.size], chances);
  };
  for (RemovedCell& square : fallen.squares) square.p = now(square);
  std::stable_sort(fallen.squares.begin(), fallen.squares.end(),
                   [](const RemovedCell& a, const RemovedCell& b) { return a.p < b.p; });
  JudgedSquares judged{{}, rest.widest_scatter()};
  for (const RemovedCell& square : fallen.tests) judged.all.push_back(now(square));
  std::sort(judged.all.begin(), judged.all.end());
  return judged;
}

// The cells that the Benjamini-Hochberg procedure names, each as its own region: up to the last
// whose p-value is below `level` times its rank over the number of cells.
std::vector<RemovedRegion> name(const RemovedCells& fallen,
                                const std::vector<double>& all,
                                double level) {
  std::vector<double> corrected(all.size());
  double least = 1.0;
  for (std::size_t i = all.size(); i-- > 0;)
    corrected[i] = least =
        std::min(least, all[i] * static_cast<double>(all.size()) / static_cast<double>(i + 1));
  std::vector<RemovedRegion> named;
  for (const RemovedCell& square : fallen.squares) {
    const auto next = std::lower_bound(all.begin(), all.end(), square.p);
    if (next == all.end() || corrected[static_cast<std::size_t>(next - all.begin())] >= level)
      break;
    named.push_back({square.landmarks, corrected[static_cast<std::size_t>(next - all.begin())]});
  }
  return named;
}

void add_landmarks(const Landmarks& more, Landmarks& all) {
  all.insert(all.end(), more.begin(), more.end());
}

void join(double apart_m,
          const std::vector<LandmarkRedetection>& chances,
          std::vector<RemovedRegion>& things) {
  for (std::size_t a = 0; a < things.size(); ++a)
    for (std::size_t b = a + 1; b < things.size();) {
      if (!touch(things[a].landmarks, things[b].landmarks, apart_m, chances)) {
        ++b;
        continue;
      }
      add_landmarks(things[b].landmarks, things[a].landmarks);
      things.erase(things.begin() + static_cast<std::ptrdiff_t>(b));
      b = a + 1;
    }
}

// Cells that are not named but touch a region, most significant first.
void extend(const RemovedCells& fallen,
            const RemovedRegionOptions& options,
            const std::vector<LandmarkRedetection>& chances,
            std::vector<RemovedRegion>& things) {
  const double enough =
      options.beside / static_cast<double>(std::max<std::size_t>(1, fallen.neighbours));
  for (std::size_t s = things.size(); s < fallen.squares.size(); ++s) {
    const RemovedCell& square = fallen.squares[s];
    if (square.p >= enough) break;
    for (RemovedRegion& thing : things)
      if (touch(thing.landmarks, square.landmarks, options.squares.apart_m, chances)) {
        add_landmarks(square.landmarks, thing.landmarks);
        break;
      }
  }
}

}  // namespace

RemovedRegions removed_regions(std::vector<LandmarkRedetection>& chances,
                               const RemovedRegionOptions& options) {
  RemovedCells fallen = removed_cells(chances, options.squares);
  RemovedRegions result;
  result.tests = fallen.tests.size();
  const JudgedSquares judged = judge_squares(options.squares, chances, fallen);
  result.scatter = judged.scatter;
  result.named = name(fallen, judged.all, options.level);
  extend(fallen, options, chances, result.named);
  join(options.squares.apart_m, chances, result.named);
  return result;
}

}  // namespace roadbook
