#include "apps/label_server/anchor_views.hpp"

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "workflows/labels/people_images.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

constexpr int kPointsAnEdge = 16;

Json outline_of(const MountedCamera& mounted, const std::vector<Eigen::Vector3d>& corners) {
  const Eigen::Isometry3d T_camera_vehicle = mounted.T_vehicle_camera.inverse();
  Json outline = Json::array();
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d step = (corners[(i + 1) % corners.size()] - corners[i]) / kPointsAnEdge;
    for (int k = 0; k < kPointsAnEdge; ++k)
      if (const auto pixel = mounted.camera.project(T_camera_vehicle * (corners[i] + k * step)))
        outline.push_back({pixel->x(), pixel->y()});
  }
  return outline;
}

}  // namespace

AnchorViews::AnchorViews(const Map* map, const std::vector<std::optional<Drive>>* drives)
    : map_(map), drives_(drives) {}

bool AnchorViews::has_drive() const {
  return std::any_of(drives_->begin(), drives_->end(), [](const auto& d) { return d.has_value(); });
}

Json AnchorViews::view_of(const Label& label) const {
  const LabelAnchor& anchor = label.anchor;
  if (!vehicle_of(*map_, anchor)) return nullptr;
  const auto session = static_cast<std::size_t>(anchor.session);
  const auto& cameras = map_->sessions[session].rig.cameras;
  if (anchor.camera < 0 || anchor.camera >= static_cast<int>(cameras.size())) return nullptr;
  const MountedCamera& mounted = cameras[static_cast<std::size_t>(anchor.camera)];
  const std::string t = std::to_string(anchor.t_ns);
  Json json = {{"session", map_->sessions[session].name},
               {"camera", mounted.name},
               {"t_ns", t},
               {"width", mounted.camera.width},
               {"height", mounted.camera.height},
               {"outline", outline_of(mounted, corners_of(label))},
               {"image", nullptr}};
  if ((*drives_)[session])
    json["image"] = "/api/image/" + std::to_string(anchor.session) + "/" + t + "/" +
                    std::to_string(anchor.camera);
  return json;
}

std::optional<std::string> AnchorViews::image(int session, std::int64_t t_ns, int camera) const {
  if (session < 0 || session >= static_cast<int>(drives_->size()) || camera < 0)
    return std::nullopt;
  const auto& drive = (*drives_)[static_cast<std::size_t>(session)];
  if (!drive || static_cast<std::size_t>(camera) >= drive->rig().cameras.size())
    return std::nullopt;
  const auto frame = frame_at(*drive, t_ns);
  if (!frame || !drive->has_image(*frame, static_cast<std::size_t>(camera))) return std::nullopt;
  const cv::Mat image = drive->read_image(*frame, static_cast<std::size_t>(camera));
  if (image.empty()) return std::nullopt;
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_QUALITY, 90});
  return std::string(bytes.begin(), bytes.end());
}

}  // namespace roadbook
