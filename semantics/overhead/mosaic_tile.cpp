#include "semantics/overhead/mosaic_tile.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <opencv2/imgproc.hpp>

#include "base/error.hpp"
#include "base/files/disk_space.hpp"
#include "base/target_clones.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kPixels = std::size_t{kTileSide} * kTileSide;
constexpr float kMiddleGrey = 128.0F;
// A saturated pixel gives only a lower bound of the brightness. It matters only where no other
// pixel exists.
constexpr float kSaturationBegins = 240.0F;
constexpr float kSaturatedWeight = 0.02F;

float bilinear(const cv::Mat& image, float x, float y) {
  x = std::clamp(x, 0.0F, static_cast<float>(image.cols - 1) - 0.001F);
  y = std::clamp(y, 0.0F, static_cast<float>(image.rows - 1) - 0.001F);
  const int ix = static_cast<int>(x);
  const int iy = static_cast<int>(y);
  const float a = x - static_cast<float>(ix);
  const float b = y - static_cast<float>(iy);
  const std::uint8_t* const upper = image.ptr<std::uint8_t>(iy) + ix;
  const std::uint8_t* const lower = image.ptr<std::uint8_t>(iy + 1) + ix;
  const float top = static_cast<float>(upper[0]) * (1 - a) + static_cast<float>(upper[1]) * a;
  const float bottom = static_cast<float>(lower[0]) * (1 - a) + static_cast<float>(lower[1]) * a;
  return top * (1 - b) + bottom * b;
}

float saturation_weight(float grey) {
  if (grey <= kSaturationBegins) return 1.0F;
  const float t = std::min(1.0F, (grey - kSaturationBegins) / (254.0F - kSaturationBegins));
  return 1.0F + t * (kSaturatedWeight - 1.0F);
}

// Adds a row of a block to the sums of its pixels.
ROADBOOK_CLONES __attribute__((optimize("O3"))) void add_greys(const float* __restrict grey,
                                                               const float* __restrict weight,
                                                               float gain,
                                                               float* __restrict weights,
                                                               float* __restrict balanced,
                                                               float* __restrict balanced_squares,
                                                               float* __restrict recorded,
                                                               float* __restrict recorded_squares) {
  for (int c = 0; c < TileGround::kStep; ++c) {
    const float w = weight[c];
    const float even = grey[c] * gain - kMiddleGrey;
    const float own = grey[c] - kMiddleGrey;
    weights[c] += w;
    balanced[c] += w * even;
    balanced_squares[c] += w * even * even;
    recorded[c] += w * own;
    recorded_squares[c] += w * own * own;
  }
}

// Counts a frame at the pixels of a row of a block.
ROADBOOK_CLONES __attribute__((optimize("O3"))) void add_frame(const float* __restrict weight,
                                                               std::uint32_t frame,
                                                               std::uint16_t* __restrict count,
                                                               std::uint32_t* __restrict first,
                                                               std::uint32_t* __restrict last,
                                                               float* __restrict best_weight,
                                                               std::uint32_t* __restrict best) {
  constexpr std::uint16_t kMost = std::numeric_limits<std::uint16_t>::max();
  for (int c = 0; c < TileGround::kStep; ++c) {
    first[c] = count[c] == 0 ? frame : first[c];
    last[c] = frame;
    best[c] = weight[c] > best_weight[c] ? frame : best[c];
    best_weight[c] = weight[c] > best_weight[c] ? weight[c] : best_weight[c];
  }
  for (int c = 0; c < TileGround::kStep; ++c)
    count[c] = static_cast<std::uint16_t>(count[c] + (count[c] != kMost ? 1 : 0));
}

template <typename T>
void write_all(std::ofstream& out, const std::vector<T>& values) {
  out.write(reinterpret_cast<const char*>(values.data()),
            static_cast<std::streamsize>(values.size() * sizeof(T)));
}

template <typename T>
void read_all(std::ifstream& in, std::vector<T>* values) {
  in.read(reinterpret_cast<char*>(values->data()),
          static_cast<std::streamsize>(values->size() * sizeof(T)));
}

}  // namespace

