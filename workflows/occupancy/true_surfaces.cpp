#include "workflows/occupancy/true_surfaces.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "base/text_file.hpp"
#include "drive/csv.hpp"
#include "drive/drive.hpp"
#include "sim/scenario/scenario.hpp"
#include "sim/world/moved_patches.hpp"
#include "sim/world/world.hpp"
#include "workflows/localisation/world_in_map.hpp"

namespace roadbook {
namespace {

// The world of a simulated drive, built again from what its truth says; empty for a scenario of a
// file, which is not at hand.
std::optional<World> world_of(const std::filesystem::path& drive) {
  const auto folder = drive / "truth";
  if (!std::filesystem::exists(folder / "world.json") ||
      !std::filesystem::exists(folder / "effects.json"))
    return std::nullopt;
  const nlohmann::json truth = nlohmann::json::parse(
      read_regular_file(folder / "world.json", "the truth of a simulated drive"), nullptr, false);
  const nlohmann::json made = nlohmann::json::parse(
      read_regular_file(folder / "effects.json", "the truth of a simulated drive"), nullptr, false);
  if (truth.is_discarded() || made.is_discarded() || !truth.contains("scenario"))
    return std::nullopt;
  const auto name = truth.value("scenario", std::string());
  const auto known = builtin_scenarios();
  if (std::find(known.begin(), known.end(), name) == known.end()) return std::nullopt;
  ScenarioOptions options;
  options.size = truth.value("size", std::string("full"));
  options.visit = truth.value("visit", 0);
  const Scenario scenario = load_scenario(name, options);
  if (scenario.seed != truth.value("seed", std::uint64_t{0})) return std::nullopt;
  EffectSizes effects;
  for (const auto& [effect, size] : made.at("effects").items()) effects[effect] = size;
  return make_world(scenario, {}, 0, {},
                    changed_patches(scenario, effects, made.value("seed", std::uint64_t{1})));
}

}  // namespace

Surfaces surfaces_at_height(const World& world, double height_m) {
  Surfaces surfaces;
  for (const Triangle& triangle : world.mesh.triangles) {
    std::array<Eigen::Vector3d, 3> p;
    Eigen::Vector2d middle = Eigen::Vector2d::Zero();
    for (std::size_t i = 0; i < 3; ++i) {
      p[i] = triangle.corner[i].cast<double>();
      middle += p[i].head<2>() / 3.0;
    }
    const double z = world.ground.height(middle.x(), middle.y()) + height_m;
    std::vector<Eigen::Vector2d> cut;
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d& a = p[i];
      const Eigen::Vector3d& b = p[(i + 1) % 3];
      if ((a.z() < z) == (b.z() < z)) continue;
      cut.emplace_back((a + (z - a.z()) / (b.z() - a.z()) * (b - a)).head<2>());
    }
    if (cut.size() == 2) surfaces.emplace_back(cut[0], cut[1]);
  }
  return surfaces;
}

std::vector<Eigen::Vector2d> places_walked(const std::filesystem::path& drive) {
  const auto file = drive / "truth" / "pedestrians.csv";
  std::vector<Eigen::Vector2d> places;
  if (!std::filesystem::exists(file)) return places;
  ProblemList problems;
  CsvReader csv(file, CsvHeader::kRequired, problems);
  while (csv.good() && csv.next())
    if (const auto x = csv.number(2), y = csv.number(3); x && y) places.emplace_back(*x, *y);
  return places;
}

std::optional<TruePlace> true_place(const std::filesystem::path& map_file,
                                    const Map& map,
                                    const std::vector<std::filesystem::path>& drives) {
  constexpr double kWithoutScanner_m = 0.5;  // within doors, walls and cars
  if (drives.empty()) return std::nullopt;
  const Drive drive = Drive::open(drives.back());
  const auto& model = drive.range_model();
  const auto T_map_world = world_in_map(map_file, map, drive);
  if (!T_map_world) return std::nullopt;
  const auto world = world_of(drive.folder());
  if (!world) return std::nullopt;
  TruePlace place;
  place.surfaces = surfaces_at_height(
      *world, model ? model->T_vehicle_sensor.translation().z() : kWithoutScanner_m);
  place.walked = places_walked(drive.folder());
  const auto to_map = [&](Eigen::Vector2d& p) {
    p = (*T_map_world * Eigen::Vector3d(p.x(), p.y(), 0.0)).head<2>();
  };
  for (auto& [a, b] : place.surfaces) {
    to_map(a);
    to_map(b);
  }
  for (Eigen::Vector2d& p : place.walked) to_map(p);
  return place;
}

}  // namespace roadbook
