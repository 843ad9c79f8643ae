#pragma once

#include <cstdint>
#include <vector>

#include "mapping/optimisation/pose_graph.hpp"

namespace roadbook {

/// Number of the connected piece of each pose, counted from 0 in order of poses. `use[k]`: loop k
/// joins too.
[[nodiscard]] std::vector<int> connected_pieces(const PoseGraph& graph,
                                                const std::vector<std::uint8_t>& use);

/// Brings pieces that no odometry joins to where their loops say, one after another from the piece
/// of the fixed pose, each as a whole by the loop that most others agree with. Returns for each
/// loop whether both its ends are now in joined pieces (or in one piece); the others cannot be
/// judged.
[[nodiscard]] std::vector<std::uint8_t> join_pieces(const PoseGraph& graph,
                                                    const PoseGraphOptions& options,
                                                    std::vector<Eigen::Isometry3d>& T_map_vehicle);

/// For each loop the number of loops, itself included, whose ends both lie within `span` poses of
/// its own: those that see the same two places and err together.
[[nodiscard]] std::vector<int> loop_crowding(const std::vector<RelativePose>& loops, int span);

}  // namespace roadbook
