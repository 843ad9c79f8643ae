#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "mapping/map.hpp"

namespace roadbook {

/// Where a session's vehicle was, from its keyframes. Refers to the map.
class SessionTrack {
 public:
  SessionTrack(const Map& map, int session);

  [[nodiscard]] const std::vector<std::int64_t>& stamps() const { return t_ns_; }
  /// Index in the map of the keyframe at `stamps()[i]`.
  [[nodiscard]] int keyframe(std::size_t i) const { return keyframes_[i]; }
  /// Pose between the keyframes before and after, if they are one movement: position by time,
  /// rotation likewise.
  [[nodiscard]] std::optional<Eigen::Isometry3d> at(std::int64_t t_ns) const;

 private:
  const Map& map_;
  std::vector<std::int64_t> t_ns_;
  std::vector<int> keyframes_;
};

}  // namespace roadbook
