#pragma once

#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "semantics/overhead/ground_image.hpp"

namespace roadbook {

/// A picture of the ground as square PNG tiles at halved resolutions. Unseen pixels are
/// transparent. Level 0 is the coarsest and has a single tile. Tile numbers start at the north-west
/// corner. Safe to use from several threads.
class TilePyramid {
 public:
  static constexpr int kTilePx = 512;

  /// An empty image has no levels and no tiles.
  explicit TilePyramid(const GroundImage& image);

  [[nodiscard]] int levels() const { return static_cast<int>(pictures_.size()); }
  [[nodiscard]] double resolution_m(int level) const;
  /// Returns a tile as PNG. Empty if there is no such tile.
  [[nodiscard]] std::shared_ptr<const std::string> tile(int level, int column, int row) const;

 private:
  using Key = std::tuple<int, int, int>;
  [[nodiscard]] std::string encoded(const Key& key) const;

  double finest_m_ = 0.0;
  std::vector<cv::Mat> pictures_;  ///< grey, 0: not seen; finest first
  mutable std::mutex mutex_;
  mutable std::map<Key, std::shared_ptr<const std::string>> kept_;
  mutable std::deque<Key> order_;  ///< oldest first
  mutable std::size_t kept_bytes_ = 0;
};

}  // namespace roadbook
