#include "exchange/import/coco_annotation.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "exchange/import/coco_fields.hpp"
#include "exchange/import/outline_shape.hpp"

namespace roadbook {
namespace {

using CocoJson = nlohmann::json;
using Pixels = std::vector<Eigen::Vector2d>;

constexpr std::string_view kTurnField = "attributes.rotation";
constexpr double kDegree = 3.14159265358979323846 / 180.0;

// One annotation, on its way to an outline.
class CocoAnnotation {
 public:
  CocoAnnotation(const CocoJson& json,
                 const std::string& where,
                 const PicturePlace& place,
                 JsonFields& fields,
                 LabelFile& file)
      : json_(json), where_(where), place_(place), fields_(fields), file_(file) {
    attributes_ = json.value("attributes", CocoJson());
    if (attributes_.is_null()) attributes_ = CocoJson::object();
  }

  std::optional<LabelOutline> read() {
    if (!attributes_.is_object()) {
      fields_.fault(where_ + ".attributes", shown(attributes_), "an object");
      return std::nullopt;
    }
    if (is_flagged(json_, "") || is_flagged(attributes_, "attributes.")) return std::nullopt;
    const std::size_t before = fields_.problems().size();
    LabelOutline outline;
    outline.where = where_ + ".segmentation";
    const Pixels pixels = read_pixels(outline);
    if (pixels.empty() || are_shares(pixels)) return std::nullopt;
    for (const Eigen::Vector2d& pixel : pixels) outline.corners.push_back(place_.place_of(pixel));
    read_fields(outline);
    if (fields_.problems().size() != before) return std::nullopt;
    if (!heading_fits(outline)) return std::nullopt;
    clean_corners(outline);
    return outline;
  }

 private:
  void leave_out(const std::string& field, const std::string& got, const std::string& want) {
    std::string what = got;
    if (json_.contains("id")) what += " (annotation id " + shown(json_["id"]) + ")";
    file_.left_out.push_back(left_out(fields_.file(), where_ + "." + field, what, want));
  }

  bool is_flagged(const CocoJson& object, const std::string& path) {
    for (const auto& [name, value] : object.items()) {
      const std::string_view meaning = meaning_of_coco_flag(name);
      if (meaning.empty() || !is_flag_set(value)) continue;
      leave_out(path + name, shown(value), std::string(meaning));
      return true;
    }
    return false;
  }

  // Shares of the picture in place of pixels would be a label of less than one pixel.
  bool are_shares(const Pixels& pixels) {
    const bool shares = std::all_of(pixels.begin(), pixels.end(), [](const Eigen::Vector2d& p) {
      return p.minCoeff() >= 0.0 && p.maxCoeff() <= 1.0;
    });
    if (shares)
      leave_out(is_bbox_ ? "bbox" : "segmentation", "numbers from 0 to 1", "pixels, no shares");
    return shares;
  }

  // Corners in pixels; none where the annotation is left out or wrong.
  Pixels read_pixels(LabelOutline& outline) {
    const CocoJson segmentation = json_.value("segmentation", CocoJson());
    const bool empty = segmentation.is_null() || segmentation == CocoJson::array() ||
                       segmentation == CocoJson::array({CocoJson::array()});
    if (empty) return pixels_of_bbox(outline);
    if (segmentation.is_object()) {
      leave_out("segmentation", "a run-length mask", "a polygon");
      return {};
    }
    if (segmentation.is_array() && segmentation.size() > 1 && is_numbers(segmentation[0])) {
      leave_out("segmentation", std::to_string(segmentation.size()) + " parts", "one polygon");
      return {};
    }
    return pixels_of_polygon(segmentation, outline);
  }

