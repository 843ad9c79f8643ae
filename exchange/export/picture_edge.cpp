#include "exchange/export/picture_edge.hpp"

#include <ogr_geometry.h>

#include <algorithm>
#include <memory>

#include "mapping/layers/map_layers_gdal.hpp"

namespace roadbook {
namespace {

using Outline = std::vector<Eigen::Vector2d>;

OGRPolygon polygon_of(const Outline& corners) {
  OGRLinearRing ring;
  for (const Eigen::Vector2d& p : corners) ring.addPoint(p.x(), p.y());
  ring.closeRings();
  OGRPolygon polygon;
  polygon.addRing(&ring);
  return polygon;
}

bool is_inside(const PicturePlace& place, const Outline& pixels) {
  constexpr double kRoundingPx = 1e-6;
  return std::all_of(pixels.begin(), pixels.end(), [&](const Eigen::Vector2d& p) {
    return p.minCoeff() >= -kRoundingPx && p.x() <= place.width + kRoundingPx &&
           p.y() <= place.height + kRoundingPx;
  });
}

// A strip of length l and width w has area l w and circumference 2 (l + w).
bool is_a_pixel_wide(const OGRPolygon& part) {
  return part.get_Area() >= 1.0 &&
         2.0 * part.get_Area() >= part.getExteriorRing()->get_Length() - 2.0;
}

void add_part(const PicturePlace& place, const OGRPolygon& part, std::vector<Outline>& parts) {
  if (part.IsEmpty() || !is_a_pixel_wide(part)) return;
  const OGRLinearRing& ring = *part.getExteriorRing();
  parts.emplace_back();
  for (int i = 0; i + 1 < ring.getNumPoints(); ++i)  // the last point is the first again
    parts.back().push_back(place.place_of({ring.getX(i), ring.getY(i)}));
}

}  // namespace

std::vector<Outline> parts_in_picture(const PicturePlace& place, const Outline& outline) {
  Outline pixels;
  for (const Eigen::Vector2d& corner : outline) pixels.push_back(place.pixel_of(corner));
  if (is_inside(place, pixels)) return {outline};
  const double width = place.width;
  const double height = place.height;
  const OGRPolygon picture = polygon_of({{0, 0}, {width, 0}, {width, height}, {0, height}});
  const GdalScope scope;
  const std::unique_ptr<OGRGeometry> common(polygon_of(pixels).Intersection(&picture));
  std::vector<Outline> parts;
  if (!common) return parts;
  if (wkbFlatten(common->getGeometryType()) == wkbPolygon) {
    add_part(place, *common->toPolygon(), parts);
  } else if (OGR_GT_IsSubClassOf(common->getGeometryType(), wkbGeometryCollection)) {
    for (const OGRGeometry* part : *common->toGeometryCollection())
      if (wkbFlatten(part->getGeometryType()) == wkbPolygon)
        add_part(place, *part->toPolygon(), parts);
  }
  return parts;
}

std::vector<LabelOutline> outlines_in_picture(const MapLayers& layers, const PicturePlace& place) {
  auto outlines = outlines_of_labels(layers);
  std::erase_if(outlines,
                [&](const LabelOutline& o) { return parts_in_picture(place, o.corners).empty(); });
  if (outlines.empty())
    throw BadInput({Severity::kError, layers.file().string(), 0, "labels",
                    "none in the overhead image", "some"});
  return outlines;
}

std::vector<Problem> warnings_of_picture_edge(const std::filesystem::path& map,
                                              const std::string& format) {
  if (format != "coco" && format != "yolo") return {};
  const MapLayers layers(map);
  const PicturePlace place = overhead_place(layers);
  std::size_t outside = 0;
  std::size_t cut = 0;
  for (const LabelOutline& outline : outlines_of_labels(layers)) {
    const auto parts = parts_in_picture(place, outline.corners);
    outside += parts.empty() ? 1 : 0;
    cut += !parts.empty() && parts.front() != outline.corners ? 1 : 0;
  }
  std::vector<Problem> warnings;
  const auto warn = [&](const char* field, std::size_t count, const char* want) {
    if (count > 0)
      warnings.push_back({Severity::kWarning, map.string(), 0, field, std::to_string(count), want});
  };
  warn("labels outside the overhead image", outside, "none: they are left out");
  if (format == "yolo")
    warn("labels over the overhead image's edge", cut,
         "none: they are cut there, as trainers take shares of 0 to 1 alone; coco and geojson keep "
         "them whole");
  return warnings;
}

}  // namespace roadbook