Eigen::AlignedBox2d tile_rectangle(TileIndex index, double resolution_m) {
  const double side = kTileSide * resolution_m;
  return {Eigen::Vector2d(index.column * side, -(index.row + 1) * side),
          Eigen::Vector2d((index.column + 1) * side, -index.row * side)};
}

TileGround::TileGround(TileIndex index, double resolution_m, const GroundModel& ground) {
  nodes.reserve(std::size_t{kNodes} * kNodes);
  for (int r = 0; r < kNodes; ++r) {
    for (int c = 0; c < kNodes; ++c) {
      const double x = (index.column * kTileSide + c * kStep + 0.5) * resolution_m;
      const double y = -(index.row * kTileSide + r * kStep + 0.5) * resolution_m;
      const auto z = ground.height(x, y);
      nodes.emplace_back(x, y, z.value_or(std::numeric_limits<double>::quiet_NaN()));
    }
  }
}

MosaicImage make_mosaic_image(const cv::Mat& image, double gain) {
  MosaicImage result;
  result.gain = static_cast<float>(gain);
  result.levels[0] = image;
  for (std::size_t level = 1; level < result.levels.size() && !image.empty(); ++level) {
    const cv::Mat& finer = result.levels[level - 1];
    cv::resize(finer, result.levels[level], {(finer.cols + 1) / 2, (finer.rows + 1) / 2}, 0, 0,
               cv::INTER_AREA);
  }
  return result;
}

MosaicTile::MosaicTile(TileIndex index, double resolution_m, const GroundModel& ground)
    : index_(index),
      resolution_m_(resolution_m),
      ground_(index, resolution_m, ground),
      weight_(kPixels, 0.0F),
      best_weight_(kPixels, 0.0F),
      balanced_{std::vector(kPixels, 0.0F), std::vector(kPixels, 0.0F)},
      recorded_{std::vector(kPixels, 0.0F), std::vector(kPixels, 0.0F)},
      count_(kPixels, 0),
      best_(kPixels, kNoFrame),
      first_(kPixels, kNoFrame),
      last_(kPixels, kNoFrame) {}

void MosaicTile::add(const MosaicImage& image,
                     const GroundCamera& camera,
                     std::uint32_t frame,
                     OverheadMode mode) {
  constexpr int n = TileGround::kNodes;
  // One cell of margin, because the last nodes are the first pixels of the next tile.
  Eigen::AlignedBox2d rectangle = tile_rectangle(index_, resolution_m_);
  rectangle.min().array() -= TileGround::kStep * resolution_m_;
  rectangle.max().array() += TileGround::kStep * resolution_m_;
  if (image.empty() || !camera.may_reach(rectangle)) return;

  std::vector<GroundSight> sights(ground_.nodes.size());
  for (std::size_t i = 0; i < sights.size(); ++i)
    if (!std::isnan(ground_.nodes[i].z())) sights[i] = camera.look_at(ground_.nodes[i]);

  bool contributed = false;
  for (int r = 0; r + 1 < n; ++r) {
    for (int c = 0; c + 1 < n; ++c) {
      const auto at = [&](int row, int column) {
        return sights[static_cast<std::size_t>(row) * n + static_cast<std::size_t>(column)];
      };
      const std::array<GroundSight, 4> corners{at(r, c), at(r, c + 1), at(r + 1, c),
                                               at(r + 1, c + 1)};
      const bool seen = std::ranges::all_of(corners, [](const auto& s) { return s.weight > 0; });
      if (!seen) continue;
      add_block(image, corners, c * TileGround::kStep, r * TileGround::kStep, frame, mode);
      contributed = true;
    }
  }
  if (contributed && (frames_.empty() || frames_.back() != frame)) frames_.push_back(frame);
}

