#include "apps/label_server/people_wire.hpp"

#include <charconv>
#include <cmath>

#include "apps/label_server/label_fields.hpp"
#include "apps/label_server/request_fields.hpp"
#include "base/se3.hpp"
#include "semantics/labels/label_check.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/people/person_labels.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

constexpr int kPointsAnOutline = 8;
constexpr std::size_t kRandomWindows = 3;  // in an image that shows no other person

std::optional<Eigen::Vector2d> pixel_of(const MountedCamera& mounted,
                                        double azimuth,
                                        double slope) {
  const Eigen::Vector3d ray(std::cos(azimuth), std::sin(azimuth), slope);
  return mounted.camera.project(mounted.T_vehicle_camera.linear().transpose() * ray);
}

Json pixel_json(const std::optional<Eigen::Vector2d>& pixel) {
  return pixel ? Json{pixel->x(), pixel->y()} : Json(nullptr);
}

// Returns azimuth and slope of a pixel.
Eigen::Vector2d direction_of(const MountedCamera& mounted, const Json& body, const char* name) {
  const auto found = body.find(name);
  if (found == body.end() || !found->is_array() || found->size() != 2 || !(*found)[0].is_number() ||
      !(*found)[1].is_number())
    refuse_field(name, found == body.end() ? "nothing" : found->dump().substr(0, 40),
                 "a pixel [u, v]");
  const Eigen::Vector2d pixel((*found)[0].get<double>(), (*found)[1].get<double>());
  const auto ray = mounted.camera.contains(pixel) ? mounted.camera.bearing(pixel) : std::nullopt;
  if (!ray) refuse_field(name, found->dump(), "a pixel of the image");
  const Eigen::Vector3d d = mounted.T_vehicle_camera.linear() * *ray;
  return {std::atan2(d.y(), d.x()), d.z() / std::max(1e-3, d.head<2>().norm())};
}

// The feet give the position of a person. The head is above the feet, a little aside if the person
// leans.
PersonBox box_of_pixels(const MountedCamera& mounted, int camera, const Json& body) {
  const Eigen::Vector2d foot = direction_of(mounted, body, "foot");
  const Eigen::Vector2d head = direction_of(mounted, body, "head");
  if (head.y() <= foot.y())
    refuse_field("head", "a point below the feet", "a point above the feet");
  const double aside = wrap_angle(head.x() - foot.x());
  return {camera, wrap_angle(foot.x() + 0.5 * aside), foot.y(), head.y() - foot.y()};
}

PersonBox box_from_wire(const MountedCamera& mounted, int camera, const Json& body) {
  if (!body.contains("azimuth")) return box_of_pixels(mounted, camera, body);
  return {camera, wrap_angle(number_field(body, "azimuth")), number_field(body, "foot_slope"),
          number_field(body, "size")};
}

}  // namespace

Json image_to_wire(const LabelAnchor& image) {
  return {
      {"session", image.session}, {"t_ns", std::to_string(image.t_ns)}, {"camera", image.camera}};
}

LabelAnchor image_from_wire(const Json& body) {
  const std::string text = text_field(body, "t_ns");
  LabelAnchor image;
  const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), image.t_ns);
  if (fault != std::errc() || end != text.data() + text.size())
    refuse_field("t_ns", text, "a time stamp in nanoseconds");
  const auto index = [&](const char* name) {
    const std::int64_t value = integer_field(body, name);
    if (value < 0 || value > 1'000'000) refuse_field(name, std::to_string(value), "0 to 1000000");
    return static_cast<int>(value);
  };
  image.session = index("session");
  image.camera = index("camera");
  return image;
}

Json box_to_wire(const MountedCamera& mounted, const PersonBox& box) {
  const double half = 0.5 * PersonBox::kBreadth * box.size;
  const std::array<Eigen::Vector2d, 4> corners{{{box.azimuth + half, box.foot_slope},
                                                {box.azimuth - half, box.foot_slope},
                                                {box.azimuth - half, box.foot_slope + box.size},
                                                {box.azimuth + half, box.foot_slope + box.size}}};
  Json outline = Json::array();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d step =
        (corners[(i + 1) % corners.size()] - corners[i]) / kPointsAnOutline;
    for (int k = 0; k < kPointsAnOutline; ++k) {
      const Eigen::Vector2d at = corners[i] + k * step;
      if (const auto pixel = pixel_of(mounted, at.x(), at.y()))
        outline.push_back({pixel->x(), pixel->y()});
    }
  }
  return {{"azimuth", box.azimuth},
          {"foot_slope", box.foot_slope},
          {"size", box.size},
          {"foot", pixel_json(pixel_of(mounted, box.azimuth, box.foot_slope))},
          {"head", pixel_json(pixel_of(mounted, box.azimuth, box.foot_slope + box.size))},
          {"outline", outline}};
}

bool is_window_on_wire(const Json& body) {
  const auto shape = body.find("shape");
  return shape != body.end() && (*shape == "upright" || *shape == "image");
}

Label window_from_wire(const PeopleImages& images,
                       const Json& body,
                       const std::vector<PersonBox>& known,
                       const Label* previous) {
  Label label;
  label.anchor = previous != nullptr ? previous->anchor : image_from_wire(body);
  if (!images.has(label.anchor))
    refuse_field("image", image_to_wire(label.anchor).dump(),
                 "an image of a session whose recording is available (--drive FOLDER)");
  read_label_fields(body, &label);
  const bool person = label.kind == kPersonKind;
  if (!person && label.kind != rejected_kind(kPersonKind))
    refuse_field("kind", label.kind, "person or not_person");
  const auto session = static_cast<std::size_t>(label.anchor.session);
  const auto& cameras = images.map().sessions[session].rig.cameras;
  label.window.camera = label.anchor.camera;
  if (text_field(body, "shape") == "image") {
    if (person)
      refuse_field("kind", label.kind,
                   "not_person for the shape image, which marks an image without further persons");
    label.shape = LabelShape::kImage;
    label.pictures = images.random_pictures(label.anchor, known, kRandomWindows);
  } else {
    label.shape = LabelShape::kUpright;
    label.window = box_from_wire(cameras[static_cast<std::size_t>(label.anchor.camera)],
                                 label.anchor.camera, body);
    label.pictures = {images.picture(label.anchor, label.window)};
    if (label.pictures.front().empty()) refuse_field("image", "an unreadable file", "an image");
  }
  if (previous != nullptr) label.id = previous->id;
  check_new_label(label, "window");
  return label;
}

}  // namespace roadbook
