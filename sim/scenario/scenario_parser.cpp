#include "sim/scenario/scenario_parser.hpp"

#include <algorithm>

#include "sim/scenario/equal_parts.hpp"

namespace roadbook {
namespace {

const std::vector<std::string> kTextures{"concrete", "brick", "panel", "plaster"};

SurfaceTexture read_texture(const YamlReader& in) {
  const auto texture = in.find("texture");
  return texture ? static_cast<SurfaceTexture>(texture->choice(kTextures))
                 : SurfaceTexture::kConcrete;
}

std::vector<int> read_integers(const YamlReader& in, const std::string& key, int low, int high) {
  std::vector<int> values;
  for (const auto& item : in.items(key)) values.push_back(item.integer(low, high));
  return values;
}

LaneSpec read_lane(const YamlReader& in) {
  in.only({"name", "points", "width", "closed"});
  LaneSpec lane;
  lane.name = in.at("name").text();
  for (const auto& point : in.at("points").items()) lane.points.push_back(point.point());
  if (lane.points.size() < 2) in.at("points").fail("fewer than two points", "two or more");
  lane.width_m = in.number("width", lane.width_m, 2.0, 30.0);
  const auto closed = in.find("closed");
  lane.closed = closed && closed->boolean();
  return lane;
}

SpaceRowSpec read_row(const YamlReader& in) {
  in.only({"name", "from", "to", "count", "depth", "line_width", "wear", "paint", "occupied",
           "first_number", "columns"});
  SpaceRowSpec row;
  row.name = in.at("name").text();
  row.from = in.at("from").point();
  row.to = in.at("to").point();
  row.count = in.at("count").integer(1, 1000);
  row.depth_m = in.number("depth", row.depth_m, 2.0, 20.0);
  row.line_width_m = in.number("line_width", row.line_width_m, 0.02, 0.5);
  row.wear = in.number("wear", row.wear, 0.0, 1.0);
  row.paint = in.number("paint", row.paint, 0.0, 1.0);
  row.occupied = in.number("occupied", row.occupied, 0.0, 1.0);
  row.first_number = in.integer("first_number", 0, 0, 100000);
  row.columns = read_integers(in, "columns", 0, row.count);
  if ((row.to - row.from).norm() < 1.5 * row.count)
    in.at("to").fail(std::to_string((row.to - row.from).norm() / row.count) + " m a space",
                     "at least 1.5 m a space");
  return row;
}

CrossingSpec read_crossing(const YamlReader& in) {
  in.only({"name", "from", "to", "width", "wear", "style"});
  CrossingSpec crossing;
  crossing.name = in.at("name").text();
  crossing.from = in.at("from").point();
  crossing.to = in.at("to").point();
  crossing.width_m = in.number("width", crossing.width_m, 0.5, 10.0);
  crossing.wear = in.number("wear", crossing.wear, 0.0, 1.0);
  const auto style = in.find("style");
  if (style) crossing.style = static_cast<CrossingStyle>(style->choice({"zebra", "hatching"}));
  return crossing;
}

std::vector<BlockSpec> read_block(const YamlReader& in, bool pillar) {
  in.only({"at", "size", "height", "heading", "texture"});
  BlockSpec block;
  block.pillar = pillar;
  block.size = pillar ? Eigen::Vector2d(0.4, 0.4) : Eigen::Vector2d(4.0, 4.0);
  if (const auto size = in.find("size")) block.size = size->point();
  if (block.size.minCoeff() <= 0.0) in.at("size").fail("a size of 0 or less", "sizes above 0");
  block.height_m = in.number("height", block.height_m, 0.1, 200.0);
  block.heading = in.number("heading", 0.0, -10.0, 10.0);
  block.texture = read_texture(in);
  std::vector<BlockSpec> blocks;
  // One place, or a list of places that share everything else.
  const YamlReader at = in.at("at");
  const auto places = at.items();
  if (!places.empty() && places.front().is_list()) {
    for (const auto& place : places) {
      block.at = place.point();
      blocks.push_back(block);
    }
  } else {
    block.at = at.point();
    blocks.push_back(block);
  }
  return blocks;
}

WallSpec read_wall(const YamlReader& in) {
  in.only({"from", "to", "height", "texture", "posters"});
  WallSpec wall;
  wall.from = in.at("from").point();
  wall.to = in.at("to").point();
  if ((wall.to - wall.from).norm() < 0.1) in.at("to").fail("a wall without length", "two points");
  wall.height_m = in.number("height", wall.height_m, 0.1, 100.0);
  wall.texture = read_texture(in);
  wall.posters = in.integer("posters", 0, 0, 1000);
  return wall;
}

GroundSpec read_ground(const YamlReader& in) {
  in.only({"low", "high", "texel", "brightness", "roughness", "cracks_per_are", "stains_per_are",
           "glare", "gravel_edge", "wet_per_are", "hinge", "storeys"});
  GroundSpec ground;
  ground.low = in.at("low").point();
  ground.high = in.at("high").point();
  if ((ground.high - ground.low).minCoeff() < 1.0)
    in.at("high").fail("a ground without area", "a corner at least 1 m beyond 'low'");
  ground.texel_m = in.number("texel", ground.texel_m, 0.004, 0.5);
  const Eigen::Vector2d texels = (ground.high - ground.low) / ground.texel_m;
  if (texels.prod() > 3e8)
    in.at("high").fail("more than 3e8 texels", "a smaller area or larger texel");
  ground.brightness = in.number("brightness", ground.brightness, 0.0, 1.0);
  ground.roughness = in.number("roughness", ground.roughness, 0.0, 3.0);
  ground.cracks_per_are = in.number("cracks_per_are", ground.cracks_per_are, 0.0, 200.0);
  ground.stains_per_are = in.number("stains_per_are", ground.stains_per_are, 0.0, 500.0);
  ground.glare = in.number("glare", ground.glare, 0.0, 1.0);
  ground.gravel_edge_m = in.number("gravel_edge", 0.0, 0.0, 10.0);
  ground.wet_per_are = in.number("wet_per_are", 0.0, 0.0, 50.0);
  if (const auto hinge = in.find("hinge")) {
    hinge->only({"from", "to", "slope", "drain_width"});
    HingeSpec& h = ground.hinge.emplace();
    h.from = hinge->at("from").point();
    h.to = hinge->at("to").point();
    if ((h.to - h.from).norm() < 0.1) hinge->at("to").fail("a line without length", "two points");
    h.slope = hinge->number("slope", 0.0, -0.3, 0.3);
    h.drain_width_m = hinge->number("drain_width", 0.0, 0.0, 2.0);
  }
  if (const auto storeys = in.find("storeys")) {
    if (ground.hinge) storeys->fail("storeys over a hinge", "a ground without 'hinge'");
    ground.storeys = read_storeys(*storeys);
  }
  return ground;
}

CeilingSpec read_ceiling(const YamlReader& in) {
  in.only({"height", "lamp_spacing", "lamp_brightness"});
  CeilingSpec ceiling;
  ceiling.height_m = in.number("height", ceiling.height_m, 2.0, 20.0);
  ceiling.lamp_spacing_m = in.number("lamp_spacing", ceiling.lamp_spacing_m, 1.0, 50.0);
  ceiling.lamp_brightness = in.number("lamp_brightness", ceiling.lamp_brightness, 0.0, 2.0);
  return ceiling;
}

VehicleSpec read_vehicle(const YamlReader& in) {
  in.only({"wheelbase", "track_width", "wheel_radius", "max_speed", "max_acceleration",
           "max_braking", "max_lateral_acceleration", "max_steering", "max_steering_rate",
           "turn_radius", "wander", "distance_scatter", "heading_scatter"});
  VehicleSpec v;
  v.wheelbase_m = in.number("wheelbase", v.wheelbase_m, 1.0, 6.0);
  v.track_width_m = in.number("track_width", v.track_width_m, 0.8, 3.0);
  v.wheel_radius_m = in.number("wheel_radius", v.wheel_radius_m, 0.1, 1.0);
  v.max_speed = in.number("max_speed", v.max_speed, 0.2, 60.0);
  v.max_acceleration = in.number("max_acceleration", v.max_acceleration, 0.1, 10.0);
  v.max_braking = in.number("max_braking", v.max_braking, 0.1, 12.0);
  v.max_lateral_acceleration =
      in.number("max_lateral_acceleration", v.max_lateral_acceleration, 0.1, 10.0);
  v.max_steering = in.number("max_steering", v.max_steering, 0.1, 1.2);
  v.max_steering_rate = in.number("max_steering_rate", v.max_steering_rate, 0.05, 5.0);
  v.turn_radius_m = in.number("turn_radius", v.turn_radius_m, 1.0, 500.0);
  v.wander_m = in.number("wander", v.wander_m, 0.0, 1.0);
  v.distance_scatter_m = in.number("distance_scatter", v.distance_scatter_m, 0.0, 1.0);
  v.heading_scatter_rad = in.number("heading_scatter", v.heading_scatter_rad, 0.0, 1.0);
  return v;
}

CameraSpec read_cameras(const YamlReader& in) {
  in.only({"width", "height", "rate"});
  CameraSpec c;
  c.width = in.integer("width", c.width, 64, 4096);
  c.height = in.integer("height", c.height, 64, 4096);
  c.rate_hz = in.number("rate", c.rate_hz, 0.1, 200.0);
  return c;
}

/// Names under `key`; each must be one of `known`.
template <typename T>
std::vector<std::string> read_names(const YamlReader& in,
                                    const std::string& key,
                                    const std::vector<T>& known) {
  std::vector<std::string> valid;
  for (const auto& item : known) valid.push_back(item.name);
  std::vector<std::string> names;
  for (const auto& item : in.items(key)) names.push_back(valid[item.choice(valid)]);
  return names;
}

void read_moving(const YamlReader& root, Scenario& scenario) {
  for (const auto& in : root.items("pedestrians")) {
    in.only({"crossing", "count", "speed", "visits"});
    std::vector<std::string> known;
    for (const auto& crossing : scenario.crossings) known.push_back(crossing.name);
    PedestrianSpec people;
    people.crossing = known.empty() ? "" : known[in.at("crossing").choice(known)];
    if (known.empty()) in.at("crossing").fail("no crossings", "a crossing to walk on");
    people.count = in.integer("count", 1, 1, 100);
    people.speed = in.number("speed", people.speed, 0.1, 4.0);
    people.visits = read_integers(in, "visits", 0, 1000);
    scenario.pedestrians.push_back(people);
  }
  for (const auto& in : root.items("traffic")) {
    in.only({"route", "speed", "start", "visits"});
    TrafficSpec car;
    car.route = read_names(in, "route", scenario.lanes);
    if (car.route.empty()) in.fail("no route", "'route' with one lane or more");
    car.speed = in.number("speed", car.speed, 0.1, 40.0);
    car.start_m = in.number("start", 0.0, 0.0, 1e5);
    car.visits = read_integers(in, "visits", 0, 1000);
    scenario.traffic.push_back(car);
  }
}

void read_drive(const YamlReader& root, Scenario& scenario) {
  scenario.route = read_names(root, "route", scenario.lanes);
  if (scenario.route.empty()) root.at("route").fail("no lanes", "one lane or more");
  for (const auto& in : root.items("stops")) {
    in.only({"at", "seconds"});
    scenario.stops.push_back({in.at("at").number(0.0, 1e6), in.number("seconds", 1.0, 0.0, 600.0)});
  }
  scenario.laps = root.has("laps") ? read_integers(root, "laps", 1, 1000) : std::vector<int>{1};
  if (scenario.laps.empty()) root.at("laps").fail("no laps", "laps of every visit");
}

}  // namespace

Scenario read_scenario(const YamlReader& root, const std::string& file) {
  root.only({"name",    "seed",   "ground", "ceiling",     "lanes",    "rows",    "crossings",
             "pillars", "blocks", "walls",  "pedestrians", "traffic",  "vehicle", "cameras",
             "route",   "stops",  "laps",   "imu",         "friction", "sizes",   "bays"});
  Scenario scenario;
  scenario.name = root.at("name").text();
  scenario.file = file;
  scenario.seed = static_cast<std::uint64_t>(root.integer("seed", 1, 0, 1'000'000'000));
  scenario.ground = read_ground(root.at("ground"));
  if (const auto ceiling = root.find("ceiling")) scenario.ceiling = read_ceiling(*ceiling);
  for (const auto& item : root.items("lanes")) scenario.lanes.push_back(read_lane(item));
  for (const auto& item : root.items("rows")) scenario.rows.push_back(read_row(item));
  for (const auto& item : root.items("crossings"))
    scenario.crossings.push_back(read_crossing(item));
  for (const std::string key : {"pillars", "blocks"})
    for (const auto& item : root.items(key))
      for (const auto& block : read_block(item, key == "pillars")) scenario.blocks.push_back(block);
  for (const auto& item : root.items("walls")) scenario.walls.push_back(read_wall(item));
  if (const auto storeys = root.at("ground").find("storeys")) require_ceiling(*storeys, scenario);
  if (const auto bays = root.find("bays")) {
    scenario.bays = read_bays(*bays, scenario.ground);
    fill_bays(scenario);
  }
  if (const auto vehicle = root.find("vehicle")) scenario.vehicle = read_vehicle(*vehicle);
  if (const auto cameras = root.find("cameras")) scenario.cameras = read_cameras(*cameras);
  read_drive(root, scenario);
  read_moving(root, scenario);
  if (const auto imu = root.find("imu")) scenario.imu = imu->boolean();
  if (const auto friction = root.find("friction")) scenario.friction = friction->boolean();
  return scenario;
}

}  // namespace roadbook
