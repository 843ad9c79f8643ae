#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/error.hpp"
#include "mapping/layers/map_layers.hpp"
#include "mapping/map.hpp"
#include "semantics/labels/labels.hpp"

namespace roadbook {

// Labels in the form of other programs' files: classes and outlines, without vehicle poses.

/// The label, and its map, that an outline was written from.
struct LabelIdentity {
  std::int64_t id = 0;
  std::optional<std::int64_t> version{};
  std::string edited_utc;  ///< when that version was made; empty where the file does not say
};

struct LabelOutline {
  std::string kind;
  /// Empty if a file does not state it; an outline in the form of a box may then be a box.
  std::optional<LabelShape> shape{};
  /// Map frame [m]. Those of a box start at the front right corner and go counter-clockwise.
  std::vector<Eigen::Vector2d> corners;
  double score = 1.0;
  /// Standard deviation of the middle in its least certain direction [m]; empty if not stated.
  std::optional<double> sigma_m;
  /// Heading of a box, map frame [rad]; empty if a file does not give it. Corners are more exact;
  /// the heading selects the side that is ahead.
  std::optional<double> heading_rad{};
  std::string note;
  std::optional<LabelIdentity> identity{};
  /// Distance between neighbouring coordinates that the file can hold [m]; 0: any.
  double step_m = 0.0;
  std::string where;      ///< in its file, for messages: "annotations[3]"
  std::int64_t line = 0;  ///< in its file, where lines count
};

/// Size and place of a map's overhead image, as other programs see the image.
struct PicturePlace {
  int width = 0;
  int height = 0;
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();  ///< north-west, outer edge of the first pixel
  double resolution_m = 0.0;

  /// Pixels from the outer edge of the first one, as COCO and YOLO count, and back.
  [[nodiscard]] Eigen::Vector2d pixel_of(const Eigen::Vector2d& p) const {
    return {(p.x() - corner.x()) / resolution_m, (corner.y() - p.y()) / resolution_m};
  }
  [[nodiscard]] Eigen::Vector2d place_of(const Eigen::Vector2d& pixel) const {
    return {corner.x() + pixel.x() * resolution_m, corner.y() - pixel.y() * resolution_m};
  }
};

/// Active labels of a map file at their current places; rejections (`not_X`) are left out. Throws
/// BadInput where the map has no such labels.
[[nodiscard]] std::vector<LabelOutline> outlines_of_labels(const MapLayers& layers);

/// Throws BadInput where the map has no overhead image.
[[nodiscard]] PicturePlace overhead_place(const MapLayers& layers);
/// Writes the overhead image as PNG, and a world file (.pgw) with the image's place.
std::vector<std::filesystem::path> write_overhead_picture(const MapLayers& layers,
                                                          const std::filesystem::path& png);
/// Reads the place of a picture of that size from a world file. Throws BadInput.
[[nodiscard]] PicturePlace read_world_file(const std::filesystem::path& file,
                                           int width,
                                           int height);

/// Four corners within `tolerance_m` of a rectangle.
[[nodiscard]] bool is_rectangle(const std::vector<Eigen::Vector2d>& corners, double tolerance_m);

/// The faults of an outline: too few corners, sides that cross, a value that is no number. Empty
/// for a valid outline.
[[nodiscard]] std::vector<Problem> outline_problems(const std::string& file,
                                                    const LabelOutline& outline);

}  // namespace roadbook
