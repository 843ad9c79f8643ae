#include "vo/brisk_description.hpp"

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "base/error.hpp"
#include "base/target_clones.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kPlaces = 60;
constexpr std::size_t kPadded = 64;  // a multiple of the lanes of a vector
constexpr std::size_t kLanes = 8;
constexpr int kDirections = 1024;
constexpr std::size_t kBits = 512;

// A vector in registers; without AVX2 the compiler takes two halves.
using Floats = float __attribute__((vector_size(kLanes * sizeof(float))));
using Ints = std::int32_t __attribute__((vector_size(kLanes * sizeof(std::int32_t))));

// Values of one box at each place: where it lies in the image, and what its parts count.
struct alignas(32) Boxes {
  std::array<std::int32_t, kPadded> left, top, right, bottom;  // border pixels, which count in part
  std::array<std::int32_t, kPadded> left_top, right_top, right_bottom, left_bottom;  // corners
  std::array<std::int32_t, kPadded> left_side, top_side, right_side, bottom_side;
};

struct BriskPattern {
  // Of the places at each direction, relative to the corner.
  std::vector<std::array<float, kPadded>> x, y;
  alignas(32) std::array<float, kPadded> half_side;       // of the boxes [pixels]
  alignas(32) std::array<float, kPadded> whole;           // weight of a whole pixel
  alignas(32) std::array<std::int32_t, kPadded> weights;  // sum of the weights of a box, / 1024
  // Pairs far apart, for each place with all places before it; 0: not such a pair.
  std::vector<std::array<std::int32_t, kPadded>> far_x, far_y;
  std::array<std::uint8_t, kBits> first, second;  // pairs close together: the places of each bit
  float border = 0.0F;                            // [pixels]
  BriskPattern();
};

// The constants are those of the authors' implementation, which OpenCV contains.
BriskPattern::BriskPattern() : x(kDirections), y(kDirections), far_x(kPlaces), far_y(kPlaces) {
  constexpr std::array<double, 5> kRadius{0.0, 0.85 * 2.9, 0.85 * 4.9, 0.85 * 7.4, 0.85 * 10.8};
  constexpr std::array<int, 5> kOnRing{1, 10, 14, 15, 20};
  constexpr float kClose = 5.85F;
  constexpr float kFar = 8.2F;
  // The tenth of 64 steps of scale from 1 to 30.
  const float step = static_cast<float>(std::log(30.0F) / std::log(2.0)) / 64.0F;
  const auto scale = static_cast<float>(std::pow(2.0, static_cast<double>(10.0F * step)));
  half_side.fill(1.0F);
  whole.fill(0.0F);
  weights.fill(1);
  std::array<float, kPlaces> plain_x{};
  std::array<float, kPlaces> plain_y{};
  std::size_t place = 0;
  for (std::size_t ring = 0; ring < kRadius.size(); ++ring) {
    const auto radius = static_cast<float>(kRadius[ring]);
    for (int k = 0; k < kOnRing[ring]; ++k, ++place) {
      const double angle = k * 2 * std::numbers::pi / kOnRing[ring];
      for (int direction = 0; direction < kDirections; ++direction) {
        const double turned = angle + direction * 2 * std::numbers::pi / kDirections;
        const auto d = static_cast<std::size_t>(direction);
        x[d][place] = static_cast<float>(scale * radius * std::cos(turned));
        y[d][place] = static_cast<float>(scale * radius * std::sin(turned));
      }
      plain_x[place] = static_cast<float>(radius * std::cos(angle));
      plain_y[place] = static_cast<float>(radius * std::sin(angle));
      const float half = ring == 0 ? 1.3F * scale * 0.5F
                                   : static_cast<float>(1.3F * scale * static_cast<double>(radius) *
                                                        std::sin(std::numbers::pi / kOnRing[ring]));
      const float area = 4.0F * half * half;
      const auto weight = static_cast<int>(4194304.0 / area);
      half_side[place] = half;
      whole[place] = static_cast<float>(weight);
      weights[place] = static_cast<int>(static_cast<float>(weight) * area / 1024.0);
      border = std::max(border, std::ceil(scale * radius + half) + 1.0F);
    }
  }
  std::size_t bit = 0;
  for (std::size_t i = 1; i < kPlaces; ++i)
    for (std::size_t j = 0; j < i; ++j) {
      const float dx = plain_x[j] - plain_x[i];
      const float dy = plain_y[j] - plain_y[i];
      const float squared = dx * dx + dy * dy;
      if (squared > kFar * kFar) {
        far_x[i][j] = static_cast<int>((dx / squared) * 2048.0 + 0.5);
        far_y[i][j] = static_cast<int>((dy / squared) * 2048.0 + 0.5);
      } else if (squared < kClose * kClose) {
        ROADBOOK_ASSERT(bit < kBits);
        first[bit] = static_cast<std::uint8_t>(i);
        second[bit] = static_cast<std::uint8_t>(j);
        ++bit;
      }
    }
  ROADBOOK_ASSERT(place == kPlaces && bit == kBits);
}

