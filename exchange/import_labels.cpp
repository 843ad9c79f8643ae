#include "exchange/import_labels.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "base/wall_clock.hpp"
#include "exchange/label_readers.hpp"
#include "exchange/picture_edge.hpp"
#include "mapping/map_file.hpp"
#include "semantics/label_check.hpp"
#include "semantics/label_classes.hpp"
#include "semantics/label_layers.hpp"
#include "semantics/label_store.hpp"

namespace roadbook {
namespace {

constexpr double kSameM = 1e-3;
constexpr double kRectangleM = 0.02;

// Whether the second side, not the first, is the one along the heading.
bool is_across(const Eigen::Vector2d& along, const Eigen::Vector2d& across, double heading_rad) {
  const Eigen::Vector2d ahead(std::cos(heading_rad), std::sin(heading_rad));
  return std::abs(ahead.dot(across.normalized())) > std::abs(ahead.dot(along.normalized()));
}

// `heading_rad`: where it is known, roughly. Else of corners from ahead on the right; of somebody
// else's, along the longer side, and either way round: what is clockwise begins one corner later.
OrientedBox box_of(const std::vector<Eigen::Vector2d>& c,
                   const std::optional<double>& heading_rad) {
  OrientedBox box;
  box.centre = 0.25 * (c[0] + c[1] + c[2] + c[3]);
  Eigen::Vector2d along = 0.5 * (c[0] + c[1]) - box.centre;
  Eigen::Vector2d across = 0.5 * (c[1] + c[2]) - box.centre;
  if (heading_rad ? is_across(along, across, *heading_rad)
                  : across.norm() > along.norm() * (1.0 + 1e-9))
    std::swap(along, across);
  if (heading_rad && along.dot(Eigen::Vector2d(std::cos(*heading_rad), std::sin(*heading_rad))) < 0)
    along = -along;
  box.heading = std::atan2(along.y(), along.x());
  box.length_m = 2.0 * along.norm();
  box.width_m = 2.0 * across.norm();
  return box;
}

std::vector<Eigen::Vector2d> outline_in_map(const Map& map, const Label& label) {
  std::vector<Eigen::Vector2d> corners;
  for (const Eigen::Vector3d& corner : corners_in_map(map, label))
    corners.emplace_back(corner.head<2>());
  return corners;
}

// A file has the box as it looks from above; on a slope its sides are longer than that.
Label label_of_seen_box(const Map& map, const LabelAnchor& anchor, const OrientedBox& seen) {
  Label label = label_of_box(map, anchor, seen);
  const OrientedBox from_above = box_of(outline_in_map(map, label), seen.heading);
  if (from_above.length_m <= 0.0 || from_above.width_m <= 0.0) return label;  // refused later
  label.length_m *= seen.length_m / from_above.length_m;
  label.width_m *= seen.width_m / from_above.width_m;
  return label;
}

bool is_same(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b) {
  if (a.size() != b.size()) return false;
  return std::all_of(a.begin(), a.end(), [&](const Eigen::Vector2d& p) {
    return std::any_of(b.begin(), b.end(),
                       [&](const Eigen::Vector2d& q) { return (p - q).norm() < kSameM; });
  });
}

// What is there already goes, also what stands twice in the file; how many went. `cut_at`: what an
// export has cut at the edge of this picture is there too.
std::size_t take_out_known(const Map& map,
                           const std::vector<Label>& labels,
                           const std::optional<PicturePlace>& cut_at,
                           std::vector<LabelOutline>& outlines) {
  struct Known {
    std::string kind;
    std::vector<Eigen::Vector2d> corners;
  };
  std::vector<Known> known;
  for (const Label& label : labels) {
    known.push_back({label.kind, outline_in_map(map, label)});
    if (!cut_at || known.back().corners.empty()) continue;
    for (auto& part : parts_in_picture(*cut_at, known.back().corners))
      known.push_back({label.kind, std::move(part)});
  }
  return std::erase_if(outlines, [&](const LabelOutline& outline) {
    const bool is_known = std::any_of(known.begin(), known.end(), [&](const Known& one) {
      return one.kind == outline.kind && is_same(one.corners, outline.corners);
    });
    if (!is_known) known.push_back({outline.kind, outline.corners});
    return is_known;
  });
}

// The drawing's part of what a file says of a place: the pose's is added where the label is.
double drawing_sigma(const Map& map, Label label, const std::optional<double>& of_place) {
  constexpr double kFinestM = 0.01;
  if (!of_place) return kFoundSigma_m;  // nobody says whose hand it was: a search's, then
  label.sigma_m = 0.0;
  const double of_pose = sigma_in_map(map, label).value_or(0.0);
  return std::sqrt(std::max(*of_place * *of_place - of_pose * of_pose, kFinestM * kFinestM));
}

bool becomes_box(const LabelOutline& outline, const std::vector<LabelClass>& classes) {
  if (!is_rectangle(outline.corners, kRectangleM)) return false;
  if (outline.shape) return outline.shape == LabelShape::kBox;
  return std::none_of(classes.begin(), classes.end(),
                      [&](const LabelClass& c) { return c.kind == outline.kind && !c.box; });
}

std::vector<Label> labels_of(const Map& map,
                             const std::vector<LabelOutline>& outlines,
                             const std::vector<LabelClass>& classes,
                             const std::string& file) {
  std::vector<Label> labels;
  std::vector<Problem> problems;
  for (const LabelOutline& outline : outlines) {
    const auto anchor = anchor_for(map, outline.corners);
    if (!anchor) {
      problems.push_back({Severity::kError, file, outline.line, outline.where,
                          "ground that no image of the map shows whole", "some that one does"});
      continue;
    }
    Label label =
        becomes_box(outline, classes)
            ? label_of_seen_box(map, *anchor, box_of(outline.corners, outline.heading_rad))
            : label_of_polygon(map, *anchor, outline.corners);
    label.kind = outline.kind;
    label.score = outline.score;
    label.source = LabelSource::kDrawn;
    label.sigma_m = drawing_sigma(map, label, outline.sigma_m);
    label.note = outline.note;
    try {
      check_new_label(label, file);
    } catch (const BadInput& bad) {
      const Problem& wrong = bad.problems().front();
      problems.push_back({Severity::kError, file, outline.line, outline.where,
                          wrong.field + " " + wrong.got, wrong.want});
    }
    labels.push_back(std::move(label));
  }
  if (!problems.empty()) throw BadInput(problems);
  return labels;
}

}  // namespace

nlohmann::json read_json_file(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw BadInput({Severity::kError, file.string(), 0, "", "no such file", "labels"});
  std::ostringstream text;
  text << in.rdbuf();
  const std::string bytes = text.str();
  try {
    return nlohmann::json::parse(bytes);
  } catch (const nlohmann::json::parse_error& fault) {
    const auto end =
        bytes.begin() + static_cast<std::ptrdiff_t>(std::min(fault.byte, bytes.size()));
    throw BadInput({Severity::kError, file.string(), 1 + std::count(bytes.begin(), end, '\n'),
                    "text", "no JSON", "JSON"});
  } catch (const nlohmann::json::out_of_range&) {
    throw BadInput({Severity::kError, file.string(), 0, "text", "a number that is too large",
                    "numbers up to 1.8e308"});
  }
}

void require_size(const std::string& file, const PicturePlace& map, int width, int height) {
  if (map.width == width && map.height == height) return;
  throw BadInput({Severity::kError, file, 0, "image",
                  std::to_string(width) + " x " + std::to_string(height) + " pixels",
                  std::to_string(map.width) + " x " + std::to_string(map.height) +
                      ", as the map's overhead image has"});
}

const std::vector<std::string>& label_import_formats() {
  static const std::vector<std::string> formats{"coco", "yolo", "geojson"};
  return formats;
}

std::vector<LabelOutline> read_label_outlines(const std::filesystem::path& map,
                                              const std::string& format,
                                              const std::filesystem::path& source,
                                              const std::optional<GeoOrigin>& origin) {
  const MapLayers layers(map);
  Outlines outlines;
  if (format == "geojson") {
    ExportOptions options;
    options.origin = origin;
    outlines = read_geojson(source, require_origin(map, options, "GeoJSON is in degrees"));
  } else {
    outlines = format == "yolo" ? read_yolo(source, layers) : read_coco(source, layers);
  }
  std::erase_if(outlines, [](const LabelOutline& o) { return is_rejected_kind(o.kind); });
  if (outlines.empty())
    throw BadInput({Severity::kError, source.string(), 0, "labels", "none", "some"});
  return outlines;
}

LabelImport import_labels(const std::filesystem::path& map,
                          const std::string& format,
                          const std::filesystem::path& source,
                          const std::string& who,
                          const std::optional<GeoOrigin>& origin) {
  auto outlines = read_label_outlines(map, format, source, origin);
  const MapLayers layers(map);
  const auto classes = read_label_classes(layers);
  std::optional<PicturePlace> cut_at;
  if (format == "yolo") cut_at = yolo_picture_place(source, layers);
  LabelImport result;
  {
    LabelStore store(map);
    result.already = take_out_known(store.map(), store.labels(), cut_at, outlines);
    const auto labels = labels_of(store.map(), outlines, classes, source.string());
    const std::string request = kImportRequest + std::to_string(wall_clock_ns());
    result.stored = store.create_all(labels, who, request).size();
  }
  renew_label_layers(map);
  return result;
}

}  // namespace roadbook
