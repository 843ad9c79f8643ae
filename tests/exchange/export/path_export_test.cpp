#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <sstream>

#include "base/error.hpp"
#include "exchange/export/export_map.hpp"
#include "mapping/store/map_file.hpp"
#include "roadnet/paths/path_frame.hpp"
#include "tests/exchange/driven_place.hpp"
#include "tests/support/command_output.hpp"
#include "tests/support/source_tree.hpp"

// Independent programs read the tables and lines of paths and routes: Python's standard library and
// GDAL.

namespace roadbook {
namespace {

using test::Folder;
using test::output_of;

const GeoOrigin kPathOrigin{47.3769, 8.5417, 30.0};

TEST(PathExport, CsvAndJsonAreTheSamePathForPython) {
  const Folder folder;
  const auto map = test::map_with_paths(folder);
  ExportOptions options;
  options.step_m = 0.2;
  export_map(map, "path", folder / "p.csv", options);
  export_map(map, "path", folder / "p.json", options);
  std::ofstream script(folder / "read.py");
  script << R"(
import csv, json, math, sys
rows = [r for r in csv.reader(l for l in open(sys.argv[1]) if not l.startswith('#'))]
names, rows = rows[0], rows[1:]
assert names == ['lane', 's_m', 'x_m', 'y_m', 'z_m', 'psi_rad', 'kappa_radpm', 'width_m',
                 'speed_limit_mps', 'speed_mps', 'friction', 'friction_sigma'], names
data = json.load(open(sys.argv[2]))
assert data['schema'] == 'roadbook-path/1' and len(data['map_digest']) == 64
assert data['date_utc'].startswith('2014-06-24') and data['sigma_m'] == 0.02
assert 0.9 < data['coverage'] <= 1.0
worst = turn = 0.0
for lane in data['lanes']:
    mine = [[float(v) for v in r[1:8]] for r in rows if r[0] == lane['lane']]
    assert len(mine) == len(lane['s_m'])
    for i, r in enumerate(mine):
        for k, name in enumerate(['s_m', 'x_m', 'y_m', 'z_m', 'psi_rad', 'kappa_radpm']):
            assert abs(r[k] - lane[name][i]) < 1e-6
        assert abs(r[6] - lane['width_m']) < 1e-6
    assert abs(mine[-1][0] - lane['length_m']) < 1e-6
    for a, b in zip(mine, mine[1:]):
        h = b[0] - a[0]
        psi = a[4] + math.remainder(b[4] - a[4], 2 * math.pi) / 2
        worst = max(worst, math.hypot(b[1] - a[1] - h * math.cos(psi), b[2] - a[2] - h * math.sin(psi)))
        turn = max(turn, abs(math.remainder(b[4] - a[4], 2 * math.pi) - h * (a[5] + b[5]) / 2))
print(len(data['lanes']), worst, turn)
)";
  script.close();
  int status = -1;
  const std::string text =
      output_of("python3 " + (folder / "read.py").string() + " " + (folder / "p.csv").string() +
                    " " + (folder / "p.json").string(),
                &status);
  ASSERT_EQ(status, 0) << text;
  std::istringstream in(text);
  std::size_t lanes = 0;
  double worst = 1.0;
  double turn = 1.0;
  in >> lanes >> worst >> turn;
  EXPECT_EQ(lanes, test::DrivenPlace().paths.size());
  // Trapezoids of 0.2 m: change of curvature times h^2 / 12 or h^3 / 24 at up to 0.3 1/m^2.
  EXPECT_LT(worst, 1e-3);
  EXPECT_LT(turn, 2e-3);
}

// A route is one curve from place to place: positions follow from headings, headings from
// curvature, without a jump over the turns.
TEST(PathExport, ARouteIsOneSmoothCurveFromPlaceToPlace) {
  const Folder folder;
  const auto map = test::map_with_paths(folder);
  ExportOptions options;
  options.step_m = 0.1;
  options.route = {Eigen::Vector3d(15.0, 0.2, 0.3), Eigen::Vector3d(90.0, 25.0, 1.8)};
  export_map(map, "path", folder / "r.json", options);
  std::ifstream in(folder / "r.json");
  const auto route = nlohmann::json::parse(in).at("route");
  const auto s = route.at("s_m").get<std::vector<double>>();
  const auto x = route.at("x_m").get<std::vector<double>>();
  const auto y = route.at("y_m").get<std::vector<double>>();
  const auto psi = route.at("psi_rad").get<std::vector<double>>();
  const auto kappa = route.at("kappa_radpm").get<std::vector<double>>();
  EXPECT_LT(std::hypot(x.front() - 15.0, y.front() - 0.2), 0.5);
  EXPECT_LT(std::hypot(x.back() - 90.0, y.back() - 25.0), 0.5);
  for (std::size_t i = 1; i < s.size(); ++i) {
    const double h = s[i] - s[i - 1];
    ASSERT_GT(h, 0.0);
    ASSERT_LT(h, 0.101);
    const double turn = std::remainder(psi[i] - psi[i - 1], 2.0 * std::numbers::pi);
    EXPECT_NEAR(turn, 0.5 * h * (kappa[i] + kappa[i - 1]), 1e-3);
    const double middle = psi[i - 1] + 0.5 * turn;
    EXPECT_LT(
        std::hypot(x[i] - x[i - 1] - h * std::cos(middle), y[i] - y[i - 1] - h * std::sin(middle)),
        1e-4);
    EXPECT_LT(std::abs(kappa[i] - kappa[i - 1]), 0.06) << "at " << s[i];
  }
  // From the lower road to the dead end in the east: by the corner, 20 m + 35 m + 25 m or so.
  EXPECT_NEAR(s.back(), 55.0 + 25.0 + 20.0 - 10.0, 10.0);
  std::set<std::string> lanes;
  for (const auto& lane : route.at("lane")) lanes.insert(lane.get<std::string>());
  EXPECT_GE(lanes.size(), 3U);
}

TEST(PathExport, ARouteThatNeedsReversingOrBeginsNowhereIsRefused) {
  const Folder folder;
  const auto map = test::map_with_paths(folder);
  ExportOptions options;
  options.route = {Eigen::Vector3d(90.0, 25.0, 1.8), Eigen::Vector3d(15.0, 0.2, 0.3)};
  try {
    export_map(map, "path", folder / "r.csv", options);
    FAIL() << "out of a dead end that was only driven into";
  } catch (const Refused& refused) {
    EXPECT_NE(std::string(refused.what()).find("against the way"), std::string::npos)
        << refused.what();
  }
  options.route = {Eigen::Vector3d(500.0, 25.0, 0.0), Eigen::Vector3d(15.0, 0.2, 0.3)};
  EXPECT_THROW(export_map(map, "path", folder / "r.csv", options), InvalidOption);
  EXPECT_FALSE(std::filesystem::exists(folder / "r.csv"));
}

TEST(PathExport, GeojsonHoldsThePathsForGdal) {
  const Folder folder;
  ExportOptions options;
  options.origin = kPathOrigin;
  options.layers = {"lane_paths"};
  export_map(test::map_with_paths(folder), "geojson", folder / "p.geojson", options);
  const std::string info = output_of("ogrinfo -ro -so -al " + (folder / "p.geojson").string());
  const test::DrivenPlace place;
  EXPECT_NE(info.find("Feature Count: " + std::to_string(place.paths.size())), std::string::npos)
      << info;
  EXPECT_NE(info.find("max_curvature: Real"), std::string::npos) << info;
}

TEST(PathExport, WhatIsMissingIsNamedAndNothingWritten) {
  const Folder folder;
  const auto map = test::map_with_paths(folder);
  EXPECT_THROW(export_map(map, "lanelet2", folder / "p.osm"), BadInput);  // no origin
  EXPECT_FALSE(std::filesystem::exists(folder / "p.osm"));
  MapFileBuilder(folder / "bare.gpkg", "key").finish(test::small_map(1), {});
  for (const char* format : {"path", "opendrive", "lanelet2"}) {
    try {
      ExportOptions options;
      options.origin = kPathOrigin;
      export_map(folder / "bare.gpkg", format, folder / "out", options);
      FAIL() << format;
    } catch (const BadInput& bad) {
      EXPECT_NE(std::string(bad.what()).find("roadbook roads"), std::string::npos) << bad.what();
    }
  }
  ExportOptions options;
  options.step_m = 0.0;
  EXPECT_THROW(export_map(map, "path", folder / "p.csv", options), InvalidOption);
}

}  // namespace
}  // namespace roadbook
