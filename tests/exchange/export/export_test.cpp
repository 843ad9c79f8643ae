#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <numbers>
#include <regex>
#include <sstream>

#include "base/error.hpp"
#include "exchange/export/export_map.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/mapping/store/small_map.hpp"
#include "tests/support/command_output.hpp"

namespace roadbook {
namespace {

using test::Folder;
using test::output_of;
using test::small_map;

std::string read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

TEST(Export, TumWritesOneFileASessionWithEveryDigitOfTheStamp) {
  const Folder folder;
  const Map map = small_map(1);
  MapFileBuilder(folder / "a.gpkg", "key").finish(map, {});
  const auto files = export_map(folder / "a.gpkg", "tum", folder / "poses.tum");
  ASSERT_EQ(files.size(), 2U);
  EXPECT_EQ(files[0].filename(), "poses_drive_0.tum");
  std::size_t k = 0;
  const std::regex line_form(R"(\d+\.\d{9}( -?\d+\.\d{9}){7})");
  for (const auto& file : files) {
    std::istringstream text(read_text(file));
    for (std::string line; std::getline(text, line); ++k) {
      EXPECT_TRUE(std::regex_match(line, line_form)) << line;
      std::istringstream fields(line);
      std::string stamp;
      std::array<double, 7> v{};
      fields >> stamp;
      for (double& x : v) fields >> x;
      stamp.erase(stamp.find('.'), 1);
      EXPECT_EQ(std::stoll(stamp), map.keyframes[k].t_ns);
      const Eigen::Isometry3d T = map.T_map_vehicle(static_cast<int>(k));
      // The file has nine decimals, so the error is half a unit of the last decimal.
      EXPECT_LE((Eigen::Vector3d(v[0], v[1], v[2]) - T.translation()).cwiseAbs().maxCoeff(), 6e-10);
      const Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
      EXPECT_LE((q.toRotationMatrix() - T.linear()).cwiseAbs().maxCoeff(), 1e-8);
    }
  }
  EXPECT_EQ(k, map.keyframes.size());
}

TEST(Export, TumOfOneSessionGoesToTheNameGiven) {
  const Folder folder;
  MapFileBuilder(folder / "a.gpkg", "key").finish(small_map(1, {.sessions = 1}), {});
  const auto files = export_map(folder / "a.gpkg", "tum", folder / "poses.tum");
  EXPECT_EQ(files, std::vector{folder / "poses.tum"});
}

// Converts metres to degrees independently, with the radii of curvature of the WGS84 ellipsoid.
// Within a few metres of the origin, both methods differ by far less than a millimetre.
TEST(Export, GeojsonLiesWhereTheOriginSays) {
  const Folder folder;
  const Map map = small_map(1);
  MapFileBuilder(folder / "a.gpkg", "key").finish(map, {});
  const GeoOrigin origin{.latitude_deg = 48.7, .longitude_deg = 9.1, .x_axis_deg = 30.0};
  export_map(folder / "a.gpkg", "geojson", folder / "a.geojson",
             {.origin = origin, .layers = {"poses"}});
  const auto json = nlohmann::json::parse(read_text(folder / "a.geojson"));
  ASSERT_EQ(json["features"].size(), map.keyframes.size());
  constexpr double kDegree = std::numbers::pi / 180.0;
  constexpr double kA = 6378137.0;
  constexpr double kE2 = 0.00669437999014;
  const double s = std::sin(origin.latitude_deg * kDegree);
  const double meridian = kA * (1.0 - kE2) / std::pow(1.0 - kE2 * s * s, 1.5);
  const double normal = kA / std::sqrt(1.0 - kE2 * s * s);
  const Eigen::Rotation2Dd turn(origin.x_axis_deg * kDegree);
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const Eigen::Vector3d p = map.T_map_vehicle(static_cast<int>(i)).translation();
    const Eigen::Vector2d east_north = turn * p.head<2>();
    const auto& c = json["features"][i]["geometry"]["coordinates"];
    const double north = (c[1].get<double>() - origin.latitude_deg) * kDegree * meridian;
    const double east = (c[0].get<double>() - origin.longitude_deg) * kDegree * normal *
                        std::cos(origin.latitude_deg * kDegree);
    EXPECT_NEAR(east, east_north.x(), 1e-3);
    EXPECT_NEAR(north, east_north.y(), 1e-3);
    EXPECT_NEAR(c[2].get<double>(), p.z(), 1e-4);
  }
  const std::string info = output_of("ogrinfo -so -al " + (folder / "a.geojson").string());
  EXPECT_NE(info.find("Feature Count: 24"), std::string::npos) << info;
  EXPECT_NE(info.find("WGS 84"), std::string::npos) << info;
}

TEST(Export, GeojsonWithoutOriginIsRefusedAndWritesNothing) {
  const Folder folder;
  MapFileBuilder(folder / "a.gpkg", "key").finish(small_map(1), {});
  try {
    export_map(folder / "a.gpkg", "geojson", folder / "a.geojson");
    FAIL() << "metres were written as degrees";
  } catch (const BadInput& bad) {
    EXPECT_EQ(bad.status(), ExitStatus::kBadInput);
    EXPECT_NE(std::string(bad.what()).find("origin: got none"), std::string::npos);
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "a.geojson"));
  // Without an option, the export uses the origin stored in the map.
  MapFileBuilder(folder / "b.gpkg", "key")
      .finish(small_map(1), {{"origin_latitude_deg", "48.7"}, {"origin_longitude_deg", "9.1"}});
  EXPECT_EQ(export_map(folder / "b.gpkg", "geojson", folder / "b.geojson").size(), 1U);
}

