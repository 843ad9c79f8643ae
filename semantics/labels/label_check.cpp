#include "semantics/labels/label_check.hpp"

#include <algorithm>
#include <cmath>

#include "base/error.hpp"
#include "base/utf8.hpp"
#include "semantics/labels/label_classes.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kMostPictures = 64;
constexpr std::size_t kLargestPicture = 64 * 1024;  // bytes

double turn_of(const Eigen::Vector3d& o, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
}

// Whether p lies between a and b; the three points must be on one line.
bool lies_between(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (p - a).head<2>().dot((p - b).head<2>()) <= 0.0;
}

bool cross_each_other(const Eigen::Vector3d& a,
                      const Eigen::Vector3d& b,
                      const Eigen::Vector3d& c,
                      const Eigen::Vector3d& d) {
  return turn_of(a, b, c) * turn_of(a, b, d) < 0.0 && turn_of(c, d, a) * turn_of(c, d, b) < 0.0;
}

bool crosses_itself(const std::vector<Eigen::Vector3d>& p) {
  const std::size_t n = p.size();
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = i + 2; j < n; ++j)
      if (!(i == 0 && j + 1 == n) && cross_each_other(p[i], p[i + 1], p[j], p[(j + 1) % n]))
        return true;
  return false;
}

bool touch(const Eigen::Vector3d& a,
           const Eigen::Vector3d& b,
           const Eigen::Vector3d& c,
           const Eigen::Vector3d& d) {
  return (turn_of(a, b, c) == 0.0 && lies_between(c, a, b)) ||
         (turn_of(a, b, d) == 0.0 && lies_between(d, a, b)) ||
         (turn_of(c, d, a) == 0.0 && lies_between(a, c, d)) ||
         (turn_of(c, d, b) == 0.0 && lies_between(b, c, d));
}

// Whether the polygon touches itself at a place other than the common corner of two successive
// sides. Repeated successive corners count as one corner.
bool touches_itself(std::vector<Eigen::Vector3d> p) {
  const auto same = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return a.head<2>() == b.head<2>();
  };
  p.erase(std::unique(p.begin(), p.end(), same), p.end());
  while (p.size() > 1 && same(p.front(), p.back())) p.pop_back();
  const std::size_t n = p.size();
  for (std::size_t i = 0; n > 2 && i < n; ++i) {
    const Eigen::Vector3d& next = p[(i + 1) % n];
    const Eigen::Vector3d& after = p[(i + 2) % n];
    if (turn_of(p[i], next, after) == 0.0 &&
        (next - p[i]).head<2>().dot((after - next).head<2>()) < 0.0)
      return true;  // back along the same side
    for (std::size_t j = i + 2; j < n; ++j)
      if (!(i == 0 && j + 1 == n) && touch(p[i], next, p[j], p[(j + 1) % n])) return true;
  }
  return false;
}

double area_m2(const std::vector<Eigen::Vector3d>& p) {
  double sum = 0.0;
  for (std::size_t i = 2; i < p.size(); ++i) sum += turn_of(p[0], p[i - 1], p[i]);
  return 0.5 * std::abs(sum);
}

void check_text(const std::string& text,
                std::size_t longest,
                const char* field,
                const std::string& source) {
  const auto characters = utf8_characters(text);
  if (!characters) refuse_label(source, field, "bytes that are not UTF-8", "UTF-8 text");
  if (*characters > longest)
    refuse_label(source, field, std::to_string(*characters) + " characters",
                 "at most " + std::to_string(longest));
}

void check_window(const Label& label, const std::string& source) {
  constexpr double kPi = 3.1415926536;
  const PersonBox& box = label.window;
  if (box.camera != label.anchor.camera)
    refuse_label(source, "camera", std::to_string(box.camera), "the camera of the anchor");
  if (label.shape == LabelShape::kUpright) {
    if (!(std::abs(box.azimuth) <= kPi))
      refuse_label(source, "azimuth", std::to_string(box.azimuth), "-pi to pi");
    if (!(std::abs(box.foot_slope) <= 20.0))
      refuse_label(source, "foot_slope", std::to_string(box.foot_slope), "-20 to 20");
    if (!(box.size >= 0.01 && box.size <= 20.0))
      refuse_label(source, "size", std::to_string(box.size), "0.01 to 20");
    if (label.pictures.size() != 1)
      refuse_label(source, "pictures", std::to_string(label.pictures.size()), "one image");
  }
  if (label.pictures.size() > kMostPictures)
    refuse_label(source, "pictures", std::to_string(label.pictures.size()), "at most 64");
  for (const std::string& picture : label.pictures)
    if (picture.size() > kLargestPicture)
      refuse_label(source, "pictures", "a larger image", "at most 64 KiB each");
}

