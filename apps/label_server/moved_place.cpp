#include "apps/label_server/moved_place.hpp"

#include <cmath>

#include "apps/label_server/people_wire.hpp"
#include "apps/label_server/request_fields.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

Eigen::Isometry2d planar_pose(double x, double y, double heading) {
  return Eigen::Translation2d(x, y) * Eigen::Rotation2Dd(heading);
}

}  // namespace

Json on_map_of_today(const Map& map, Json body) {
  const auto found = body.find("pose");
  if (found == body.end()) return body;
  const Json pose = *found;
  if (!pose.is_object()) refuse_field("pose", pose.dump().substr(0, 40), "an object");
  const auto vehicle = vehicle_of(map, image_from_wire(pose));
  if (!vehicle) refuse_field("pose", "a time without a pose in the map", "a time with a pose");
  const double heading_then = number_field(pose, "heading");
  const Eigen::Isometry3d& now = vehicle->T_map_vehicle;
  const double heading_now = std::atan2(now.linear()(1, 0), now.linear()(0, 0));
  const Eigen::Isometry2d T_now_then =
      planar_pose(now.translation().x(), now.translation().y(), heading_now) *
      planar_pose(number_field(pose, "x"), number_field(pose, "y"), heading_then).inverse();
  const auto moved = [&](double x, double y) -> Eigen::Vector2d {
    return T_now_then * Eigen::Vector2d(x, y);
  };
  if (body.contains("x")) {
    const Eigen::Vector2d middle = moved(number_field(body, "x"), number_field(body, "y"));
    body["x"] = middle.x();
    body["y"] = middle.y();
    body["heading"] = number_field(body, "heading") + heading_now - heading_then;
  }
  if (body.contains("corners"))
    for (Json& corner : body["corners"]) {
      const Eigen::Vector2d p = point_field(corner);
      const Eigen::Vector2d to = moved(p.x(), p.y());
      corner = {to.x(), to.y()};
    }
  return body;
}

}  // namespace roadbook
