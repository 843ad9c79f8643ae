#include "sim/truth.hpp"

#include <cmath>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "base/error.hpp"
#include "base/files/disk_space.hpp"
#include "base/text_file.hpp"
#include "sim/streams/friction_stream.hpp"
#include "sim/streams/sensor_streams.hpp"
#include "sim/world/path.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;

Json point(const Eigen::Vector2d& p) { return Json::array({p.x(), p.y()}); }

Json points(const std::vector<Eigen::Vector2d>& line) {
  Json list = Json::array();
  for (const auto& p : line) list.push_back(point(p));
  return list;
}

Json ground_json(const World& world) {
  const GroundSpec& spec = world.scenario.ground;
  Json ground;
  // height(x, y) = plane + slope_away * |distance to the hinge line|
  const double at_origin = world.ground.hinged() && spec.hinge
                               ? world.ground.height(spec.hinge->from.x(), spec.hinge->from.y())
                               : world.ground.height(0.0, 0.0);
  ground["low"] = point(spec.low);
  ground["high"] = point(spec.high);
  ground["height_at_reference"] = at_origin;
  if (spec.hinge) {
    const HingeSpec& h = *spec.hinge;
    ground["hinge"] = {{"from", point(h.from)},
                       {"to", point(h.to)},
                       {"slope_away", h.slope},
                       {"drain_width", h.drain_width_m}};
  }
  if (spec.storeys) {
    const StoreySpec& s = *spec.storeys;
    ground["storeys"] = {{"count", s.count},
                         {"height", s.height_m},
                         {"ramp_from", point(s.ramp_from)},
                         {"ramp_to", point(s.ramp_to)},
                         {"ramp_width", s.ramp_width_m}};
  }
  Json raster;
  const double step = 0.5;
  raster["low"] = point(spec.low);
  raster["step"] = step;
  Json rows = Json::array();
  const bool large = (spec.high - spec.low).prod() > 20000.0;
  for (double y = spec.low.y(); !large && y <= spec.high.y(); y += step) {
    Json row = Json::array();
    for (double x = spec.low.x(); x <= spec.high.x(); x += step)
      row.push_back(std::round(1e4 * world.ground.height(x, y)) / 1e4);
    rows.push_back(row);
  }
  raster["height"] = rows;
  ground["raster"] = raster;
  ground["kind_raster"] = {{"file", "ground_kind.png"},
                           {"low", point(world.paint.kind.low)},
                           {"texel", world.paint.kind.texel_m},
                           {"row_0", "low y"}};
  ground["friction"] = Json::object();
  for (const auto& [name, kind] : {std::pair{"road", SurfaceClass::kRoad},
                                   {"marking", SurfaceClass::kMarking},
                                   {"crossing", SurfaceClass::kCrossing},
                                   {"gravel", SurfaceClass::kGravel},
                                   {"water", SurfaceClass::kWater}})
    ground["friction"][name] = {{"class", static_cast<int>(kind)}, {"friction", friction_of(kind)}};
  return ground;
}

