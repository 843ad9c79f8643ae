#include "vo/still_parts.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace roadbook {
namespace {

constexpr double kStandingLevels = 2.0;  // mean change between images of a vehicle at standstill
constexpr int kWindow = 7;               // over which a pixel's statistics are averaged
constexpr double kCoherent = 0.8;
constexpr double kGradient = 1.0;       // [grey levels / px] of an edge; noise stays below
constexpr double kGradientAtSky = 4.0;  // the same where the part lies above the horizon
constexpr double kHorizon = 0.09;       // sine of the angle to it within which it may lie
constexpr double kMostCoherent = 0.6;   // share of edges above which the scene is at standstill
constexpr double kStillShare = 0.25;    // of the scene's median change: a surface of the vehicle
constexpr double kStillLevels = 4.0;    // and at most this
constexpr double kOutlineShare = 0.6;   // of a bare region's outline along coherent edges
constexpr double kFewestShare = 5e-4;   // of the image, of a part that counts

cv::Mat ellipse(int size) { return cv::getStructuringElement(cv::MORPH_ELLIPSE, {size, size}); }

constexpr std::size_t kSamples = 32;        // images of a drive
constexpr std::size_t kDenseSamples = 512;  // of a drive with long stops

// Appends `image` unless it hardly differs from the last one: the vehicle is at standstill.
void add_if_moved(const cv::Mat& image, std::vector<cv::Mat>& moving) {
  cv::Mat change;
  if (!moving.empty()) cv::absdiff(image, moving.back(), change);
  if (moving.empty() || cv::mean(change)[0] >= kStandingLevels) moving.push_back(image);
}

std::vector<cv::Mat> images_in_motion(const std::vector<cv::Mat>& images) {
  std::vector<cv::Mat> moving;
  for (const cv::Mat& image : images) add_if_moved(image, moving);
  return moving;
}

// Calls `use(image)` for `samples` of the images, at equal steps.
template <class Use>
void for_samples(std::size_t count,
                 std::size_t samples,
                 const std::function<cv::Mat(std::size_t)>& read,
                 const Use& use) {
  samples = std::min(samples, count);
  for (std::size_t k = 0; samples > 1 && k < samples; ++k) {
    const cv::Mat image = read(k * (count - 1) / (samples - 1));
    if (!image.empty()) use(image);
  }
}

// What a pixel's surroundings did over the images.
struct Statistics {
  cv::Mat gradient;   // mean |g|
  cv::Mat coherence;  // |mean g| / mean |g|
  cv::Mat change;     // mean absolute deviation from the mean brightness
};

Statistics statistics_of(const std::vector<cv::Mat>& images) {
  const cv::Size size = images.front().size();
  cv::Mat mean = cv::Mat::zeros(size, CV_32F);
  cv::Mat sum_x = mean.clone();
  cv::Mat sum_y = mean.clone();
  cv::Mat sum_length = mean.clone();
  cv::Mat grey;
  cv::Mat smooth;
  cv::Mat x;
  cv::Mat y;
  cv::Mat length;
  for (const cv::Mat& image : images) {
    image.convertTo(grey, CV_32F);
    mean += grey;
    cv::GaussianBlur(grey, smooth, {}, 1.0);
    cv::Sobel(smooth, x, CV_32F, 1, 0, 3, 0.125);
    cv::Sobel(smooth, y, CV_32F, 0, 1, 3, 0.125);
    cv::magnitude(x, y, length);
    sum_x += x;
    sum_y += y;
    sum_length += length;
  }
  const double n = static_cast<double>(images.size());
  mean /= n;
  Statistics s;
  s.change = cv::Mat::zeros(size, CV_32F);
  for (const cv::Mat& image : images) {
    image.convertTo(grey, CV_32F);
    cv::absdiff(grey, mean, grey);
    s.change += grey;
  }
  cv::blur(s.change / n, s.change, {kWindow, kWindow});
  cv::magnitude(sum_x, sum_y, length);
  cv::blur(length / n, length, {kWindow, kWindow});
  cv::blur(sum_length / n, s.gradient, {kWindow, kWindow});
  s.coherence = length / (s.gradient + 1e-3);
  return s;
}

// 255 where the lens has an image, some pixels inside the edge of its view: the edge itself never
// moves.
cv::Mat seen_by(const Camera& camera) {
  cv::Mat seen(camera.height, camera.width, CV_8U, cv::Scalar(0));
  for (int v = 0; v < seen.rows; ++v)
    for (int u = 0; u < seen.cols; ++u) {
      const auto ray = camera.bearing({u, v});
      if (ray && camera.project(*ray)) seen.at<std::uint8_t>(v, u) = 255;
    }
  cv::erode(seen, seen, ellipse(kWindow + 4), {-1, -1}, 1, cv::BORDER_CONSTANT, 255);
  return seen;
}

float median_of(const cv::Mat& values, const cv::Mat& where) {
  std::vector<float> list;
  for (int v = 0; v < values.rows; ++v)
    for (int u = 0; u < values.cols; ++u)
      if (where.at<std::uint8_t>(v, u) != 0) list.push_back(values.at<float>(v, u));
  if (list.empty()) return 0.0F;
  const auto middle = list.begin() + static_cast<std::ptrdiff_t>(list.size() / 2);
  std::nth_element(list.begin(), middle, list.end());
  return *middle;
}

// Calls `part(mask, rectangle)` for each connected part of `mask` that is large enough.
template <class Part>
void for_each_part(const cv::Mat& mask, const Part& part) {
  cv::Mat labels;
  cv::Mat stats;
  cv::Mat centres;
  const int count = cv::connectedComponentsWithStats(mask, labels, stats, centres);
  const double fewest = kFewestShare * static_cast<double>(mask.total());
  for (int i = 1; i < count; ++i)
    if (stats.at<int>(i, cv::CC_STAT_AREA) >= fewest) part(cv::Mat(labels == i));
}

// Regions without texture whose brightness stays and whose outline runs along the edges.
cv::Mat bare_parts(const cv::Mat& still, const cv::Mat& edges, const cv::Mat& seen) {
  cv::Mat near_edges;
  cv::dilate(edges, near_edges, ellipse(kWindow));
  cv::Mat bare = cv::Mat::zeros(still.size(), CV_8U);
  for_each_part(still & ~edges & seen, [&](const cv::Mat& part) {
    cv::Mat outline;
    // Where a part meets the border of the view, it has no outline to judge.
    cv::dilate(part, outline, ellipse(3));
    outline &= ~part & seen;
    const int length = cv::countNonZero(outline);
    if (length > 0 && cv::countNonZero(outline & near_edges) >= kOutlineShare * length)
      bare |= part;
  });
  return bare;
}

// Direction of the pixels: clearly below the horizon, clearly above, or at the horizon, which is as
// still on a level road as the vehicle.
struct Directions {
  cv::Mat down;
  cv::Mat up;
};

Directions directions_of(const MountedCamera& mounted) {
  const cv::Size size(mounted.camera.width, mounted.camera.height);
  Directions directions{cv::Mat::zeros(size, CV_8U), cv::Mat::zeros(size, CV_8U)};
  for (int v = 0; v < size.height; ++v)
    for (int u = 0; u < size.width; ++u) {
      const auto ray = mounted.camera.bearing({u, v});
      const double rise = ray ? (mounted.T_vehicle_camera.linear() * *ray).z() : 0.0;
      if (rise < -kHorizon) directions.down.at<std::uint8_t>(v, u) = 255;
      if (rise > kHorizon) directions.up.at<std::uint8_t>(v, u) = 255;
    }
  return directions;
}

// Parts that reach the border of the view: below the horizon, or above it with edges that no cloud
// has (a mirror, the frame of the windscreen).
cv::Mat parts_at_border(const cv::Mat& parts,
                        const cv::Mat& seen,
                        const Directions& look,
                        const Statistics& s) {
  cv::Mat inner;
  cv::erode(seen, inner, ellipse(3), {-1, -1}, 1, cv::BORDER_CONSTANT, 0);
  const cv::Mat border = seen & ~inner;
  const cv::Mat edges = (s.coherence > kCoherent) & (s.gradient > kGradient);
  cv::Mat kept = cv::Mat::zeros(parts.size(), CV_8U);
  for_each_part(parts, [&](const cv::Mat& part) {
    const bool low = cv::countNonZero(part & border & look.down) > 0;
    const bool high = cv::countNonZero(part & border & look.up) > 0 &&
                      cv::countNonZero(part & ~look.up) == 0 &&
                      cv::mean(s.gradient, part & edges)[0] > kGradientAtSky;
    if (low || high) kept |= part;
  });
  return kept;
}

}  // namespace