// Checks that the anchor names an image of a session. The map need not keep the pose of this image.
void check_image(const Map& map, const LabelAnchor& anchor, const std::string& source) {
  const auto& sessions = map.sessions;
  if (anchor.session < 0 || anchor.session >= static_cast<int>(sessions.size()))
    refuse_label(source, "session", std::to_string(anchor.session), "a session of the map");
  const Session& session = sessions[static_cast<std::size_t>(anchor.session)];
  if (anchor.camera < 0 || anchor.camera >= static_cast<int>(session.rig.cameras.size()))
    refuse_label(source, "camera", std::to_string(anchor.camera), "a camera of the session");
  if (anchor.t_ns < session.t_begin_ns || anchor.t_ns > session.t_end_ns)
    refuse_label(source, "t_ns", std::to_string(anchor.t_ns), "a time stamp of the session");
}

}  // namespace

void refuse_label(const std::string& source,
                  const std::string& field,
                  const std::string& got,
                  const std::string& want) {
  throw BadInput({Severity::kError, source, 0, field, got, want});
}

void check_label(const Label& label, const std::string& source) {
  constexpr double kLargestM = 1000.0;
  const auto length = [&](const char* field, double value, double lowest) {
    if (!(value >= lowest && value <= kLargestM))
      refuse_label(source, field, std::to_string(value), "0 to 1000 m");
  };
  check_text(searched_kind(label.kind), 64, "kind", source);
  if (label.kind.empty()) refuse_label(source, "kind", "''", "1 to 64 characters");
  check_text(label.note, 1000, "note", source);
  if (!(label.score >= 0.0 && label.score <= 1.0))
    refuse_label(source, "score", std::to_string(label.score), "0 to 1");
  length("sigma_m", label.sigma_m, 0.0);
  std::vector<Eigen::Vector3d> points = label.corners_vehicle;
  if (label.shape == LabelShape::kBox) {
    length("length_m", label.length_m, 1e-3);
    length("width_m", label.width_m, 1e-3);
    points = {label.T_vehicle_label.translation()};
  } else if (!is_on_ground(label)) {
    check_window(label, source);
  } else if (points.size() < 3 || points.size() > kMostCorners) {
    refuse_label(source, "corners", std::to_string(points.size()),
                 "3 to " + std::to_string(kMostCorners));
  }
  for (const LabelSighting& sighting : label.sightings) {
    points.push_back(sighting.middle_vehicle);
    length("sightings sigma_m", sighting.sigma_m, 0.0);
  }
  for (const auto& p : points)
    for (const double value : {p.x(), p.y(), p.z()})
      if (!(std::abs(value) <= kLargestM))
        refuse_label(source, "place", std::to_string(value), "within 1000 m of the vehicle");
  if (label.shape == LabelShape::kPolygon && crosses_itself(label.corners_vehicle))
    refuse_label(source, "corners", "a polygon that crosses itself", "a simple polygon");
}

void check_new_label(const Label& label, const std::string& source) {
  check_label(label, source);
  if (const auto wrong = wrong_name(searched_kind(label.kind)))
    refuse_label(source, "kind", *wrong, kNameWanted);
  if (is_rejected_kind(searched_kind(label.kind)))
    refuse_label(source, "kind", "'" + label.kind + "'", "at most one prefix not_");
  if (label.shape == LabelShape::kPolygon && !(area_m2(label.corners_vehicle) > 1e-6))
    refuse_label(source, "corners", "a polygon without an area", "a polygon with an area");
  if (label.shape == LabelShape::kPolygon && touches_itself(label.corners_vehicle))
    refuse_label(source, "corners", "a polygon that touches itself", "a simple polygon");
}

void check_label_anchor(const Map& map, const Label& label, const std::string& source) {
  if (!is_on_ground(label)) return check_image(map, label.anchor, source);
  if (!vehicle_of(map, label.anchor))
    refuse_label(source, "anchor", std::to_string(label.anchor.t_ns),
                 "a time with a pose in the map");
}

void forget_other_search(const Label& before, Label& label) {
  if (searched_kind(before.kind) == searched_kind(label.kind)) return;
  label.source = LabelSource::kDrawn;
  label.score = 1.0;
}

}  // namespace roadbook