  Pixels pixels_of_polygon(const CocoJson& segmentation, LabelOutline& outline) {
    const std::string field = where_ + ".segmentation";
    if (!segmentation.is_array()) {
      fields_.fault(field, shown(segmentation), "a polygon");
      return {};
    }
    if (segmentation.size() != 1 || !is_numbers(segmentation[0])) {
      fields_.fault(
          field,
          segmentation.size() == 1 ? "no numbers" : std::to_string(segmentation.size()) + " parts",
          "one list of numbers");
      return {};
    }
    const auto values = segmentation[0].get<std::vector<double>>();
    if (values.size() % 2 != 0) {
      fields_.fault(field, std::to_string(values.size()) + " numbers", "pairs x, y");
      return {};
    }
    outline.step_m = rounding_step(values) * place_.resolution_m;
    Pixels pixels;
    for (std::size_t k = 0; k + 1 < values.size(); k += 2)
      pixels.emplace_back(values[k], values[k + 1]);
    turn_polygon(pixels, rounding_step(values), outline);
    return pixels;
  }

  static bool is_box(const CocoJson& value) {
    return is_numbers(value) && value.size() == 4 && value[2].get<double>() > 0.0 &&
           value[3].get<double>() > 0.0;
  }

  Pixels pixels_of_bbox(LabelOutline& outline) {
    if (says_key_points()) {
      leave_out("keypoints", "points and the box around them", "a polygon, or a box of the thing");
      return {};
    }
    if (is_turned_otherwise()) return {};
    const CocoJson box =
        fields_.required(json_, where_, "bbox", is_box, "x, y, width, height, or a segmentation");
    if (box.is_null()) return {};
    outline.step_m = rounding_step(box.get<std::vector<double>>()) * place_.resolution_m;
    Pixels pixels = corners_of_bbox(box);
    turn_box(pixels, pixels, turn_rad(), outline);
    is_bbox_ = true;
    return pixels;
  }
  static Pixels corners_of_bbox(const CocoJson& box) {
    const Eigen::Vector2d low(box[0].get<double>(), box[1].get<double>());
    const Eigen::Vector2d high = low + Eigen::Vector2d(box[2].get<double>(), box[3].get<double>());
    return {high, {high.x(), low.y()}, low, {low.x(), high.y()}};
  }

  // Zero, an empty list, text or a flag ("orientation": "parallel").
  static bool is_nothing(const CocoJson& value) {
    if (value.is_number()) return value.get<double>() == 0.0;
    return !value.is_array() || value.empty();
  }

  [[nodiscard]] bool says_key_points() const {
    const CocoJson count = json_.value("num_keypoints", CocoJson());
    const CocoJson points = json_.value("keypoints", CocoJson());
    return (count.is_number() && count.get<double>() > 0.0) || !is_nothing(points);
  }

  // Whether a field turns the box in a way that no standard defines: then the box is left out.
  bool is_turned_otherwise() {
    const CocoJson box = json_.value("bbox", CocoJson());
    if (is_numbers(box) && box.size() == 5 && box[4].get<double>() != 0.0) {
      leave_out("bbox", "a fifth number, " + shown(box[4]) + ", that turns it",
                "x, y, width, height and " + std::string(kTurnField));
      return true;
    }
    const auto turns = [&](const CocoJson& object, const std::string& path) {
      for (const auto& [name, value] : object.items()) {
        if (path + name == kTurnField || !may_turn_coco_box(name) || is_nothing(value)) continue;
        leave_out(path + name, shown(value),
                  "0, a segmentation, or " + std::string(kTurnField) + " (degrees clockwise)");
        return true;
      }
      return false;
    };
    return turns(json_, "") || turns(attributes_, "attributes.");
  }

  double turn_rad() {
    const CocoJson turned = fields_.optional(attributes_, where_ + ".attributes", "rotation",
                                             is_number, "a number of degrees");
    return turned.is_null() ? 0.0 : std::remainder(turned.get<double>(), 360.0) * kDegree;
  }
  // Clockwise as the picture is seen: its y axis points down. A turn is rounded as well, which
  // moves the corners.
  void turn_box(Pixels& pixels, const Pixels& box, double angle_rad, LabelOutline& outline) const {
    if (angle_rad == 0.0) return;
    const Eigen::Vector2d middle = 0.5 * (box[0] + box[2]);
    const Eigen::Rotation2Dd rotation(angle_rad);
    for (Eigen::Vector2d& p : pixels) p = middle + rotation * (p - middle);
    const double step_rad = rounding_step({attributes_["rotation"].get<double>()}) * kDegree;
    const double step_px = step_rad * (box[0] - middle).norm();
    outline.step_m = std::max(outline.step_m, step_px * place_.resolution_m);
  }