TEST(Export, GpkgHoldsTheVectorLayersAndNoPrivateTable) {
  const Folder folder;
  const Map map = small_map(1);
  MapFileBuilder(folder / "a.gpkg", "key").finish(map, {});
  export_map(folder / "a.gpkg", "gpkg", folder / "out.gpkg");
  const std::string info = output_of("ogrinfo -so --config OGR_SQLITE_LIST_ALL_TABLES YES -al " +
                                     (folder / "out.gpkg").string());
  EXPECT_NE(info.find("Layer name: poses"), std::string::npos) << info;
  EXPECT_NE(info.find("Layer name: landmark_points"), std::string::npos) << info;
  EXPECT_EQ(info.find("observations"), std::string::npos) << info;
  const std::string csv = output_of("ogr2ogr -f CSV /vsistdout/ " + (folder / "out.gpkg").string() +
                                    " poses -lco GEOMETRY=AS_XYZ -select keyframe");
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line.substr(0, 5), "X,Y,Z") << csv;
  for (std::size_t i = 0; std::getline(lines, line); ++i) {
    Eigen::Vector3d p;
    ASSERT_EQ(std::sscanf(line.c_str(), "%lf,%lf,%lf", &p.x(), &p.y(), &p.z()), 3) << line;
    EXPECT_LT((p - map.T_map_vehicle(static_cast<int>(i)).translation()).norm(), 1e-6);
  }
}

TEST(Export, GeotiffKeepsPixelsPlaceAndCoordinateSystem) {
  const Folder folder;
  MapFileBuilder(folder / "a.gpkg", "key").finish(small_map(1), {});
  // A raster made by GDAL's own tools: a plane of known values.
  std::ofstream grid(folder / "plane.asc");
  grid << "ncols 600\nnrows 500\nxllcorner -3\nyllcorner 2\ncellsize 0.02\n";
  for (int r = 0; r < 500; ++r) {
    for (int c = 0; c < 600; ++c) grid << (r + c) % 251 << ' ';
    grid << '\n';
  }
  grid.close();
  output_of("gdal_translate -ot Byte " + (folder / "plane.asc").string() + " " +
            (folder / "plane.tif").string());
  MapUpdate update(folder / "a.gpkg");
  update.write_raster("overhead", folder / "plane.tif");
  update.commit();
  EXPECT_EQ(export_map(folder / "a.gpkg", "geotiff", folder / "out.tif").size(), 1U);
  const std::string info = output_of("gdalinfo " + (folder / "out.tif").string());
  EXPECT_NE(info.find("Size is 600, 500"), std::string::npos) << info;
  EXPECT_NE(info.find("roadbook local frame"), std::string::npos) << info;
  EXPECT_NE(info.find("Overviews: 300x250"), std::string::npos) << info;
  EXPECT_NE(info.find("Origin = (-3.0"), std::string::npos) << info;
  const std::string pixel =
      output_of("gdallocationinfo -valonly -b 1 " + (folder / "out.tif").string() + " 123 321");
  EXPECT_EQ(std::stoi(pixel), (123 + 321) % 251);
}

TEST(Export, UnknownFormatsNameTheNearest) {
  const Folder folder;
  MapFileBuilder(folder / "a.gpkg", "key").finish(small_map(1), {});
  try {
    export_map(folder / "a.gpkg", "geojsn", folder / "x");
    FAIL();
  } catch (const InvalidOption& bad) {
    EXPECT_NE(std::string(bad.what()).find("geojson"), std::string::npos);
  }
  EXPECT_THROW(export_map(folder / "a.gpkg", "geotiff", folder / "x"), BadInput);  // no raster
}

TEST(Export, AFolderThatIsNotThereIsAStorageError) {
  const Folder folder;
  MapFileBuilder(folder / "a.gpkg", "key").finish(small_map(1), {});
  EXPECT_THROW(export_map(folder / "a.gpkg", "tum", folder / "missing/x.tum"), StorageError);
  EXPECT_THROW(export_map(folder / "a.gpkg", "gpkg", folder / "missing/x.gpkg"), StorageError);
}

}  // namespace
}  // namespace roadbook
