#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>

#include "base/parallel.hpp"
#include "base/progress.hpp"
#include "sim/world/paint.hpp"

namespace roadbook {

/// Paints the rows of large canvases on several threads. Between two bands of rows it calls
/// `progress`, which may stop it (a place of a square kilometre takes many seconds).
struct RowWork {
  int num_threads = 0;
  Progress progress;

  /// Calls `progress`. Throws Interrupted if it returns false.
  void pause() const { report(progress, "world", 0, 1); }

  void run(const Canvas& canvas, const std::function<void(std::size_t)>& paint_row) const {
    constexpr std::size_t kBand = 256;
    const auto rows = static_cast<std::size_t>(canvas.image.rows);
    for (std::size_t first = 0; first < rows; first += kBand) {
      pause();
      parallel_for(std::min(kBand, rows - first), num_threads,
                   [&](std::size_t i) { paint_row(first + i); });
    }
  }
};

}  // namespace roadbook
