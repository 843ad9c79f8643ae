#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "base/whole_file.hpp"
#include "drive/output_file.hpp"
#include "exchange/export/export_formats.hpp"
#include "exchange/export/label_outlines.hpp"
#include "exchange/export/picture_edge.hpp"
#include "semantics/labels/label_classes.hpp"

namespace roadbook {
namespace {

// A quoted YAML string is a JSON string.
std::string quoted(const std::string& text) { return nlohmann::json(text).dump(); }

std::string row_of(const std::vector<Eigen::Vector2d>& corners,
                   std::size_t number,
                   const PicturePlace& place) {
  std::string row = std::to_string(number);
  for (const Eigen::Vector2d& corner : corners) {
    // Trainers refuse pictures with shares out of 0 to 1, were it by rounding.
    const Eigen::Vector2d share =
        place.pixel_of(corner).cwiseQuotient(Eigen::Vector2d(place.width, place.height));
    char text[64];
    std::snprintf(text, sizeof text, " %.12f %.12f", std::clamp(share.x(), 0.0, 1.0),
                  std::clamp(share.y(), 0.0, 1.0));
    row += text;
  }
  return row + "\n";
}

}  // namespace

Paths export_yolo(const std::filesystem::path& map, const std::filesystem::path& out) {
  const MapLayers layers(map);
  const PicturePlace place = overhead_place(layers);
  const auto outlines = outlines_in_picture(layers, place);
  std::vector<std::string> kinds;
  for (const LabelOutline& outline : outlines) kinds.push_back(outline.kind);
  const auto classes = with_kinds(read_label_classes(layers), kinds);
  for (const char* folder : {"images", "labels"}) make_folder(out / folder);
  std::string rows;
  for (const LabelOutline& outline : outlines) {
    const auto found = std::find_if(classes.begin(), classes.end(),
                                    [&](const LabelClass& c) { return c.kind == outline.kind; });
    for (const auto& part : parts_in_picture(place, outline.corners))
      rows += row_of(part, static_cast<std::size_t>(found - classes.begin()), place);
  }
  std::string data = "path: .\ntrain: images\nval: images\nnames:\n";
  for (const LabelClass& c : classes) data += "  - " + quoted(c.kind) + "\n";
  write_whole_file(out / "labels" / "overhead.txt", rows);
  write_whole_file(out / "data.yaml", data);
  Paths files{out / "labels" / "overhead.txt", out / "data.yaml"};
  for (auto& file : write_overhead_picture(layers, out / "images" / "overhead.png"))
    files.push_back(std::move(file));
  return files;
}

}  // namespace roadbook
