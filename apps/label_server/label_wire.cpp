#include "apps/label_server/label_wire.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "apps/label_server/moved_place.hpp"
#include "apps/label_server/people_wire.hpp"
#include "mapping/layers/map_layers.hpp"
#include "semantics/labels/label_check.hpp"
#include "semantics/labels/label_shift.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

constexpr double kSamePlaceM = 1.0;

Eigen::Vector2d middle_of(const std::vector<Eigen::Vector2d>& corners) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const auto& corner : corners) sum += corner;
  return sum / static_cast<double>(corners.size());
}

// Compares corner by corner, to a millimetre. A box that was turned or resized is another shape.
bool same_shape(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const auto& p, const auto& q) { return (p - q).norm() < 1e-3; });
}

std::vector<Eigen::Vector2d> flat_corners(const Map& map, const Label& label) {
  std::vector<Eigen::Vector2d> flat;
  for (const auto& corner : corners_in_map(map, label)) flat.push_back(corner.head<2>());
  return flat;
}

// A label of an older map may be anchored to an image that is no longer a keyframe. Perhaps no
// image of the current map shows the label completely. The user may correct such a label in its
// place.
bool stays_about(const Map& map,
                 const Label& previous,
                 const std::vector<Eigen::Vector2d>& corners) {
  const auto before = flat_corners(map, previous);
  return !before.empty() && (middle_of(before) - middle_of(corners)).norm() < kSamePlaceM;
}

// A label that marks no object needs no image that shows it well.
std::optional<LabelAnchor> nearest_keyframe(const Map& map, const Eigen::Vector2d& middle) {
  std::optional<LabelAnchor> best;
  double least = std::numeric_limits<double>::max();
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const Eigen::Vector3d p = map.T_map_vehicle(static_cast<int>(k)).translation();
    const double distance = (p.head<2>() - middle).norm();
    if (distance >= least) continue;
    least = distance;
    best = LabelAnchor{map.keyframes[k].session, map.keyframes[k].t_ns, 0};
  }
  return best;
}

LabelAnchor anchor_of(const Map& map,
                      const std::vector<Eigen::Vector2d>& corners,
                      const Label* previous,
                      bool rejected) {
  const auto now = previous != nullptr ? std::optional(previous->anchor) : std::nullopt;
  const bool stays = now && stays_about(map, *previous, corners);
  if (stays && !keyframe_of(map, *now)) return *now;
  auto anchor = anchor_for(map, corners, now);
  if (!anchor && stays) anchor = now;
  if (!anchor && rejected) anchor = nearest_keyframe(map, middle_of(corners));
  if (!anchor)
    refuse_field("place", "an area that no camera image shows completely",
                 "an area that one image shows completely");
  return *anchor;
}

Label shape_from_wire(const Map& map, const Json& body, const Label* previous) {
  const std::string shape = text_field(body, "shape");
  const bool rejected = is_rejected_kind(kind_field(body));
  if (shape == "box") {
    OrientedBox box;
    box.centre = {number_field(body, "x"), number_field(body, "y")};
    box.heading = number_field(body, "heading");
    box.length_m = number_field(body, "length");
    box.width_m = number_field(body, "width");
    for (const double side : {box.length_m, box.width_m})
      if (!(side >= 0.05 && side <= 100.0))
        refuse_field("length, width", std::to_string(side), "0.05 to 100 m");
    const auto corners = box.corners();
    return label_of_box(map, anchor_of(map, {corners.begin(), corners.end()}, previous, rejected),
                        box);
  }
  if (shape != "polygon") refuse_field("shape", shape, "box or polygon");
  const Json& list = required_field(body, "corners");
  if (!list.is_array() || list.size() < 3 || list.size() > kMostCorners)
    refuse_field("corners", list.is_array() ? std::to_string(list.size()) : "another type",
                 "a list of 3 to " + std::to_string(kMostCorners) + " corners");
  std::vector<Eigen::Vector2d> corners;
  for (const Json& corner : list) corners.push_back(point_field(corner));
  return label_of_polygon(map, anchor_of(map, corners, previous, rejected), corners);
}

}  // namespace

Json classes_to_wire(const LabelClassList& list) {
  return {{"classes", Json(classes_to_json(list.classes))},
          {"version", list.version},
          {"who", list.who},
          {"when", utc_text(list.t_ns)}};
}

