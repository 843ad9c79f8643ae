#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "exchange/export/export_map.hpp"
#include "exchange/layers/friction_layers.hpp"
#include "exchange/layers/speed_layers.hpp"
#include "tests/exchange/stored_speeds.hpp"
#include "tests/support/command_output.hpp"

// Independent programs read the exported speed and friction maps: Python's standard library and
// GDAL.

namespace roadbook {
namespace {

using test::Folder;
using test::output_of;

// Runs a Python script and returns its output; adds a test failure on an error.
std::string python(const Folder& folder, const std::string& script, const std::string& arguments) {
  std::ofstream(folder / "read.py") << script;
  int status = -1;
  const std::string text =
      output_of("python3 " + (folder / "read.py").string() + " " + arguments, &status);
  EXPECT_EQ(status, 0) << text;
  return text;
}

using test::Stored;

// A vehicle drives straight from one row to the next. For any distance between rows, it is never
// faster than the finest table allows.
TEST(SpeedExport, CoarseTablesPassNoSlowPlaceTooFast) {
  const Stored stored;
  const auto table_of = [&](bool route, double step_m) {
    ExportOptions options;
    if (route) options.route = {Eigen::Vector3d(15.0, 0.2, 0.3), Eigen::Vector3d(90.0, 25.0, 1.8)};
    options.step_m = step_m;
    export_map(stored.map, "path", stored.folder / "t.json", options);
    std::ifstream in(stored.folder / "t.json");
    const auto json = nlohmann::json::parse(in);
    const auto& rows = route ? json.at("route") : json.at("lanes").at(0);
    return std::pair(rows.at("s_m").get<std::vector<double>>(),
                     rows.at("speed_mps").get<std::vector<double>>());
  };
  for (const bool route : {false, true}) {
    const auto [s_fine, v_fine] = table_of(route, 0.25);
    for (const double step_m : {1.0, 5.0, 10.0}) {
      SCOPED_TRACE(::testing::Message() << (route ? "route " : "lane ") << step_m);
      const auto [s, v] = table_of(route, step_m);
      double slack = 0.0;
      for (std::size_t k = 0, i = 0; k < s_fine.size(); ++k) {
        while (i + 2 < s.size() && s[i + 1] < s_fine[k]) ++i;
        const double part = (s_fine[k] - s[i]) / (s[i + 1] - s[i]);
        const double read = v[i] + part * (v[i + 1] - v[i]);
        // The curve of the table passes through its own rows. It differs by a centimetre in
        // position and by a hundredth in speed.
        EXPECT_LE(read, v_fine[k] + 0.02) << s_fine[k];
        slack = std::max(slack, v_fine[k] - read);
      }
      EXPECT_GE(slack, 0.0);
    }
  }
}

TEST(SpeedExport, PathsCarrySpeedAndFrictionForPython) {
  const Stored stored;
  export_map(stored.map, "path", stored.folder / "p.csv");
  export_map(stored.map, "path", stored.folder / "p.json");
  ExportOptions route;
  route.route = {Eigen::Vector3d(15.0, 0.2, 0.3), Eigen::Vector3d(90.0, 25.0, 1.8)};
  route.step_m = 0.4;
  export_map(stored.map, "path", stored.folder / "r.json", route);
  const std::string text =
      python(stored.folder, R"(
import csv, json, math, sys
rows = [r for r in csv.DictReader(l for l in open(sys.argv[1]) if not l.startswith('#'))]
head = open(sys.argv[1]).readline()
assert 'speed_date 2020-09-13' in head and 'friction_date 2020-09-13' in head, head
data = json.load(open(sys.argv[2]))
assert 'friction_coverage 1.0' in head and 'speed_coverage 0.' in head, head
assert data['friction_coverage'] == 1.0 and data['friction_date_utc'].startswith('2020-09-13')
assert data['speed_date_utc'].startswith('2020-09-13') and 0.4 < data['speed_coverage'] < 0.6
i = 0
for lane in data['lanes']:
    for k, v in enumerate(lane['speed_mps']):
        r = rows[i]; i += 1
        assert abs(float(r['speed_mps']) - v) < 1e-6 and 0 < v <= float(r['speed_limit_mps']) == 9.0
        assert 0.3 < float(r['friction']) < 1.0 and 0 < float(r['friction_sigma']) < 0.3
def demand(s, v):
    worst = 0.0
    for a, b, p, q in zip(s, s[1:], v, v[1:]):
        worst = max(worst, abs(q * q - p * p) / (2 * (b - a)))
    return worst
r = json.load(open(sys.argv[3]))['route']
print(max(demand(l['s_m'], l['speed_mps']) for l in data['lanes']), demand(r['s_m'], r['speed_mps']),
      max(v * v * abs(k) for v, k in zip(r['speed_mps'], r['kappa_radpm'])), len(rows) - i)
)",
             (stored.folder / "p.csv").string() + " " + (stored.folder / "p.json").string() + " " +
                 (stored.folder / "r.json").string());
  std::istringstream in(text);
  double along_lane = 9.0, along_route = 9.0, across = 9.0;
  int left_over = -1;
  in >> along_lane >> along_route >> across >> left_over;
  // Rows lie between the points of the profile. There, the speed is interpolated linearly, not its
  // square.
  EXPECT_LT(along_lane, 1.5 * 1.1) << text;
  EXPECT_LT(along_route, 1.5 * 1.1) << text;
  EXPECT_LT(across, 1.5 * 1.01) << text;
  EXPECT_EQ(left_over, 0);
}

// A turn overlaps two lanes. On the ground of the slower lane, the limit of that lane applies.
TEST(SpeedExport, ARouteKeepsTheLimitsOfBothLanesOfATurn) {
  Stored stored;
  ExportOptions route;
  route.route = {Eigen::Vector3d(15.0, 0.2, 0.3), Eigen::Vector3d(90.0, 25.0, 1.8)};
  route.step_m = 0.4;
  const auto rows_of = [&] {
    export_map(stored.map, "path", stored.folder / "r.json", route);
    std::ifstream in(stored.folder / "r.json");
    return nlohmann::json::parse(in).at("route");
  };
  const auto last = std::stoull(rows_of().at("lane").back().get<std::string>());
  const PathCurve* entered = nullptr;
  std::vector<PathCurve> curves;
  for (const LanePath& path : stored.place.paths) curves.emplace_back(path.path);
  for (std::size_t i = 0; i < curves.size(); ++i)
    if (stored.place.paths[i].lane == last) entered = &curves[i];
  ASSERT_NE(entered, nullptr);
  for (LaneProfile& lane : stored.speeds.profiles)
    if (lane.lane == last)
      for (LaneSpeed& at : lane.places) at.limit = at.speed = 2.0;
  MapUpdate update(stored.map);
  write_speed_layers(update, stored.speeds);
  update.commit();
  const auto away = [](const PathCurve& curve, const Eigen::Vector2d& p) {
    double least = INFINITY;
    for (double s = 0.0; s < curve.length_m(); s += 0.1)
      least = std::min(least, (curve.at(s).position - p).norm());
    return least;
  };
  const auto rows = rows_of();
  int on_turn = 0;
  for (std::size_t i = 0; i < rows.at("s_m").size(); ++i) {
    const Eigen::Vector2d p(rows.at("x_m")[i], rows.at("y_m")[i]);
    bool alone = away(*entered, p) < 0.5;
    for (const PathCurve& other : curves)
      alone = alone && (&other == entered || away(other, p) > 1.0);
    if (!alone) continue;
    EXPECT_LE(rows.at("speed_mps")[i].get<double>(), 2.0 + 1e-6) << rows.at("s_m")[i];
    EXPECT_LE(rows.at("speed_limit_mps")[i].get<double>(), 2.0) << rows.at("s_m")[i];
    on_turn += rows.at("lane")[i].get<std::string>() != std::to_string(last) ? 1 : 0;
  }
  EXPECT_GT(on_turn, 3) << "rows of the turn on the ground of the lane entered";
}

TEST(SpeedExport, ASliceOfALaneIsTheMapForPython) {
  const Stored stored;
  ExportOptions options;
  options.lane = std::to_string(stored.place.paths.front().lane);
  const auto files = export_map(stored.map, "spm", stored.folder / "s.json", options);
  ASSERT_EQ(files.size(), 1U);
  // Python's own interpolation: equations (6) and (7).
  const std::string text = python(stored.folder, R"(
import json, math, sys
d = json.load(open(sys.argv[1]))
assert d['property'] == 'friction' and len(d['digest']) == 64, list(d)
assert d['date_ns'] == 1600000000000000000 and 0 < d['coverage'] <= 1 and len(d['map']) > 64
assert d['columns'][:4] == ['s_m', 'e_m', 'mean', 'variance']
def k(r):
    t = 2 * math.pi * (1 - r)
    return 0.0 if r >= 1 else (t * (2 + math.cos(t)) - 3 * math.sin(t)) / (6 * math.pi)
def mean(s, e):
    top = bottom = 0.0
    for n in d['knots']:
        v = k(math.hypot((s - n[0]) / d['width_s_m'], (e - n[1]) / d['width_e_m']))
        top += v * n[2]; bottom += v
    return top / bottom
print(mean(7.25, 0.5), mean(12.0, -1.0), len(d['knots']))
)",
                                  files.front().string());
  std::istringstream in(text);
  double a = 0.0, b = 0.0;
  in >> a >> b;
  const double begin = stored.friction.strips.find(stored.place.paths.front().lane)->begin_m;
  EXPECT_NEAR(a, stored.friction.map.moments(0, {begin + 7.25, 0.5})->mean, 1e-9) << text;
  EXPECT_NEAR(b, stored.friction.map.moments(0, {begin + 12.0, -1.0})->mean, 1e-9) << text;
  options.lane = "nowhere";
  EXPECT_THROW(export_map(stored.map, "spm", stored.folder / "s.json", options), InvalidOption);
}

