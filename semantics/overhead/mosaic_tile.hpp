#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "semantics/overhead/geotiff_writer.hpp"
#include "semantics/overhead/ground_camera.hpp"
#include "semantics/overhead/ground_model.hpp"

namespace roadbook {

// One square of the overhead image while images are averaged into it.
//
// Overhead pixels are numbered from the map's origin, columns east and rows south; the centre of
// pixel (c, r) is x = (c + 1/2) res, y = -(r + 1/2) res. Tiles are GeoTIFF blocks of that grid.

inline constexpr int kTileSide = GeoTiffWriter::kBlock;
inline constexpr std::uint32_t kNoFrame = 0xFFFFFFFF;

struct TileIndex {
  int row = 0;
  int column = 0;
  auto operator<=>(const TileIndex&) const = default;
};

/// Rectangle of a tile in map xy.
[[nodiscard]] Eigen::AlignedBox2d tile_rectangle(TileIndex index, double resolution_m);

/// Grid of ground points at which the camera model is evaluated exactly; pixel coordinates between
/// them are interpolated. Points are 8 overhead pixels apart. For a fisheye camera 1 m above the
/// ground the bilinear error is below 0.16^2 / 8 * 0.65 / 1 m = 2 mm on the ground (second
/// derivative of f atan(x / h)); it is smaller for higher cameras.
struct TileGround {
  static constexpr int kStep = 8;
  static constexpr int kNodes = kTileSide / kStep + 1;

  TileGround(TileIndex index, double resolution_m, const GroundModel& ground);
  std::vector<Eigen::Vector3d> nodes;  ///< row by row; z is NaN if the ground is unknown
};

/// An image at full, half and quarter size, so that close views are not aliased.
struct MosaicImage {
  static constexpr int kLevels = 3;
  std::array<cv::Mat, kLevels> levels;
  float gain = 1.0F;
  [[nodiscard]] bool empty() const { return levels[0].empty(); }
};
[[nodiscard]] MosaicImage make_mosaic_image(const cv::Mat& image, double gain);

/// Brightness to use: as recorded, or balanced by the gains.
enum class Brightness { kBalanced, kRecorded };

/// Sums per overhead pixel for both brightnesses. The effect of the balance is known only after all
/// images are added, so both are kept.
class MosaicTile {
 public:
  MosaicTile(TileIndex index, double resolution_m, const GroundModel& ground);

  /// Adds the part of `image` that shows this tile. Frames must come in ascending order.
  void add(const MosaicImage& image,
           const GroundCamera& camera,
           std::uint32_t frame,
           OverheadMode mode);

  [[nodiscard]] TileIndex index() const { return index_; }
  /// All frames that contributed to any pixel, ascending.
  [[nodiscard]] const std::vector<std::uint32_t>& frames() const { return frames_; }

  /// Layers, kTileSide^2 values each.
  [[nodiscard]] std::vector<std::uint8_t> image(Brightness brightness) const;  ///< 0: no data
  [[nodiscard]] std::vector<float> variance(Brightness brightness) const;      ///< -1: no data
  [[nodiscard]] const std::vector<std::uint16_t>& count() const { return count_; }
  [[nodiscard]] const std::vector<std::uint32_t>& best() const { return best_; }
  [[nodiscard]] const std::vector<std::uint32_t>& first() const { return first_; }
  [[nodiscard]] const std::vector<std::uint32_t>& last() const { return last_; }
  [[nodiscard]] static std::size_t bytes();

  void save(const std::filesystem::path& path) const;  ///< throws StorageError
  void load(const std::filesystem::path& path);        ///< throws StorageError

 private:
  void add_block(const MosaicImage& image,
                 const std::array<GroundSight, 4>& corners,
                 int column,
                 int row,
                 std::uint32_t frame,
                 OverheadMode mode);
  struct Sums {
    std::vector<float> values, squares;
  };
  [[nodiscard]] const Sums& sums(Brightness brightness) const {
    return brightness == Brightness::kBalanced ? balanced_ : recorded_;
  }
  TileIndex index_;
  double resolution_m_;
  TileGround ground_;
  // Grey values are summed as differences from 128: floats then keep the variance exact enough.
  std::vector<float> weight_, best_weight_;
  Sums balanced_, recorded_;
  std::vector<std::uint16_t> count_;
  std::vector<std::uint32_t> best_, first_, last_;
  std::vector<std::uint32_t> frames_;
};

}  // namespace roadbook
