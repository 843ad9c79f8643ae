#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>

#include "drive/drive.hpp"
#include "exchange/layers/friction_layers.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/apps/shared_drives.hpp"

namespace roadbook::test {

/// Parses the output of a command that must succeed.
inline nlohmann::json json_of(const CommandResult& result) {
  EXPECT_EQ(result.status, 0) << result.err;
  return nlohmann::json::parse(result.out, nullptr, false);
}

/// A simulated road with class images and friction values, and its map made from the drive's truth.
/// The map equals one that `roadbook map` would make, but takes no minutes to build.
class FrictionPlace {
 public:
  FrictionPlace() {
    simulate("road", 1);
    write_map({"road"});
  }

  void simulate(const std::string& name, int seed) const {
    const auto result = simulate_drive(
        "road --size small --image-scale 0.125 --max-duration-s 12 --class-images --seed " +
            std::to_string(seed),
        path(name));
    EXPECT_EQ(result.status, 0) << result.err;
  }

  /// `moved` gives the new pose after the map is optimised again. As with `roadbook map`, measured
  /// tables stay.
  void write_map(
      const std::vector<std::string>& drives,
      const std::function<Eigen::Isometry3d(const Eigen::Isometry3d&)>& moved = {}) const {
    Map map;
    for (const std::string& name : drives) add_session(map, name, moved);
    MapFinishOptions options;
    options.keep_tables = measured_tables();
    MapFileBuilder(file(), "key " + std::to_string(drives.size())).finish(map, {}, options);
  }

  [[nodiscard]] CommandResult run(const std::string& command) const {
    return run_command(command, folder_.path());
  }
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "place.gpkg"; }
  [[nodiscard]] std::filesystem::path path(const std::string& name) const {
    return folder_.path() / name;
  }
  [[nodiscard]] std::string digest() const { return load_meta(file()).digest; }

 private:
  void add_session(Map& map,
                   const std::string& name,
                   const std::function<Eigen::Isometry3d(const Eigen::Isometry3d&)>& moved) const {
    const Drive drive = Drive::open(folder_.path() / name);
    Session session;
    session.name = session.drive_path = name;
    session.drive_digest = drive.digest();
    session.rig = drive.rig();
    // Sessions are a day apart, although all were simulated for the same time.
    const auto truth = drive.truth();
    double travelled = 0.0;
    std::size_t next = 0;
    Eigen::Vector3d last = truth.front().T_world_vehicle.translation();
    for (std::size_t frame = 0; frame < drive.frame_count(); ++frame) {
      const std::int64_t t_ns = drive.frame_stamp_ns(frame);
      while (next + 1 < truth.size() && truth[next].t_ns < t_ns) ++next;
      const Eigen::Isometry3d& T = truth[next].T_world_vehicle;
      travelled += (T.translation() - last).norm();
      last = T.translation();
      Keyframe keyframe;
      keyframe.session = static_cast<int>(map.sessions.size());
      keyframe.t_ns = t_ns;
      keyframe.drive_frame = static_cast<int>(frame);
      keyframe.map_frame = static_cast<int>(map.map_frames.size());
      keyframe.travelled_m = travelled;
      keyframe.covariance.setZero();  // exact
      map.map_frames.push_back({moved ? moved(T) : T});
      map.keyframes.push_back(keyframe);
      if (frame == 0) session.t_begin_ns = t_ns;
      session.t_end_ns = t_ns;
    }
    map.sessions.push_back(session);
  }

  ScratchFolder folder_;
};

}  // namespace roadbook::test
