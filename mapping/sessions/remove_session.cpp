#include "mapping/sessions/remove_session.hpp"

#include <map>
#include <utility>
#include <vector>

#include "base/error.hpp"
#include "base/index.hpp"
#include "mapping/inverse_information.hpp"
#include "mapping/joined_parts.hpp"
#include "mapping/landmark_information.hpp"
#include "mapping/pieces.hpp"

namespace roadbook {
namespace {

constexpr int kLeastViews = 3;  // of a landmark, as of those that a build stores

// New indices after a removal; -1: removed.
struct NewIndices {
  std::vector<int> keyframe;
  std::vector<int> landmark;
  std::vector<int> frame;
};

NewIndices indices_without(const Map& map, int session) {
  const auto numbered = [](const std::vector<char>& stays) {
    std::vector<int> index(stays.size(), -1);
    int next = 0;
    for (std::size_t i = 0; i < stays.size(); ++i)
      if (stays[i] != 0) index[i] = next++;
    return index;
  };
  std::vector<char> keyframes(map.keyframes.size());
  std::vector<char> frames(map.map_frames.size(), 0);
  for (std::size_t k = 0; k < keyframes.size(); ++k) {
    keyframes[k] = map.keyframes[k].session != session ? 1 : 0;
    if (keyframes[k] != 0) frames[at(map.keyframes[k].map_frame)] = 1;
  }
  std::vector<int> views(map.landmarks.size(), 0);
  for (const Observation& o : map.observations)
    if (keyframes[at(o.keyframe)] != 0) ++views[at(o.landmark)];
  std::vector<char> landmarks(views.size());
  for (std::size_t l = 0; l < views.size(); ++l) landmarks[l] = views[l] >= kLeastViews ? 1 : 0;
  return {numbered(keyframes), numbered(landmarks), numbered(frames)};
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
      if (is_known(landmark.covariance))
        landmark.covariance =
            T_new_old.linear() * landmark.covariance * T_new_old.linear().transpose();
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
    const Eigen::Matrix3d R =
        smaller.map_frames[at(landmark.map_frame)].T_map_frame.linear();  // map from its frame
    const double factor = landmark.covariance.trace() / least_before.trace();
    landmark.covariance = factor * (R.transpose() * least_after * R);
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

int session_named(const Map& map, const std::string& name, const char* option) {
  std::string known;
  for (std::size_t s = 0; s < map.sessions.size(); ++s) {
    if (map.sessions[s].name == name) return static_cast<int>(s);
    known += (known.empty() ? "" : ", ") + map.sessions[s].name;
  }
  throw InvalidOption(option, name, known);
}

RemovedSession without_session(const Map& map, int session) {
  if (map.sessions.size() < 2)
    throw Refused("error: session " + map.sessions[at(session)].name +
                  ": got the only session of the map, want a map with another one");
  const NewIndices index = indices_without(map, session);
  RemovedSession removed;
  removed.pieces_before = piece_count(map);
  Map& smaller = removed.map;
  smaller.sessions = map.sessions;
  smaller.sessions.erase(smaller.sessions.begin() + session);
  for (std::size_t f = 0; f < map.map_frames.size(); ++f)
    if (index.frame[f] >= 0) smaller.map_frames.push_back(map.map_frames[f]);
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    if (index.keyframe[k] < 0) continue;
    Keyframe keyframe = map.keyframes[k];
    if (keyframe.session > session) --keyframe.session;
    keyframe.map_frame = index.frame[at(keyframe.map_frame)];
    smaller.keyframes.push_back(keyframe);
  }
  move_to_frames(map, index, smaller);
  removed.landmarks_lost = map.landmarks.size() - smaller.landmarks.size();
  for (Observation o : map.observations) {
    o.keyframe = index.keyframe[at(o.keyframe)];
    o.landmark = index.landmark[at(o.landmark)];
    if (o.keyframe >= 0 && o.landmark >= 0) smaller.observations.push_back(o);
  }
  for (LoneCorner corner : map.corners)
    if ((corner.keyframe = index.keyframe[at(corner.keyframe)]) >= 0)
      smaller.corners.push_back(corner);
  for (LandmarkSession row : map.landmark_sessions) {
    if (row.session == session) continue;
    if (row.session > session) --row.session;
    if ((row.landmark = index.landmark[at(row.landmark)]) >= 0)
      smaller.landmark_sessions.push_back(row);
  }
  for (LoopEdge loop : map.loops) {
    loop.from = index.keyframe[at(loop.from)];
    loop.to = index.keyframe[at(loop.to)];
    if (loop.from >= 0 && loop.to >= 0) smaller.loops.push_back(loop);
  }
  widen_covariances(map, index, smaller);
  renumber_pieces(smaller);
  removed.pieces = piece_count(smaller);
  return removed;
}

}  // namespace roadbook
