#include "workflows/people/truth_scene.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "base/text_file.hpp"
#include "drive/csv.hpp"
#include "drive/drive.hpp"
#include "drive/true_poses.hpp"
#include "mapping/similarity.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

constexpr double kFootSigma_m = 0.1;  ///< assumed for true places, which are exact

struct WorldToMap {
  Similarity T;  ///< p_world = T p_map
  [[nodiscard]] Eigen::Vector2d operator()(const Json& point) const {
    const Eigen::Vector3d p(point.at(0).get<double>(), point.at(1).get<double>(), T.t.z());
    return (T.R.transpose() * (p - T.t) / T.scale).head<2>();
  }
};

WorldToMap align_to(const Map& map, int session, const std::vector<TimedPose>& truth) {
  std::vector<Eigen::Vector3d> world;
  std::vector<Eigen::Vector3d> ours;
  std::size_t next = 0;
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const Keyframe& keyframe = map.keyframes[i];
    if (keyframe.session != session) continue;
    while (next < truth.size() && truth[next].t_ns < keyframe.t_ns) ++next;
    if (next == truth.size() || truth[next].t_ns != keyframe.t_ns) continue;
    world.push_back(truth[next].T_world_vehicle.translation());
    ours.push_back(map.T_map_vehicle(static_cast<int>(i)).translation());
  }
  return {align(world, ours, false)};
}

std::vector<Outline> outlines(const Json& list, const WorldToMap& to_map) {
  std::vector<Outline> result;
  for (const Json& one : list) {
    Outline outline;
    for (const Json& point : one.at("polygon")) outline.push_back(to_map(point));
    result.push_back(std::move(outline));
  }
  return result;
}

// Represents a parked car by the diagonals of its footprint. They hide the same places as its
// sides.
Json car_diagonals(const Json& car) {
  constexpr double kHalfLength = 2.1;
  constexpr double kHalfWidth = 0.85;
  const double heading = car.at("heading").get<double>();
  const Eigen::Vector2d ahead(std::cos(heading), std::sin(heading));
  const Eigen::Vector2d left(-ahead.y(), ahead.x());
  const Eigen::Vector2d centre(car.at("centre").at(0).get<double>(),
                               car.at("centre").at(1).get<double>());
  Json ends = Json::array();
  for (const double side : {-1.0, 1.0})
    for (const double end : {-1.0, 1.0}) {
      const Eigen::Vector2d p = centre + end * (kHalfLength * ahead + side * kHalfWidth * left);
      ends.push_back({p.x(), p.y()});
    }
  return ends;
}

std::vector<SightBlocker> true_blockers(const Json& world, const WorldToMap& to_map) {
  std::vector<SightBlocker> blockers;
  for (const Json& wall : world.at("walls"))
    blockers.push_back({to_map(wall.at("from")), to_map(wall.at("to"))});
  for (const char* kind : {"pillars", "buildings"})
    for (const Outline& outline : outlines(world.at(kind), to_map)) add_sides(outline, blockers);
  for (const Json& car : world.at("parked_cars")) {
    const Json ends = car_diagonals(car);
    blockers.push_back({to_map(ends[0]), to_map(ends[1])});
    blockers.push_back({to_map(ends[2]), to_map(ends[3])});
  }
  return blockers;
}

// Returns the people as the vehicle would report them, relative to the true pose nearest in time.
std::vector<Detection> people_of(const std::filesystem::path& file,
                                 const std::vector<TimedPose>& truth,
                                 const std::vector<SightBlocker>& blockers,
                                 const WorldToMap& to_map,
                                 double range_m) {
  ProblemList problems;
  CsvReader csv(file, CsvHeader::kRequired, problems);
  std::vector<Detection> people;
  std::size_t next = 0;
  while (csv.good() && csv.next()) {
    const auto t = csv.stamp(0);
    const auto x = csv.number(2);
    const auto y = csv.number(3);
    if (!t || !x || !y) continue;
    while (next + 1 < truth.size() && truth[next + 1].t_ns <= *t) ++next;
    const Eigen::Isometry3d& T = truth[next].T_world_vehicle;
    const Eigen::Vector3d p = T.inverse() * Eigen::Vector3d(*x, *y, T.translation().z());
    if (p.head<2>().norm() > range_m) continue;
    const Eigen::Vector2d from = to_map(Json{T.translation().x(), T.translation().y()});
    if (!in_sight(from, to_map(Json{*x, *y}), blockers)) continue;
    people.push_back({truth[next].t_ns, p.x(), p.y(), kFootSigma_m, 1.0});
  }
  if (problems.has_errors()) throw BadInput(problems.problems());
  return people;
}

Json read_world(const std::filesystem::path& drive) {
  const RegularFile file(drive / "truth" / "world.json");
  Json world = file ? Json::parse(file.get(), nullptr, false) : Json();
  if (!world.is_object())
    throw BadInput(Problem{Severity::kError, (drive / "truth").string(), 0, "truth", "none",
                           "the truth of a simulated drive"});
  return world;
}

}  // namespace

std::vector<SightBlocker> read_world_blockers(const std::filesystem::path& drive) {
  try {
    return true_blockers(read_world(drive), WorldToMap{Similarity{}});
  } catch (const Json::exception& error) {
    throw BadInput(Problem{Severity::kError, (drive / "truth" / "world.json").string(), 0, "truth",
                           error.what(), "what `roadbook simulate` writes"});
  }
}

TruthScene read_truth_scene(const Map& map,
                            int session,
                            const std::filesystem::path& drive,
                            double range_m) {
  const auto folder = drive / "truth";
  const std::vector<TimedPose> truth = true_poses(Drive::open(drive));
  const Json world = read_world(drive);
  if (truth.empty())
    throw BadInput(Problem{Severity::kError, folder.string(), 0, "truth", "none",
                           "the truth of a simulated drive"});
  const WorldToMap to_map = align_to(map, session, truth);
  if (!to_map.T.unique)
    throw BadInput(Problem{Severity::kError, drive.string(), 0, "truth",
                           "too few poses at the map's keyframes", "a drive of the map"});
  TruthScene scene;
  scene.sightings.session = map.sessions[static_cast<std::size_t>(session)].name;
  try {
    scene.sightings.blockers = true_blockers(world, to_map);
    scene.spaces = outlines(world.at("spaces"), to_map);
    scene.crossings = outlines(world.at("crossings"), to_map);
  } catch (const Json::exception& error) {
    throw BadInput(Problem{Severity::kError, (folder / "world.json").string(), 0, "truth",
                           error.what(), "what `roadbook simulate` writes"});
  }
  scene.sightings.detections =
      people_of(folder / "pedestrians.csv", truth, scene.sightings.blockers, to_map, range_m);
  return scene;
}

}  // namespace roadbook