std::vector<cv::Mat> spread_images(std::size_t count,
                                   const std::function<cv::Mat(std::size_t)>& read) {
  std::vector<cv::Mat> images;
  for_samples(count, kSamples, read, [&](const cv::Mat& image) { images.push_back(image); });
  if (count <= kSamples || images_in_motion(images).size() >= kFewestMovingImages) return images;
  std::vector<cv::Mat> moving;
  for_samples(count, kDenseSamples, read,
              [&](const cv::Mat& image) { add_if_moved(image, moving); });
  if (moving.size() <= kSamples) return moving;
  images.clear();
  for_samples(
      moving.size(), kSamples, [&](std::size_t i) { return moving[i]; },
      [&](const cv::Mat& image) { images.push_back(image); });
  return images;
}

cv::Mat find_still_parts(const std::vector<cv::Mat>& images, const MountedCamera& mounted) {
  const std::vector<cv::Mat> moving = images_in_motion(images);
  if (moving.size() < kFewestMovingImages) return {};
  const Statistics s = statistics_of(moving);
  const cv::Mat seen = seen_by(mounted.camera);
  const cv::Mat textured = (s.gradient > kGradient) & seen;
  cv::Mat edges = textured & (s.coherence > kCoherent);
  if (cv::countNonZero(edges) > kMostCoherent * cv::countNonZero(textured)) return {};
  const double still = std::min(kStillLevels, kStillShare * median_of(s.change, seen));
  cv::morphologyEx(edges, edges, cv::MORPH_CLOSE, ellipse(kWindow));
  edges &= seen;
  // Above the horizon nothing without texture is taken: it would be the sky.
  const Directions look = directions_of(mounted);
  const cv::Mat bare = bare_parts(s.change < still, edges, seen & look.down);
  cv::Mat car = parts_at_border(edges | bare, seen, look, s);
  if (cv::countNonZero(car) == 0) return {};
  // The averaging already reaches over the outline; it leaves out the edge of the view.
  cv::Mat wide;
  cv::dilate(car, wide, ellipse(2 * kWindow + 1));
  cv::dilate(car, car, ellipse(5));
  car |= wide & ~seen;
  return car;
}

}  // namespace roadbook
