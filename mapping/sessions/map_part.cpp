#include "mapping/sessions/map_part.hpp"

#include <map>
#include <utility>

#include "base/index.hpp"
#include "mapping/inverse_information.hpp"
#include "mapping/joined_parts.hpp"
#include "mapping/landmark_information.hpp"

namespace roadbook {
namespace {

constexpr int kLeastViews = 3;  // of a landmark, as of those that a build stores

// New indices in the part; -1: not in it.
struct NewIndices {
  std::vector<int> keyframe;
  std::vector<int> landmark;
  std::vector<int> frame;
  std::vector<int> session;
};

NewIndices indices_of_part(const Map& map, const std::vector<char>& keeps) {
  const auto numbered = [](const std::vector<char>& stays) {
    std::vector<int> index(stays.size(), -1);
    int next = 0;
    for (std::size_t i = 0; i < stays.size(); ++i)
      if (stays[i] != 0) index[i] = next++;
    return index;
  };
  std::vector<char> frames(map.map_frames.size(), 0);
  std::vector<char> sessions(map.sessions.size(), 0);
  for (std::size_t k = 0; k < keeps.size(); ++k) {
    if (keeps[k] == 0) continue;
    frames[at(map.keyframes[k].map_frame)] = 1;
    sessions[at(map.keyframes[k].session)] = 1;
  }
  std::vector<int> views(map.landmarks.size(), 0);
  for (const Observation& o : map.observations)
    if (keeps[at(o.keyframe)] != 0) ++views[at(o.landmark)];
  std::vector<char> landmarks(views.size());
  for (std::size_t l = 0; l < views.size(); ++l) landmarks[l] = views[l] >= kLeastViews ? 1 : 0;
  return {numbered(keeps), numbered(landmarks), numbered(frames), numbered(sessions)};
}

// A landmark in a map frame that goes gets the frame of the first keyframe that sees it.
void move_to_frames(const Map& map, const NewIndices& index, Map& smaller) {
  std::vector<int> viewer(map.landmarks.size(), -1);
  for (const Observation& o : map.observations)
    if (viewer[at(o.landmark)] < 0 && index.keyframe[at(o.keyframe)] >= 0)
      viewer[at(o.landmark)] = o.keyframe;
  for (std::size_t l = 0; l < map.landmarks.size(); ++l) {
    if (index.landmark[l] < 0) continue;
    Landmark landmark = map.landmarks[l];
    if (index.frame[at(landmark.map_frame)] < 0) {
      const Eigen::Isometry3d T_map_old = map.map_frames[at(landmark.map_frame)].T_map_frame;
      landmark.map_frame = map.keyframes[at(viewer[l])].map_frame;
      const Eigen::Isometry3d T_new_old =
          map.map_frames[at(landmark.map_frame)].T_map_frame.inverse() * T_map_old;
      landmark.p_frame = T_new_old * landmark.p_frame;
    }
    landmark.map_frame = index.frame[at(landmark.map_frame)];
    smaller.landmarks.push_back(landmark);
  }
}

// A landmark that lost views is known less: by as much as independent observations would be.
void widen_covariances(const Map& map, const NewIndices& index, Map& smaller) {
  std::vector<int> lost(map.landmarks.size(), 0);
  for (const Observation& o : map.observations)
    if (index.keyframe[at(o.keyframe)] < 0) ++lost[at(o.landmark)];
  const auto before = landmark_information(map);
  const auto after = landmark_information(smaller);
  for (std::size_t l = 0; l < map.landmarks.size(); ++l) {
    if (lost[l] == 0 || index.landmark[l] < 0) continue;
    Landmark& landmark = smaller.landmarks[at(index.landmark[l])];
    if (!is_known(landmark.covariance)) continue;
    const Eigen::Matrix3d least_before = covariance_of_information(before[l]);
    const Eigen::Matrix3d least_after = covariance_of_information(after[at(index.landmark[l])]);
    const double factor = landmark.covariance.trace() / least_before.trace();
    landmark.covariance = factor * least_after;
    if (!is_known(landmark.covariance)) landmark.covariance = unknown_covariance<Eigen::Matrix3d>();
  }
}

// Numbers the parts of each piece that something still joins. Parts of different pieces stay apart.
void renumber_pieces(Map& map) {
  const std::vector<int> parts = joined_parts(map);
  std::map<std::pair<int, int>, int> numbers;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    int& piece = map.keyframes[k].piece;
    piece = numbers.try_emplace({piece, parts[k]}, static_cast<int>(numbers.size())).first->second;
  }
}

}  // namespace

Map part_of_map(const Map& map, const std::vector<char>& keeps) {
  const NewIndices index = indices_of_part(map, keeps);
  Map part;
  for (std::size_t s = 0; s < map.sessions.size(); ++s)
    if (index.session[s] >= 0) part.sessions.push_back(map.sessions[s]);
  for (std::size_t f = 0; f < map.map_frames.size(); ++f)
    if (index.frame[f] >= 0) part.map_frames.push_back(map.map_frames[f]);
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    if (index.keyframe[k] < 0) continue;
    Keyframe keyframe = map.keyframes[k];
    keyframe.session = index.session[at(keyframe.session)];
    keyframe.map_frame = index.frame[at(keyframe.map_frame)];
    part.keyframes.push_back(keyframe);
  }
  move_to_frames(map, index, part);
  for (Observation o : map.observations) {
    o.keyframe = index.keyframe[at(o.keyframe)];
    o.landmark = index.landmark[at(o.landmark)];
    if (o.keyframe >= 0 && o.landmark >= 0) part.observations.push_back(o);
  }
  for (LoneCorner corner : map.corners)
    if ((corner.keyframe = index.keyframe[at(corner.keyframe)]) >= 0)
      part.corners.push_back(corner);
  for (LandmarkSession row : map.landmark_sessions) {
    row.session = index.session[at(row.session)];
    row.landmark = index.landmark[at(row.landmark)];
    if (row.session >= 0 && row.landmark >= 0) part.landmark_sessions.push_back(row);
  }
  for (LoopEdge loop : map.loops) {
    loop.from = index.keyframe[at(loop.from)];
    loop.to = index.keyframe[at(loop.to)];
    if (loop.from >= 0 && loop.to >= 0) part.loops.push_back(loop);
  }
  widen_covariances(map, index, part);
  renumber_pieces(part);
  return part;
}

}  // namespace roadbook
