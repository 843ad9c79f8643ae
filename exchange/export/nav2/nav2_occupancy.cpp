#include "exchange/export/nav2/nav2_occupancy.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "base/error.hpp"
#include "base/whole_file.hpp"
#include "exchange/layers/value_raster.hpp"
#include "mapping/occupancy/place_patches.hpp"

namespace roadbook {
namespace {

constexpr std::uint8_t kUnknownGrey = 205;
constexpr std::uint8_t kFreeGrey = 254;

cv::Mat values_of(const MapLayers& layers, const char* layer) {
  if (!layers.has(layer))
    throw BadInput({Severity::kError, layers.file().string(), 0, layer, "no such layer",
                    "an occupancy grid (roadbook occupancy DRIVE -m MAP)"});
  const RasterInfo info = layers.raster_info(layer);
  cv::Mat values = layers.read_raster(layer, {0, 0, info.width, info.height});
  values.setTo(NAN, values == static_cast<float>(kNoValue));
  return values;
}

std::string grid_yaml(const RasterInfo& info,
                      const std::string& image,
                      const std::string& mode,
                      const std::string& thresholds) {
  return "image: " + image + "\nmode: " + mode +
         "\nresolution: " + fixed_text(info.resolution_m, 6) + "\norigin: [" +
         fixed_text(info.corner.x(), 6) + ", " +
         fixed_text(info.corner.y() - info.height * info.resolution_m, 6) + ", 0.0]\nnegate: 0\n" +
         thresholds;
}

std::string trinary_image(const cv::Mat& values, const cv::Mat& sigma) {
  std::string text =
      "P5\n" + std::to_string(values.cols) + " " + std::to_string(values.rows) + "\n255\n";
  for (int row = 0; row < values.rows; ++row)
    for (int column = 0; column < values.cols; ++column)
      text += static_cast<char>(
          trinary_pixel(values.at<float>(row, column), sigma.at<float>(row, column)));
  return text;
}

std::string scale_image(const cv::Mat& values) {
  cv::Mat image(values.size(), CV_8UC4);
  for (int row = 0; row < values.rows; ++row)
    for (int column = 0; column < values.cols; ++column) {
      const float p = values.at<float>(row, column);
      const std::uint8_t grey = std::isnan(p) ? kUnknownGrey : scale_pixel(p);
      const std::uint8_t opacity = std::isnan(p) ? 0 : 255;
      image.at<cv::Vec4b>(row, column) = {grey, grey, grey, opacity};
    }
  std::vector<std::uint8_t> bytes;
  ROADBOOK_ASSERT(cv::imencode(".png", image, bytes));
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::uint8_t trinary_pixel(float probability, float sigma) {
  if (std::isnan(probability)) return kUnknownGrey;
  if (is_free(static_cast<double>(probability), static_cast<double>(sigma))) return kFreeGrey;
  return static_cast<double>(probability) >= kOccupiedProbability ? 0 : kUnknownGrey;
}

std::uint8_t scale_pixel(float probability) {
  return static_cast<std::uint8_t>(
      std::lround(255.0F * (1.0F - std::clamp(probability, 0.0F, 1.0F))));
}

Paths export_nav2_occupancy(const std::filesystem::path& map, const std::filesystem::path& out) {
  const MapLayers layers(map);
  const cv::Mat values = values_of(layers, "occupancy");
  const cv::Mat sigma = values_of(layers, "occupancy_sigma");
  const RasterInfo info = layers.raster_info("occupancy");
  if (sigma.size() != values.size())
    throw BadInput({Severity::kError, map.string(), 0, "occupancy_sigma", "another size",
                    "the size of occupancy (roadbook occupancy -m MAP)"});
  const std::string stem = out.stem().string();
  Paths files;
  const auto write = [&](const std::string& name, const std::string& text) {
    files.push_back(out.parent_path() / name);
    write_whole_file(files.back(), text);
  };
  write(stem + ".pgm", trinary_image(values, sigma));
  write(stem + ".yaml",
        grid_yaml(info, stem + ".pgm", "trinary", "occupied_thresh: 0.65\nfree_thresh: 0.196\n"));
  write(stem + "_scale.png", scale_image(values));
  write(stem + "_scale.yaml",
        grid_yaml(info, stem + "_scale.png", "scale", "occupied_thresh: 1.0\nfree_thresh: 0.0\n"));
  return files;
}

}  // namespace roadbook
