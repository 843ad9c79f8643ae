#pragma once

#include "mapping/edits/map_edit.hpp"
#include "mapping/map.hpp"
#include "mapping/optimisation/pose_graph.hpp"

namespace roadbook {

/// The keyframe that a place of an edit names: the nearest in time of its session, at most 1 s
/// away. Throws BadInput with the sessions or times that the map has.
[[nodiscard]] int keyframe_of_place(const Map& map, const EditPlace& place);

/// The motion between the keyframes of a kLoop or kSamePoints edit, from the earlier keyframe to
/// the later one.
///
/// Points of kSamePoints are landmarks that the pixels observe, else points on the ground plane of
/// the vehicle. The motion in the plane is the least-squares fit of the points of b to those of a
/// [Horn, JOSA A 4 (1987), in two dimensions]. Throws Refused for fewer than two points that can be
/// placed, or for points that fit no motion within 0.5 m.
[[nodiscard]] RelativePose motion_of_edit(const Map& map, const MapEdit& edit);

}  // namespace roadbook
