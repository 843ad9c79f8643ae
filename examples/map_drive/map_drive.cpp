// Maps a recorded drive with roadbook's library and queries the map.
//
//   map_drive DRIVE MAP.gpkg
//
// Prints where the vehicle was in the middle of the drive, how well that is known, and how many
// landmarks lie around it.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

#include "base/error.hpp"
#include "mapping/map.hpp"
#include "mapping/pipeline/build_map.hpp"
#include "mapping/session_track.hpp"
#include "mapping/store/map_file.hpp"

namespace {

constexpr double kNear_m = 15.0;

// Stages of the build, one line each.
bool print_stage(std::string_view stage, std::size_t done, std::size_t total) {
  if (total > 0 && done == total)
    std::printf("%.*s done\n", static_cast<int>(stage.size()), stage.data());
  return true;  // false would stop the build; the next run continues it
}

int count_landmarks_near(const roadbook::Map& map, const Eigen::Vector3d& position) {
  int near = 0;
  for (const roadbook::Landmark& landmark : map.landmarks)
    if ((map.p_map(landmark) - position).norm() < kNear_m) ++near;
  return near;
}

// Poses in the map frame: x forward along the first pose, y left, z up [m].
int print_middle_of_drive(const std::string& map_file) {
  const roadbook::Map map = roadbook::load_map(map_file);
  const roadbook::Session& session = map.sessions.front();
  const std::int64_t middle_ns = session.t_begin_ns + (session.t_end_ns - session.t_begin_ns) / 2;
  const std::optional<roadbook::TrackPose> pose = roadbook::track_pose(map, 0, middle_ns);
  if (!pose) {
    std::fprintf(stderr, "error: %s: no pose in the middle of session %s\n", map_file.c_str(),
                 session.name.c_str());
    return 4;
  }
  const Eigen::Vector3d position = pose->T_map_vehicle.translation();
  const double sigma_m = std::sqrt(pose->covariance.topLeftCorner<3, 3>().trace());
  std::printf("pose at %lld ns: x %.3f m, y %.3f m, standard deviation %.3f m\n",
              static_cast<long long>(middle_ns), position.x(), position.y(), sigma_m);
  std::printf("landmarks within %.0f m: %d of %zu\n", kNear_m, count_landmarks_near(map, position),
              map.landmarks.size());
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fprintf(stderr, "usage: map_drive DRIVE MAP.gpkg\n");
    return 1;
  }
  try {
    const roadbook::MapSummary summary =
        roadbook::build_map({argv[1]}, argv[2], roadbook::MapOptions{}, print_stage);
    std::printf("%zu keyframes, %zu landmarks, %zu loops accepted\n", summary.keyframes,
                summary.landmarks, summary.loops_accepted);
    return print_middle_of_drive(argv[2]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  }
}