TEST(SpeedExport, RastersLieInTheMapFrameForGdal) {
  const Stored stored;
  for (const char* name : {"speed_map", "speed_colours", "friction_mean", "friction_colours"}) {
    ExportOptions options;
    options.layers = {name};
    const auto file = stored.folder / (std::string(name) + ".tif");
    export_map(stored.map, "geotiff", file, options);
    const std::string info = output_of("gdalinfo " + file.string());
    EXPECT_NE(info.find("ENGCRS[\"roadbook"), std::string::npos) << info;
    EXPECT_NE(info.find(std::string(name) == "speed_map"
                            ? "Description = recommended speed [m/s]"
                            : (std::string(name) == "friction_mean" ? "Description = friction of"
                                                                    : "Description = Red")),
              std::string::npos)
        << info;
    if (std::string(name).ends_with("colours")) {
      EXPECT_NE(info.find("ColorInterp=Alpha"), std::string::npos) << info;
    }
  }
  // GDAL must return the value of the cell at its place.
  const SpeedCell& cell = stored.speeds.cells[stored.speeds.cells.size() / 2];
  std::ostringstream command;
  command << "gdallocationinfo -valonly -geoloc " << (stored.folder / "speed_map.tif").string()
          << " " << cell.centre.x() << " " << cell.centre.y();
  EXPECT_NEAR(std::stod(output_of(command.str())), cell.speed, 1e-5);
}

TEST(SpeedExport, AMapWithoutThemSaysWhatToRun) {
  const Folder folder;
  const auto map = test::map_with_paths(folder);
  export_map(map, "path", folder / "p.json");
  std::ifstream in(folder / "p.json");
  const auto json = nlohmann::json::parse(in);
  EXPECT_TRUE(json.at("friction_date_utc").is_null());
  EXPECT_TRUE(json.at("speed_date_utc").is_null());
  EXPECT_EQ(json.at("friction_coverage"), 0.0);
  ExportOptions nowhere;
  nowhere.route = {Eigen::Vector3d(15.0, 0.2, 0.3), Eigen::Vector3d(15.0, 0.2, 0.3)};
  try {
    export_map(map, "path", folder / "r.json", nowhere);
    FAIL();
  } catch (const InvalidOption& error) {
    EXPECT_NE(std::string(error.what()).find("--to: got the place of --from"), std::string::npos)
        << error.what();
  }
  try {
    export_map(map, "spm", folder / "x");
    FAIL();
  } catch (const BadInput& error) {
    EXPECT_NE(std::string(error.what()).find("roadbook friction"), std::string::npos)
        << error.what();
  }
}

}  // namespace
}  // namespace roadbook
