#include "mapping/landmark_information.hpp"

#include "base/index.hpp"

namespace roadbook {

std::optional<ObservationTerms> terms_of(const Map& map, const Observation& o) {
  const Keyframe& keyframe = map.keyframes[at(o.keyframe)];
  const MountedCamera& mounted = map.sessions[at(keyframe.session)].rig.cameras[at(o.camera)];
  const Eigen::Isometry3d T_vehicle_map = map.T_map_vehicle(o.keyframe).inverse();
  const Eigen::Vector3d p_vehicle = T_vehicle_map * map.p_map(map.landmarks[at(o.landmark)]);
  const Eigen::Isometry3d T_camera_vehicle = mounted.T_vehicle_camera.inverse();
  Matrix23d J;
  if (!mounted.camera.project(T_camera_vehicle * p_vehicle, &J) || !J.allFinite())
    return std::nullopt;
  J /= static_cast<double>(o.sigma_px);
  const Matrix23d J_vehicle = J * T_camera_vehicle.linear();
  ObservationTerms terms;
  terms.J_point = J_vehicle * T_vehicle_map.linear();
  terms.J_pose.leftCols<3>() = -J_vehicle;
  terms.J_pose.rightCols<3>() = J_vehicle * skew(p_vehicle);
  return terms;
}

std::vector<Eigen::Matrix3d> landmark_information(const Map& map) {
  std::vector<Eigen::Matrix3d> information(map.landmarks.size(), Eigen::Matrix3d::Zero());
  for (const Observation& o : map.observations)
    if (const auto terms = terms_of(map, o))
      information[at(o.landmark)].noalias() += terms->J_point.transpose() * terms->J_point;
  return information;
}

}  // namespace roadbook