const BriskPattern& pattern() {
  static const BriskPattern made;
  return made;
}

// No function returns a vector: without AVX that would change how it is called.
template <class Vector, class T>
[[gnu::always_inline]] inline void load(const T* from, Vector& v) {
  std::memcpy(&v, from, sizeof v);
}
template <class Vector, class T>
[[gnu::always_inline]] inline void store(T* to, const Vector& v) {
  std::memcpy(to, &v, sizeof v);
}

// The pixel that holds a coordinate above 0, whose centre is a whole number.
[[gnu::always_inline]] inline void pixel_of(const Floats& v, Ints& pixel) {
  const Ints whole = __builtin_convertvector(v, Ints);
  const Floats part = v - __builtin_convertvector(whole, Floats);
  pixel = whole - (part >= 0.5F);  // a true comparison is -1
}

ROADBOOK_CLONES void place_boxes(const float* x,
                                 const float* y,
                                 const float* half_side,
                                 const float* whole,
                                 float at_x,
                                 float at_y,
                                 Boxes* boxes) {
  for (std::size_t k = 0; k < kPadded; k += kLanes) {
    Floats half, weight, middle_x, middle_y;
    load(half_side + k, half);
    load(whole + k, weight);
    load(x + k, middle_x);
    load(y + k, middle_y);
    middle_x += at_x;
    middle_y += at_y;
    const Floats low_x = middle_x - half;
    const Floats low_y = middle_y - half;
    const Floats high_x = middle_x + half;
    const Floats high_y = middle_y + half;
    Ints left, top, right, bottom;
    pixel_of(low_x, left);
    pixel_of(low_y, top);
    pixel_of(high_x, right);
    pixel_of(high_y, bottom);
    // How much of its border pixels the box covers.
    const Floats of_left = __builtin_convertvector(left, Floats) - low_x + 0.5F;
    const Floats of_top = __builtin_convertvector(top, Floats) - low_y + 0.5F;
    const Floats of_right = high_x - __builtin_convertvector(right, Floats) + 0.5F;
    const Floats of_bottom = high_y - __builtin_convertvector(bottom, Floats) + 0.5F;
    store(&boxes->left[k], left);
    store(&boxes->top[k], top);
    store(&boxes->right[k], right);
    store(&boxes->bottom[k], bottom);
    const auto store_counts = [&](std::int32_t* to, const Floats& share) {
      store(to, __builtin_convertvector(share * weight, Ints));
    };
    store_counts(&boxes->left_top[k], of_left * of_top);
    store_counts(&boxes->right_top[k], of_right * of_top);
    store_counts(&boxes->right_bottom[k], of_right * of_bottom);
    store_counts(&boxes->left_bottom[k], of_left * of_bottom);
    store_counts(&boxes->left_side[k], of_left);
    store_counts(&boxes->top_side[k], of_top);
    store_counts(&boxes->right_side[k], of_right);
    store_counts(&boxes->bottom_side[k], of_bottom);
  }
}

// Sums of pixels, times their weights. `sums` is the integral image, a row and a column larger.
void sum_boxes(const cv::Mat& image, const cv::Mat& sums, const Boxes& b, double* values) {
  const auto image_step = static_cast<std::ptrdiff_t>(image.step[0]);
  const auto sums_step = static_cast<std::ptrdiff_t>(sums.step1());
  for (std::size_t k = 0; k < kPlaces; ++k) {
    const std::uint8_t* const top = image.data + b.top[k] * image_step;
    const int left = b.left[k];
    const int right = b.right[k];
    // In all but the smallest boxes the published implementation reads the two lower corners a row
    // too high and a column too far to the right. Descriptors of other programs are made this way.
    const bool large = right - left + b.bottom[k] - b.top[k] > 4;
    const std::uint8_t* const bottom =
        image.data + (b.bottom[k] - large) * image_step + static_cast<int>(large);
    const auto* const row0 = sums.ptr<std::int32_t>(b.top[k]);
    const auto* const row1 = row0 + sums_step;
    const auto* const row2 = sums.ptr<std::int32_t>(b.bottom[k]);
    const auto* const row3 = row2 + sums_step;
    // Corners of the inner rectangle of whole pixels in the integral image.
    const int inner00 = row1[left + 1];
    const int inner01 = row1[right];
    const int inner10 = row2[left + 1];
    const int inner11 = row2[right];
    const int sum_left = inner10 - inner00 - row2[left] + row1[left];
    const int sum_right = row2[right + 1] - row1[right + 1] - inner11 + inner01;
    const int sum_top = inner01 - inner00 - row0[right] + row0[left + 1];
    const int sum_bottom = row3[right] - row3[left + 1] - inner11 + inner10;
    const int inner = inner11 - inner10 - inner01 + inner00;
    const int whole = static_cast<int>(pattern().whole[k]);
    const int sum = b.left_top[k] * top[left] + b.right_top[k] * top[right] +
                    b.right_bottom[k] * bottom[right] + b.left_bottom[k] * bottom[left] +
                    b.left_side[k] * sum_left + b.right_side[k] * sum_right +
                    b.top_side[k] * sum_top + b.bottom_side[k] * sum_bottom + whole * inner;
    values[k] = sum;
  }
}

