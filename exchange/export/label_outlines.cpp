#include "exchange/export/label_outlines.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "base/files/disk_space.hpp"
#include "base/text.hpp"
#include "base/text_file.hpp"
#include "base/whole_file.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/labels/label_check.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_store.hpp"

namespace roadbook {

std::vector<LabelOutline> outlines_of_labels(const MapLayers& layers) {
  const Map map = load_map(layers.file());
  std::vector<LabelOutline> outlines;
  for (const Label& label : read_labels(layers.file())) {
    if (is_rejected_kind(label.kind) || !vehicle_of(map, label.anchor)) continue;
    LabelOutline outline;
    outline.kind = label.kind;
    outline.shape = label.shape;
    outline.score = label.score;
    outline.sigma_m = sigma_in_map(map, label);
    if (const auto box = box_in_map(map, label)) outline.heading_rad = box->heading;
    outline.note = label.note;
    outline.identity = {label.id, label.version, utc_text(label.t_ns)};
    outline.where = "label " + std::to_string(label.id);
    for (const Eigen::Vector3d& corner : corners_in_map(map, label))
      outline.corners.emplace_back(corner.head<2>());
    outlines.push_back(std::move(outline));
  }
  if (outlines.empty())
    throw BadInput({Severity::kError, layers.file().string(), 0, "labels", "none",
                    "some (roadbook label -m MAP)"});
  return outlines;
}

PicturePlace overhead_place(const MapLayers& layers) {
  if (!layers.has("overhead"))
    throw BadInput({Severity::kError, layers.file().string(), 0, "layer overhead", "none",
                    "an overhead image (roadbook overhead -m MAP makes it)"});
  const RasterInfo info = layers.raster_info("overhead");
  return {info.width, info.height, info.corner, info.resolution_m};
}

std::vector<std::filesystem::path> write_overhead_picture(const MapLayers& layers,
                                                          const std::filesystem::path& png) {
  const PicturePlace place = overhead_place(layers);
  cv::Mat grey;
  cv::extractChannel(layers.read_raster("overhead", {0, 0, place.width, place.height}), grey, 0);
  WholeFile picture(png);
  if (!cv::imwrite(picture.part().string(), grey))
    throw StorageError(
        to_line({Severity::kError, png.string(), 0, "output", write_fault(picture.part()),
                 "a writable place with room on its disk"}));
  picture.commit();
  // Pixel sizes and turns, then the middle of the first pixel.
  std::ostringstream text;
  text << std::setprecision(17) << place.resolution_m << "\n0\n0\n"
       << -place.resolution_m << "\n"
       << place.corner.x() + 0.5 * place.resolution_m << "\n"
       << place.corner.y() - 0.5 * place.resolution_m << "\n";
  const auto world = std::filesystem::path(png).replace_extension(".pgw");
  write_whole_file(world, text.str());
  return {png, world};
}

PicturePlace read_world_file(const std::filesystem::path& file, int width, int height) {
  std::istringstream in(read_regular_file(file, "a world file"));
  std::vector<double> values;
  std::string line;
  while (values.size() < 6 && std::getline(in, line)) {
    const auto value = parse_double(line);
    if (!value)
      throw BadInput({Severity::kError, file.string(), static_cast<std::int64_t>(values.size()) + 1,
                      "world file", "'" + line + "'", "a number"});
    values.push_back(*value);
  }
  if (values.size() < 6 || !(values[0] > 0.0) || values[1] != 0.0 || values[2] != 0.0 ||
      values[3] != -values[0])
    throw BadInput({Severity::kError, file.string(), 0, "world file", "another form",
                    "six numbers of a picture that is north up, its pixels square"});
  return {width, height, {values[4] - 0.5 * values[0], values[5] + 0.5 * values[0]}, values[0]};
}

bool is_rectangle(const std::vector<Eigen::Vector2d>& c, double tolerance_m) {
  if (c.size() != 4) return false;
  const Eigen::Vector2d middles = 0.5 * (c[0] + c[2]) - 0.5 * (c[1] + c[3]);
  const double diagonals = (c[0] - c[2]).norm() - (c[1] - c[3]).norm();
  return middles.norm() < tolerance_m && std::abs(diagonals) < tolerance_m;
}

std::vector<Problem> outline_problems(const std::string& file, const LabelOutline& outline) {
  const auto wrong = [&](const std::string& got, const std::string& want) {
    return std::vector<Problem>{{Severity::kError, file, outline.line, outline.where, got, want}};
  };
  if (outline.corners.size() < 3)
    return wrong(std::to_string(outline.corners.size()) + " corners", "3 or more");
  if (outline.sigma_m && !(*outline.sigma_m > 0.0 && *outline.sigma_m <= 10.0))
    return wrong("sigma_m " + std::to_string(*outline.sigma_m), "above 0, at most 10 m");
  Label label;
  label.kind = outline.kind.empty() ? "x" : outline.kind;
  label.shape = LabelShape::kPolygon;
  const Eigen::Vector2d first = outline.corners.front();
  for (const Eigen::Vector2d& corner : outline.corners)
    label.corners_vehicle.emplace_back(corner.x() - first.x(), corner.y() - first.y(), 0.0);
  try {
    check_new_label(label, file);
  } catch (const BadInput& bad) {
    return wrong(bad.problems().front().got, bad.problems().front().want);
  }
  return {};
}

}  // namespace roadbook
