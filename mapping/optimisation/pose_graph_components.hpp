#pragma once

#include <cstdint>
#include <vector>

#include "mapping/optimisation/pose_graph.hpp"

namespace roadbook {

/// Component of each pose: poses joined by odometry, and by loop k where `use[k]` is not 0. Counted
/// from 0 in the order of the poses.
[[nodiscard]] std::vector<int> connected_components(const PoseGraph& graph,
                                                    const std::vector<std::uint8_t>& use);

/// Places components that no odometry joins by their loops. Begins with the component of the fixed
/// pose and adds one component after another. Each is moved as a whole by the loop that most other
/// loops agree with. Returns for each loop 1 if both its ends lie in placed components or in one
/// component; else 0, and the loop cannot be judged.
[[nodiscard]] std::vector<std::uint8_t> join_components(
    const PoseGraph& graph,
    const PoseGraphOptions& options,
    std::vector<Eigen::Isometry3d>& T_map_vehicle);

/// For each loop the number of loops, itself included, whose ends both lie within `span` poses of
/// its own ends. Such loops see the same two places and have a common error.
[[nodiscard]] std::vector<int> loop_crowding(const std::vector<RelativePose>& loops, int span);

}  // namespace roadbook
