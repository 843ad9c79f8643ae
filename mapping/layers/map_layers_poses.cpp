#include "mapping/layers/map_layers_poses.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "base/se3.hpp"
#include "mapping/landmark_weights.hpp"

namespace roadbook {
namespace {

struct Views {
  std::int64_t count = 0;
  std::int64_t newest_ns = std::numeric_limits<std::int64_t>::min();
  std::vector<int> sessions;  ///< ascending
};

std::vector<Views> views_of(const Map& map) {
  std::vector<Views> views(map.landmarks.size());
  for (const Observation& o : map.observations) {
    Views& v = views[static_cast<std::size_t>(o.landmark)];
    const Keyframe& k = map.keyframes[static_cast<std::size_t>(o.keyframe)];
    ++v.count;
    v.newest_ns = std::max(v.newest_ns, k.t_ns);
    const auto at = std::lower_bound(v.sessions.begin(), v.sessions.end(), k.session);
    if (at == v.sessions.end() || *at != k.session) v.sessions.insert(at, k.session);
  }
  return views;
}

std::string session_list(const Map& map, const std::vector<int>& sessions) {
  std::string text;
  for (const int s : sessions)
    text += (text.empty() ? "" : ",") + map.sessions[static_cast<std::size_t>(s)].name;
  return text;
}

}  // namespace

VectorLayer pose_layer(const Map& map) {
  VectorLayer layer;
  layer.name = "poses";
  layer.description = "Vehicle poses of the keyframes; M is the time since the session's start [s]";
  layer.type = GeometryType::kPointZM;
  layer.fields = {{"keyframe", FieldType::kInteger},  {"session", FieldType::kInteger},
                  {"session_name", FieldType::kText}, {"t_ns", FieldType::kInteger},
                  {"date_utc", FieldType::kText},     {"heading_rad", FieldType::kReal},
                  {"qx", FieldType::kReal},           {"qy", FieldType::kReal},
                  {"qz", FieldType::kReal},           {"qw", FieldType::kReal},
                  {"sigma_m", FieldType::kReal},      {"sigma_heading_rad", FieldType::kReal},
                  {"travelled_m", FieldType::kReal},  {"reversing", FieldType::kInteger},
                  {"after_gap", FieldType::kInteger}};
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const Keyframe& k = map.keyframes[i];
    const Session& session = map.sessions[static_cast<std::size_t>(k.session)];
    const Eigen::Isometry3d T = map.T_map_vehicle(static_cast<int>(i));
    const Eigen::Quaterniond q(T.linear());
    const Eigen::Vector3d p = T.translation();
    const double seconds = static_cast<double>(k.t_ns - session.t_begin_ns) * 1e-9;
    Feature feature;
    feature.points.emplace_back(p.x(), p.y(), p.z(), seconds);
    feature.values = {static_cast<std::int64_t>(i),
                      std::int64_t{k.session},
                      session.name,
                      k.t_ns,
                      utc_text(k.t_ns),
                      heading_of(T),
                      q.x(),
                      q.y(),
                      q.z(),
                      q.w(),
                      std::sqrt(k.covariance.topLeftCorner<3, 3>().trace()),
                      std::sqrt(k.covariance(5, 5)),
                      k.travelled_m,
                      std::int64_t{k.reversing ? 1 : 0},
                      std::int64_t{k.after_gap ? 1 : 0}};
    layer.features.push_back(std::move(feature));
  }
  return layer;
}

VectorLayer landmark_layer(const Map& map) {
  VectorLayer layer;
  layer.name = "landmark_points";
  layer.description = "Landmarks of the metric map";
  layer.type = GeometryType::kPointZ;
  layer.fields = {{"landmark", FieldType::kInteger}, {"sigma_m", FieldType::kReal},
                  {"views", FieldType::kInteger},    {"ground", FieldType::kInteger},
                  {"date_utc", FieldType::kText},    {"sessions", FieldType::kText},
                  {"weight", FieldType::kReal}};
  const std::vector<Views> views = views_of(map);
  const std::vector<double> weights = landmark_weights(map);
  for (std::size_t i = 0; i < map.landmarks.size(); ++i) {
    const Landmark& l = map.landmarks[i];
    const Eigen::Vector3d p = map.p_map(l);
    Feature feature;
    feature.points.emplace_back(p.x(), p.y(), p.z(), 0.0);
    feature.values = {static_cast<std::int64_t>(i),
                      std::sqrt(l.covariance.trace()),
                      views[i].count,
                      std::int64_t{l.ground ? 1 : 0},
                      FieldValue{},
                      session_list(map, views[i].sessions),
                      weights[i]};
    if (views[i].count > 0) feature.values[4] = utc_text(views[i].newest_ns);
    layer.features.push_back(std::move(feature));
  }
  return layer;
}

}  // namespace roadbook
