#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "exchange/export_formats.hpp"
#include "exchange/label_outlines.hpp"
#include "exchange/output_file.hpp"
#include "semantics/label_classes.hpp"

namespace roadbook {
namespace {

// A quoted YAML string is a JSON string.
std::string quoted(const std::string& text) { return nlohmann::json(text).dump(); }

std::string row_of(const LabelOutline& outline, std::size_t number, const PicturePlace& place) {
  std::string row = std::to_string(number);
  for (const Eigen::Vector2d& corner : outline.corners) {
    const Eigen::Vector2d pixel = place.pixel_of(corner);
    char text[64];
    std::snprintf(text, sizeof text, " %.12f %.12f", pixel.x() / place.width,
                  pixel.y() / place.height);
    row += text;
  }
  return row + "\n";
}

}  // namespace

Paths export_yolo(const std::filesystem::path& map, const std::filesystem::path& out) {
  const MapLayers layers(map);
  const auto outlines = outlines_of_labels(layers);
  const PicturePlace place = overhead_place(layers);
  std::vector<std::string> kinds;
  for (const LabelOutline& outline : outlines) kinds.push_back(outline.kind);
  const auto classes = with_kinds(read_label_classes(layers), kinds);
  std::error_code error;
  for (const char* folder : {"images", "labels"})
    std::filesystem::create_directories(out / folder, error);
  if (error)
    throw StorageError(
        to_line({Severity::kError, out.string(), 0, "output", error.message(), "a folder"}));
  std::string rows;
  for (const LabelOutline& outline : outlines) {
    const auto found = std::find_if(classes.begin(), classes.end(),
                                    [&](const LabelClass& c) { return c.kind == outline.kind; });
    rows += row_of(outline, static_cast<std::size_t>(found - classes.begin()), place);
  }
  std::string data = "path: .\ntrain: images\nval: images\nnames:\n";
  for (const LabelClass& c : classes) data += "  - " + quoted(c.kind) + "\n";
  write_text_file(out / "labels" / "overhead.txt", rows);
  write_text_file(out / "data.yaml", data);
  Paths files{out / "labels" / "overhead.txt", out / "data.yaml"};
  for (auto& file : write_overhead_picture(layers, out / "images" / "overhead.png"))
    files.push_back(std::move(file));
  return files;
}

}  // namespace roadbook
