#include <nlohmann/json.hpp>
#include <set>

#include "base/whole_file.hpp"
#include "exchange/export/export_formats.hpp"
#include "exchange/export/label_outlines.hpp"
#include "exchange/export/picture_edge.hpp"
#include "semantics/labels/label_classes.hpp"

namespace roadbook {
namespace {

using nlohmann::ordered_json;

double area_of(const std::vector<Eigen::Vector2d>& c) {
  double twice = 0.0;
  for (std::size_t i = 0; i < c.size(); ++i) {
    const Eigen::Vector2d& next = c[(i + 1) % c.size()];
    twice += c[i].x() * next.y() - next.x() * c[i].y();
  }
  return 0.5 * std::abs(twice);
}

ordered_json annotation_json(const LabelOutline& outline, const PicturePlace& place) {
  ordered_json ring = ordered_json::array();
  std::vector<Eigen::Vector2d> pixels;
  Eigen::AlignedBox2d around;
  for (const Eigen::Vector2d& corner : outline.corners) {
    pixels.push_back(place.pixel_of(corner));
    around.extend(pixels.back());
    ring.push_back(pixels.back().x());
    ring.push_back(pixels.back().y());
  }
  const Eigen::Vector2d size = around.sizes();
  ordered_json attributes = {{"shape", outline.shape == LabelShape::kBox ? "box" : "polygon"},
                             {"note", outline.note}};
  if (outline.heading_rad) attributes["heading_rad"] = *outline.heading_rad;
  if (outline.sigma_m) attributes["sigma_m"] = *outline.sigma_m;
  if (outline.identity) {
    attributes["space"] = outline.identity->id;
    attributes["version"] = outline.identity->version.value_or(1);
    attributes["edited_utc"] = outline.identity->edited_utc;
  }
  return {{"segmentation", ordered_json::array({ring})},
          {"bbox", {around.min().x(), around.min().y(), size.x(), size.y()}},
          {"area", area_of(pixels)},
          {"iscrowd", 0},
          {"score", outline.score},
          {"attributes", attributes}};
}

}  // namespace

Paths export_coco(const std::filesystem::path& map, const std::filesystem::path& out) {
  const MapLayers layers(map);
  const PicturePlace place = overhead_place(layers);
  const auto outlines = outlines_in_picture(layers, place);
  const auto png = std::filesystem::path(out).replace_extension(".png");
  if (png == out) throw InvalidOption("--output", out.string(), "a name that ends in .json");
  std::vector<std::string> kinds;
  for (const LabelOutline& outline : outlines) kinds.push_back(outline.kind);
  ordered_json json = {
      {"info", {{"description", "labels of " + map.stem().string()}, {"version", "1"}}},
      {"licenses", ordered_json::array()},
      {"images",
       {{{"id", 1},
         {"file_name", png.filename().string()},
         {"width", place.width},
         {"height", place.height},
         {"world",
          {{"corner_m", {place.corner.x(), place.corner.y()}},
           {"resolution_m", place.resolution_m}}}}}},
      {"categories", ordered_json::array()},
      {"annotations", ordered_json::array()}};
  const auto classes = with_kinds(read_label_classes(layers), kinds);
  for (std::size_t i = 0; i < classes.size(); ++i)
    json["categories"].push_back(
        {{"id", i + 1}, {"name", classes[i].kind}, {"supercategory", "ground"}});
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    ordered_json annotation = {{"id", i + 1}, {"image_id", 1}};
    for (std::size_t c = 0; c < classes.size(); ++c)
      if (classes[c].kind == outlines[i].kind) annotation["category_id"] = c + 1;
    annotation.update(annotation_json(outlines[i], place));
    json["annotations"].push_back(std::move(annotation));
  }
  write_whole_file(out, json.dump(1, ' ', false, ordered_json::error_handler_t::replace) + "\n");
  Paths files{out};
  for (auto& file : write_overhead_picture(layers, png)) files.push_back(std::move(file));
  return files;
}

}  // namespace roadbook