void MosaicTile::add_block(const MosaicImage& image,
                           const std::array<GroundSight, 4>& corners,
                           int column,
                           int row,
                           std::uint32_t frame,
                           OverheadMode mode) {
  const float scale =
      0.25F * (corners[0].scale + corners[1].scale + corners[2].scale + corners[3].scale);
  const int level = scale < 1.5F ? 0 : (scale < 3.0F ? 1 : 2);
  const cv::Mat& source = image.levels[static_cast<std::size_t>(level)];
  const float shrink = 1.0F / static_cast<float>(1 << level);
  constexpr float step = 1.0F / TileGround::kStep;
  for (int r = 0; r < TileGround::kStep; ++r) {
    const float b = static_cast<float>(r) * step;
    const auto along = [&](auto member) {
      const float left = corners[0].*member * (1 - b) + corners[2].*member * b;
      const float right = corners[1].*member * (1 - b) + corners[3].*member * b;
      return std::pair{left, (right - left) * step};
    };
    const auto [u, du] = along(&GroundSight::u);
    const auto [v, dv] = along(&GroundSight::v);
    const auto [w, dw] = along(&GroundSight::weight);
    std::array<float, TileGround::kStep> grey;
    std::array<float, TileGround::kStep> weight;
    for (std::size_t c = 0; c < grey.size(); ++c) {
      const auto a = static_cast<float>(c);
      grey[c] = bilinear(source, (u + a * du + 0.5F) * shrink - 0.5F,
                         (v + a * dv + 0.5F) * shrink - 0.5F);
      weight[c] = w + a * dw;
      if (mode == OverheadMode::kWeighted) weight[c] *= saturation_weight(grey[c]);
    }
    const std::size_t pixel =
        static_cast<std::size_t>(row + r) * kTileSide + static_cast<std::size_t>(column);
    add_greys(grey.data(), weight.data(), image.gain, &weight_[pixel], &balanced_.values[pixel],
              &balanced_.squares[pixel], &recorded_.values[pixel], &recorded_.squares[pixel]);
    add_frame(weight.data(), frame, &count_[pixel], &first_[pixel], &last_[pixel],
              &best_weight_[pixel], &best_[pixel]);
  }
}

std::vector<std::uint8_t> MosaicTile::image(Brightness brightness) const {
  std::vector<std::uint8_t> pixels(kPixels, 0);
  for (std::size_t i = 0; i < kPixels; ++i) {
    if (count_[i] == 0) continue;
    const float mean = sums(brightness).values[i] / weight_[i] + kMiddleGrey;
    pixels[i] = static_cast<std::uint8_t>(std::clamp(std::lround(mean), 1L, 255L));
  }
  return pixels;
}

std::vector<float> MosaicTile::variance(Brightness brightness) const {
  std::vector<float> values(kPixels, -1.0F);
  for (std::size_t i = 0; i < kPixels; ++i) {
    if (count_[i] == 0) continue;
    const float mean = sums(brightness).values[i] / weight_[i];
    values[i] = std::max(0.0F, sums(brightness).squares[i] / weight_[i] - mean * mean);
  }
  return values;
}

std::size_t MosaicTile::bytes() { return kPixels * (6 * sizeof(float) + 2 + 3 * 4); }

void MosaicTile::save(const std::filesystem::path& path) const {
  std::ofstream out(path, std::ios::binary);
  const std::vector<std::uint64_t> size{frames_.size()};
  write_all(out, size);
  write_all(out, frames_);
  for (const auto* floats : {&weight_, &best_weight_, &balanced_.values, &balanced_.squares,
                             &recorded_.values, &recorded_.squares})
    write_all(out, *floats);
  write_all(out, count_);
  for (const auto* ids : {&best_, &first_, &last_}) write_all(out, *ids);
  out.close();
  if (!out)
    throw StorageError("error: " + path.string() + ": writing: got " + write_fault(path) +
                       ", want a disk that takes it");
}

void MosaicTile::load(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::vector<std::uint64_t> size{0};
  read_all(in, &size);
  if (in) frames_.resize(size[0]);
  read_all(in, &frames_);
  for (auto* floats : {&weight_, &best_weight_, &balanced_.values, &balanced_.squares,
                       &recorded_.values, &recorded_.squares})
    read_all(in, floats);
  read_all(in, &count_);
  for (auto* ids : {&best_, &first_, &last_}) read_all(in, ids);
  if (!in)
    throw StorageError("error: " + path.string() +
                       ": reading: got less than was written, want the whole tile");
}

}  // namespace roadbook
