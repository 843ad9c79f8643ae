#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <string>

#include "mapping/optimisation/pose_graph.hpp"

namespace roadbook::test {

/// Reads a g2o file of 2D or 3D poses whose ids run from 0. Edges between neighbours are odometry,
/// the others loops. Planar poses get stiff height, roll and pitch. If the file has no vertices,
/// the start values are chained from odometry. The function uses the rotation's information as that
/// of the rotation vector.
inline PoseGraph read_g2o(const std::filesystem::path& file) {
  std::ifstream in(file);
  PoseGraph graph;
  const auto grow = [&](int id) {
    if (id >= static_cast<int>(graph.T_map_vehicle.size()))
      graph.T_map_vehicle.resize(static_cast<std::size_t>(id) + 1, Eigen::Isometry3d::Identity());
  };
  const auto read_pose = [](std::istream& fields) {
    double x, y, z, qx, qy, qz, qw;
    fields >> x >> y >> z >> qx >> qy >> qz >> qw;
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::Quaterniond(qw, qx, qy, qz).normalized().toRotationMatrix();
    T.translation() = Eigen::Vector3d(x, y, z);
    return T;
  };
  bool vertices = false;
  for (std::string line; std::getline(in, line);) {
    std::istringstream fields(line);
    std::string tag;
    fields >> tag;
    const bool planar = tag.find("SE2") != std::string::npos;
    int id = 0;
    if (tag.rfind("VERTEX", 0) == 0) {
      double x = 0, y = 0, heading = 0;
      fields >> id;
      grow(id);
      if (planar) fields >> x >> y >> heading;
      graph.T_map_vehicle[static_cast<std::size_t>(id)] =
          planar ? pose_from_planar(x, y, heading) : read_pose(fields);
      vertices = true;
    } else if (tag.rfind("EDGE", 0) == 0) {
      RelativePose edge;
      fields >> edge.from >> edge.to;
      grow(std::max(edge.from, edge.to));
      double x = 0, y = 0, heading = 0;
      if (planar) fields >> x >> y >> heading;
      edge.T_from_to = planar ? pose_from_planar(x, y, heading) : read_pose(fields);
      edge.information = 1e4 * Matrix6d::Identity();
      const int axes2[] = {0, 1, 5};
      const int axes3[] = {0, 1, 2, 3, 4, 5};
      const int* axes = planar ? axes2 : axes3;
      const int count = planar ? 3 : 6;
      for (int r = 0; r < count; ++r)
        for (int c = r; c < count; ++c) {
          fields >> edge.information(axes[r], axes[c]);
          edge.information(axes[c], axes[r]) = edge.information(axes[r], axes[c]);
        }
      if (!fields) throw std::runtime_error(file.string() + ": " + line);
      (std::abs(edge.to - edge.from) == 1 ? graph.odometry : graph.loops).push_back(edge);
    }
  }
  if (!vertices)
    for (const RelativePose& edge : graph.odometry)
      if (edge.to == edge.from + 1)
        graph.T_map_vehicle[static_cast<std::size_t>(edge.to)] =
            graph.T_map_vehicle[static_cast<std::size_t>(edge.from)] * edge.T_from_to;
  return graph;
}

}  // namespace roadbook::test
