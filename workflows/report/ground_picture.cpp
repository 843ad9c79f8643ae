#include "workflows/report/ground_picture.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace roadbook {
namespace {

std::vector<unsigned char> png_of(const cv::Mat& picture) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", picture, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9});
  return bytes;
}

// Encodes grey with transparent unseen pixels.
std::vector<unsigned char> png_of(const cv::Mat& grey, const cv::Mat& alpha) {
  cv::Mat picture;
  cv::merge(std::vector<cv::Mat>{grey, grey, grey, alpha}, picture);
  return png_of(picture);
}

}  // namespace

std::optional<GroundPicture> overhead_picture(const MapLayers& layers, int max_px) {
  if (!layers.has("overhead")) return std::nullopt;
  const RasterInfo info = layers.raster_info("overhead");
  const int shrink = std::max(1, static_cast<int>(std::ceil(std::max(info.width, info.height) /
                                                            static_cast<double>(max_px))));
  const int width = (info.width + shrink - 1) / shrink;
  const int height = (info.height + shrink - 1) / shrink;
  cv::Mat grey(height, width, CV_8U, cv::Scalar(0));
  cv::Mat alpha(height, width, CV_8U, cv::Scalar(0));
  const int rows_at_once = std::max(1, 512 / shrink);
  for (int row = 0; row < height; row += rows_at_once) {
    const int rows = std::min(rows_at_once, height - row);
    cv::Mat part = layers.read_raster(
        "overhead",
        {0, row * shrink, info.width, std::min(rows * shrink, info.height - row * shrink)});
    cv::extractChannel(part, part, 0);
    // Average only the seen pixels, because 0 means "not seen".
    cv::Mat seen = part > 0;
    cv::Mat sum, count;
    const cv::Size padded(width * shrink, rows * shrink);
    cv::copyMakeBorder(part, part, 0, padded.height - part.rows, 0, padded.width - part.cols,
                       cv::BORDER_CONSTANT, cv::Scalar(0));
    cv::copyMakeBorder(seen, seen, 0, padded.height - seen.rows, 0, padded.width - seen.cols,
                       cv::BORDER_CONSTANT, cv::Scalar(0));
    part.convertTo(part, CV_32F);
    seen.convertTo(seen, CV_32F, 1.0 / 255.0);
    cv::resize(part, sum, {width, rows}, 0, 0, cv::INTER_AREA);
    cv::resize(seen, count, {width, rows}, 0, 0, cv::INTER_AREA);
    cv::Mat mean = sum / cv::max(count, 1e-3);
    mean.convertTo(grey.rowRange(row, row + rows), CV_8U);
    cv::Mat(count > 0.25).copyTo(alpha.rowRange(row, row + rows));
  }
  GroundPicture picture;
  picture.png = png_of(grey, alpha);
  picture.place.low = {info.corner.x(), info.corner.y() - info.resolution_m * height * shrink};
  picture.place.high = {info.corner.x() + info.resolution_m * width * shrink, info.corner.y()};
  return picture;
}

std::optional<GroundPicture> colour_picture(const MapLayers& layers, const std::string& name) {
  if (!layers.has(name)) return std::nullopt;
  const RasterInfo info = layers.raster_info(name);
  cv::Mat pixels = layers.read_raster(name, {0, 0, info.width, info.height});
  std::vector<cv::Mat> bands;
  cv::split(pixels, bands);
  std::swap(bands[0], bands[2]);  // files store red first, OpenCV blue
  cv::merge(bands, pixels);
  GroundPicture picture;
  picture.png = png_of(pixels);
  picture.place.low = {info.corner.x(), info.corner.y() - info.resolution_m * info.height};
  picture.place.high = {info.corner.x() + info.resolution_m * info.width, info.corner.y()};
  return picture;
}

GroundPicture landmark_picture(const Map& map, const PlanBounds& place) {
  constexpr int kWidth = 1200;
  const Eigen::Vector2d size = place.high - place.low;
  const double scale = kWidth / std::max(size.x(), 1e-6);
  const int height = std::clamp(static_cast<int>(std::ceil(size.y() * scale)), 1, 4 * kWidth);
  cv::Mat counts(height, kWidth, CV_32F, cv::Scalar(0));
  for (const Landmark& landmark : map.landmarks) {
    const Eigen::Vector3d p = map.p_map(landmark);
    const Eigen::Vector2d px{(p.x() - place.low.x()) * scale, (place.high.y() - p.y()) * scale};
    if (px.x() >= 0.0 && px.x() < kWidth && px.y() >= 0.0 && px.y() < height)
      counts.at<float>(static_cast<int>(px.y()), static_cast<int>(px.x())) += 1.0F;
  }
  // Single landmarks of a small map must be visible, and a million landmarks must not merge.
  if (map.landmarks.size() < 50'000)
    cv::dilate(counts, counts, cv::getStructuringElement(cv::MORPH_ELLIPSE, {5, 5}));
  // Middle grey is visible on a light and on a dark page. The opacity shows the density.
  cv::Mat alpha;
  counts.convertTo(alpha, CV_8U, 150.0);
  return {png_of(cv::Mat(height, kWidth, CV_8U, cv::Scalar(128)), alpha), place};
}

}  // namespace roadbook