// Means of the boxes, 1024 times the grey value, rounded as integers are.
ROADBOOK_CLONES void divide(const double* sums, const std::int32_t* weights, std::int32_t* values) {
  for (std::size_t k = 0; k < kPlaces; ++k)
    values[k] = static_cast<std::int32_t>((sums[k] + weights[k] / 2) / weights[k]);
}

void sample(const cv::Mat& image,
            const cv::Mat& sums,
            const cv::Point2f& corner,
            std::size_t direction,
            std::int32_t* values) {
  const BriskPattern& p = pattern();
  Boxes boxes;
  place_boxes(p.x[direction].data(), p.y[direction].data(), p.half_side.data(), p.whole.data(),
              corner.x, corner.y, &boxes);
  std::array<double, kPlaces> of_boxes{};
  sum_boxes(image, sums, boxes, of_boxes.data());
  divide(of_boxes.data(), p.weights.data(), values);
}

// Sum of the differences of far places along their connections. `values` has kPadded entries.
ROADBOOK_CLONES void add_differences(const std::int32_t* values,
                                     const std::array<std::int32_t, kPadded>* far_x,
                                     const std::array<std::int32_t, kPadded>* far_y,
                                     std::int32_t* direction) {
  Ints sum_x{};
  Ints sum_y{};
  for (std::size_t i = 1; i < kPlaces; ++i)
    for (std::size_t j = 0; j < i; j += kLanes) {
      Ints other, weight_x, weight_y;
      load(values + j, other);
      load(far_x[i].data() + j, weight_x);
      load(far_y[i].data() + j, weight_y);
      const Ints difference = values[i] - other;
      const Ints along_x = difference * weight_x;
      const Ints along_y = difference * weight_y;
      sum_x += (along_x + ((along_x >> 31) & 1023)) >> 10;  // divided by 1024, towards 0
      sum_y += (along_y + ((along_y >> 31) & 1023)) >> 10;
    }
  direction[0] = 0;
  direction[1] = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    direction[0] += sum_x[lane];
    direction[1] += sum_y[lane];
  }
}

std::size_t direction_of(const std::int32_t* values) {
  const BriskPattern& p = pattern();
  std::array<std::int32_t, 2> along{};
  add_differences(values, p.far_x.data(), p.far_y.data(), along.data());
  const auto degrees =
      static_cast<float>(std::atan2(static_cast<float>(along[1]), static_cast<float>(along[0])) /
                         std::numbers::pi * 180.0);
  // Rounded towards 0, as published, on both sides of it.
  const int step = static_cast<int>(kDirections * (degrees / 360.0) + 0.5);
  return static_cast<std::size_t>((step + kDirections) % kDirections);
}

}  // namespace

float description_border_px() { return pattern().border; }

DescribedCorners describe_corners(const cv::Mat& image, std::span<const cv::Point2f> corners) {
  ROADBOOK_ASSERT(image.type() == CV_8UC1);
  const BriskPattern& p = pattern();
  DescribedCorners described;
  cv::Mat sums;
  cv::integral(image, sums, CV_32S);
  const float right = static_cast<float>(image.cols) - p.border;
  const float bottom = static_cast<float>(image.rows) - p.border;
  alignas(32) std::array<std::int32_t, kPadded> values{};
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const cv::Point2f& at = corners[c];
    if (at.x < p.border || at.y < p.border || at.x >= right || at.y >= bottom) continue;
    sample(image, sums, at, 0, values.data());
    sample(image, sums, at, direction_of(values.data()), values.data());
    Descriptor descriptor{};
    for (std::size_t bit = 0; bit < kBits; ++bit)
      descriptor[bit / 8] = static_cast<std::uint8_t>(
          descriptor[bit / 8] |
          ((values[p.first[bit]] > values[p.second[bit]] ? 1 : 0) << bit % 8));
    described.corners.push_back(static_cast<int>(c));
    described.descriptors.push_back(descriptor);
  }
  return described;
}

}  // namespace roadbook