LabelClassList classes_from_wire(const Json& body) {
  const Json& list = required_field(body, "classes");
  if (!list.is_array()) refuse_field("classes", list.dump().substr(0, 40), "a list of classes");
  std::vector<LabelClass> classes;
  for (const Json& c : list) {
    if (!c.is_object()) refuse_field("classes", c.dump().substr(0, 40), "an object for each class");
    const std::string shape = text_field(c, "shape");
    if (shape != "box" && shape != "polygon") refuse_field("shape", shape, "box or polygon");
    classes.push_back(
        {text_field(c, "kind"), text_field(c, "title"), text_field(c, "colour"), shape == "box"});
  }
  try {
    check_label_classes(classes);
  } catch (const InvalidOption& fault) {
    refuse_field(fault.problem().field, fault.problem().got, fault.problem().want);
  }
  return {std::move(classes), integer_field(body, "version"), text_field(body, "who")};
}

Json label_to_wire(const Map& map, const Label& label) {
  Json json = {{"id", label.id},
               {"version", label.version},
               {"deleted", label.state == LabelState::kDeleted},
               {"kind", label.kind},
               {"source", to_text(label.source)},
               {"who", label.who},
               {"when", utc_text(label.t_ns)},
               {"score", label.score},
               {"note", label.note},
               {"shape", to_text(label.shape)},
               {"anchor", image_to_wire(label.anchor)}};
  json["corners"] = Json::array();
  if (label.shape == LabelShape::kUpright) {
    const auto& cameras = map.sessions[static_cast<std::size_t>(label.anchor.session)].rig.cameras;
    json.update(box_to_wire(cameras[static_cast<std::size_t>(label.anchor.camera)], label.window));
  }
  if (!is_on_ground(label)) return json;
  for (const auto& corner : flat_corners(map, label))
    json["corners"].push_back({corner.x(), corner.y()});
  if (const auto box = box_in_map(map, label)) {
    json["x"] = box->centre.x();
    json["y"] = box->centre.y();
    json["heading"] = box->heading;
    json["length"] = box->length_m;
    json["width"] = box->width_m;
  }
  if (const auto covariance = covariance_in_map(map, label)) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(*covariance);
    json["sigma_m"] = std::sqrt(std::max(0.0, axes.eigenvalues()[1]));
  }
  for (const LabelShift& shift : shifts_since_seen(map, {label}).shifts)
    if (shift.sigmas > kLargestShiftSigmas) json["moved_m"] = shift.metres();
  return json;
}

Json changed_on_wire(const Map& map, const Label& label, const Json& body) {
  Json json = label_to_wire(map, label);
  if (body.contains("foot") || body.contains("head")) json.erase("azimuth");
  json.update(body);
  return json;
}

Label label_from_wire(const Map& map, const Json& told, const Label* previous) {
  const Json body = on_map_of_today(map, told);
  Label label;
  try {
    label = shape_from_wire(map, body, previous);
  } catch (const InvalidOption& fault) {
    throw RequestError(422, fault.what());
  }
  read_label_fields(body, &label);
  // A hypothesis without correction by a user is less accurate than a shape that a user has drawn
  // or corrected.
  const bool shaped = body.contains("shaped") && flag_field(body, "shaped");
  if (label.source != LabelSource::kDrawn && !shaped) label.sigma_m = kFoundSigma_m;
  if (previous != nullptr) {
    label.id = previous->id;
    const bool same = same_shape(flat_corners(map, *previous), flat_corners(map, label));
    label.sigma_m = same ? previous->sigma_m : Label().sigma_m;
    // The sightings in other images are valid only for this shape.
    if (same) label.sightings = previous->sightings;
  }
  return label;
}

bool tells_shape(const Json& body) {
  constexpr std::array kFields{"shape",   "x",    "y",    "heading", "length",     "width",
                               "corners", "foot", "head", "azimuth", "foot_slope", "size"};
  return std::any_of(kFields.begin(), kFields.end(),
                     [&](const char* field) { return body.contains(field); });
}

Label with_fields(const Map& map, Label label, const Json& body) {
  read_label_fields(changed_on_wire(map, label, body), &label);
  return label;
}

}  // namespace roadbook