Json world_json(const World& world) {
  const Scenario& scenario = world.scenario;
  Json json;
  // Drives with equal scenario, size and seed share the world frame (drive/true_poses.hpp).
  json["scenario"] = scenario.name;
  json["size"] = scenario.size;
  json["seed"] = scenario.seed;
  json["visit"] = scenario.visit;
  json["frame"] = "world, z up, metres";
  std::vector<bool> occupied(world.layout.spaces.size(), false);
  for (const auto& car : world.layout.cars) occupied[static_cast<std::size_t>(car.space)] = true;
  json["spaces"] = Json::array();
  for (const auto& space : world.layout.spaces)
    json["spaces"].push_back(
        {{"id", space.id},
         {"number", space.number},
         {"row", space.row},
         {"polygon", points(space.corners)},
         {"heading", space.heading},
         {"occupied", static_cast<bool>(occupied[static_cast<std::size_t>(space.id)])}});
  json["parked_cars"] = Json::array();
  for (const auto& car : world.layout.cars)
    json["parked_cars"].push_back(
        {{"space", car.space}, {"centre", point(car.centre)}, {"heading", car.heading}});
  json["moved"] = Json::array();
  json["gone"] = Json::array();
  for (const auto& patch : world.moved)
    if (patch.gone)
      json["gone"].push_back({{"low", point(patch.low)}, {"high", point(patch.high)}});
    else
      json["moved"].push_back(
          {{"low", point(patch.low)}, {"high", point(patch.high)}, {"shift", point(patch.shift)}});
  json["lines"] = Json::array();
  for (const auto& line : world.layout.lines)
    json["lines"].push_back({{"front", point(line.front)},
                             {"back", point(line.back)},
                             {"width", line.width_m},
                             {"column", line.column}});
  json["crossings"] = Json::array();
  for (const auto& c : scenario.crossings)
    json["crossings"].push_back(
        {{"name", c.name}, {"polygon", points(strip(c.from, c.to, c.width_m))}});
  json["lanes"] = Json::array();
  for (const auto& lane : scenario.lanes) {
    const DrivingLine line(lane.points, scenario.vehicle.turn_radius_m, lane.closed);
    json["lanes"].push_back({{"name", lane.name},
                             {"width", lane.width_m},
                             {"closed", lane.closed},
                             {"direction", "first to last"},
                             {"centre", points(line.sampled(0.5))}});
  }
  json["walls"] = Json::array();
  for (const auto& wall : scenario.walls)
    json["walls"].push_back(
        {{"from", point(wall.from)}, {"to", point(wall.to)}, {"height", wall.height_m}});
  json["pillars"] = Json::array();
  json["buildings"] = Json::array();
  for (const auto& block : scenario.blocks)
    json[block.pillar ? "pillars" : "buildings"].push_back(
        {{"polygon", points(rectangle(block.at, block.heading, block.size))},
         {"height", block.height_m}});
  json["ground"] = ground_json(world);
  return json;
}

}  // namespace

void write_truth_folder(const std::filesystem::path& drive,
                        const World& world,
                        const Pedestrians& people,
                        const VehicleMotion& trajectory,
                        const EffectSizes& effects,
                        std::uint64_t seed,
                        double duration_s) {
  const auto folder = drive / "truth";
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    throw StorageError("error: " + folder.string() + ": folder: got " + failed.message() +
                       ", want one to write to");
  write_text(folder / "world.json", world_json(world).dump(1) + "\n");
  Json sizes = Json::object();
  for (const auto& [name, size] : effects) sizes[name] = size;
  write_text(folder / "effects.json", Json{{"seed", seed}, {"effects", sizes}}.dump(1) + "\n");
  std::string rows = "#timestamp [ns],id,x [m],y [m],heading [rad],height [m]\n";
  const std::int64_t start = drive_start_ns(world.scenario.visit);
  const double end = std::min(duration_s, trajectory.duration_s());
  for (std::int64_t k = 0; 0.1 * static_cast<double>(k) <= end; ++k)
    for (std::size_t i = 0; i < people.count(); ++i) {
      const PersonState s = people.at(i, 0.1 * static_cast<double>(k));
      char line[160];
      std::snprintf(line, sizeof line, "%lld,%zu,%.4f,%.4f,%.4f,%.3f\n",
                    static_cast<long long>(start + k * 100'000'000), i, s.x, s.y, s.heading,
                    people.height_m(i));
      rows += line;
    }
  write_text(folder / "pedestrians.csv", rows);
  const auto ground = folder / "ground_kind.png";
  if (!cv::imwrite(ground.string(), world.paint.kind.image))
    throw StorageError("error: " + ground.string() + ": writing: got " + write_fault(ground) +
                       ", want a disk that takes it");
}

}  // namespace roadbook