  // A polygon in an annotation with a turn: either the box before its turn, or the final outline.
  void turn_polygon(Pixels& pixels, double step, LabelOutline& outline) {
    const double angle_rad = turn_rad();
    if (angle_rad == 0.0 || pixels.size() < 3) return;
    const CocoJson box = json_.value("bbox", CocoJson());
    if (is_box(box) && repeats(pixels, corners_of_bbox(box), std::max(0.01, step)))
      return turn_box(pixels, corners_of_bbox(box), angle_rad, outline);
    constexpr double kRight = 1.57079632679489662;
    constexpr double kSameTurn = 0.02;
    const Eigen::Vector2d side = pixels[1] - pixels[0];
    const double off = std::remainder(std::atan2(side.y(), side.x()) - angle_rad, kRight);
    if (pixels.size() < 6 && std::abs(off) < kSameTurn) return;
    file_.notes.push_back({Severity::kWarning, fields_.file(), 0,
                           where_ + "." + std::string(kTurnField),
                           shown(attributes_["rotation"]) + " beside a polygon",
                           "0: the polygon is taken as it is drawn"});
  }
  // Whether a polygon has the corners of a box, and all its other points lie on the box's sides.
  static bool repeats(const Pixels& polygon, const Pixels& box, double tolerance_px) {
    return outline_distance(box, polygon) < tolerance_px &&
           std::all_of(box.begin(), box.end(), [&](const Eigen::Vector2d& corner) {
             return std::any_of(polygon.begin(), polygon.end(), [&](const Eigen::Vector2d& p) {
               return (p - corner).norm() < 2.0 * tolerance_px;
             });
           });
  }

  // Fields that other programs leave out or empty.
  void read_fields(LabelOutline& outline) {
    const std::string where = where_ + ".attributes";
    const auto is_shape = [](const CocoJson& v) { return v == "box" || v == "polygon"; };
    const CocoJson score = fields_.optional(json_, where_, "score", is_share, "0 to 1");
    const CocoJson shape =
        fields_.optional(attributes_, where, "shape", is_shape, "box or polygon");
    const CocoJson heading =
        fields_.optional(attributes_, where, "heading_rad", is_number, "a number of radians");
    const CocoJson sigma_m =
        fields_.optional(attributes_, where, "sigma_m", is_number, "a number of metres");
    const CocoJson note = fields_.optional(attributes_, where, "note", is_text, "text");
    if (!score.is_null()) outline.score = score;
    if (!shape.is_null()) outline.shape = shape == "box" ? LabelShape::kBox : LabelShape::kPolygon;
    if (!heading.is_null()) outline.heading_rad = heading.get<double>();
    if (!sigma_m.is_null()) outline.sigma_m = sigma_m.get<double>();
    if (!note.is_null()) outline.note = note;
    outline.identity = identity_of(attributes_);
  }

  // A bbox without its polygon is an upright box around a thing that may be turned.
  bool heading_fits(const LabelOutline& outline) {
    constexpr double kRight = 1.57079632679489662;
    constexpr double kTolerance = 0.1;  // rad
    if (!is_bbox_ || !outline.heading_rad) return true;
    const double off = std::remainder(*outline.heading_rad - upright_rad(), kRight);
    if (std::abs(off) < kTolerance) return true;
    leave_out("attributes.heading_rad", shown(attributes_["heading_rad"]) + " of an upright bbox",
              "the segmentation too");
    return false;
  }
  [[nodiscard]] double upright_rad() { return -turn_rad(); }  // of the map: counter-clockwise

  const CocoJson& json_;
  const std::string& where_;
  const PicturePlace& place_;
  JsonFields& fields_;
  LabelFile& file_;
  CocoJson attributes_;
  bool is_bbox_ = false;
};

}  // namespace

std::optional<LabelOutline> read_coco_annotation(const nlohmann::json& annotation,
                                                 const std::string& where,
                                                 const PicturePlace& place,
                                                 JsonFields& fields,
                                                 LabelFile& file) {
  return CocoAnnotation(annotation, where, place, fields, file).read();
}

}  // namespace roadbook
