#include "mapping/layers/map_layers.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

#include "base/error.hpp"
#include "mapping/layers/map_layers_gdal.hpp"
#include "mapping/layers/stored_vector.hpp"
#include "mapping/store/map_check.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/mapping/store/file_bytes.hpp"
#include "tests/mapping/store/small_map.hpp"
#include "tests/support/command_output.hpp"

namespace roadbook {
namespace {

using test::Folder;
using test::output_of;
using test::small_map;

VectorLayer some_spaces() {
  VectorLayer layer;
  layer.name = "parking_spaces";
  layer.description = "Spaces";
  layer.type = GeometryType::kPolygonZ;
  layer.fields = {{"number", FieldType::kInteger},
                  {"score", FieldType::kReal},
                  {"label", FieldType::kText},
                  {"patch", FieldType::kBytes}};
  for (int i = 0; i < 3; ++i) {
    const double x = 2.5 * i + 0.1;
    Feature f;
    for (const auto& [u, v] : {std::pair{0.0, 0.0}, {2.5, 0.0}, {2.5, 5.0}, {0.0, 5.0}, {0.0, 0.0}})
      f.points.emplace_back(x + u, v, -0.03, 0.0);
    f.values = {std::int64_t{1} << (20 * i + 5), 1.0 / (i + 3), "Nr. " + std::to_string(i),
                Bytes{1, 0, 2}};
    layer.features.push_back(f);
  }
  layer.features[1].values[2] = std::monostate{};
  return layer;
}

TEST(MapLayers, AVectorLayerComesBackAsItWas) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  const VectorLayer layer = some_spaces();
  for (int round = 0; round < 2; ++round) {  // the second replaces the first
    MapUpdate update(path);
    update.write_layer(layer);
    update.note("spaces", "three");
    update.commit();
  }
  EXPECT_TRUE(check_map(path).problems.empty());
  const MapLayers layers(path);
  const VectorLayer back = layers.read_layer("parking_spaces");
  EXPECT_EQ(back.description, layer.description);
  EXPECT_EQ(back.type, layer.type);
  ASSERT_EQ(back.features.size(), layer.features.size());
  for (std::size_t i = 0; i < layer.features.size(); ++i) {
    EXPECT_EQ(back.features[i].points, layer.features[i].points);
    EXPECT_EQ(back.features[i].values, layer.features[i].values);
  }
  EXPECT_EQ(load_map(path).keyframes.size(), small_map(1).keyframes.size());
}

// What another program may have written, with digests that fit.
TEST(MapLayers, GeometriesThatRoadbookDoesNotWriteAreRefused) {
  const Folder folder;
  const SqlDatabase database(folder / "a.gpkg", SqlMode::kCreate);
  database.run(
      "CREATE TABLE gpkg_contents(table_name, description); "
      "CREATE TABLE gpkg_geometry_columns(table_name, column_name, geometry_type_name, z, m); "
      "CREATE TABLE line(fid INTEGER PRIMARY KEY, geom BLOB, width_m REAL); "
      "INSERT INTO gpkg_contents VALUES('line', 'a line'); "
      "INSERT INTO gpkg_geometry_columns VALUES('line', 'geom', 'LINESTRING', 1, 0)");
  const auto refusal = [&](const std::string& geometry) -> std::string {
    database.run("DELETE FROM line; INSERT INTO line VALUES(1, x'" + geometry + "', 2.5)");
    try {
      const Feature line = read_stored_vector(database, "line").features.at(0);
      EXPECT_EQ(line.points.at(0), Eigen::Vector4d(1.0, 2.0, 0.0, 0.0));
      EXPECT_EQ(std::get<double>(line.values.at(0)), 2.5);
    } catch (const BadInput& error) {
      return error.problems().front().got;
    }
    return "";
  };
  const std::string head =
      "47500001"
      "00000000";  // little-endian, no envelope
  const std::string one = "000000000000F03F";
  const std::string two = "0000000000000040";
  const std::string zero = "0000000000000000";
  EXPECT_EQ(refusal(head + "01EA03000001000000" + one + two + zero), "");
  EXPECT_EQ(
      refusal("4750000300000000" + one + one + two + two + "01EA03000001000000" + one + two + zero),
      "")
      << "with an envelope";
  EXPECT_EQ(refusal(head + "01EA03000001000000" + one + two), "33 bytes") << "cut";
  EXPECT_EQ(refusal(head + "01EA030000FFFFFFFF" + one + two + zero), "41 bytes") << "endless";
  EXPECT_EQ(refusal(head + "01EB03000001000000"), "geometry 1003");
  EXPECT_EQ(refusal("47580001"
                    "00000000"),
            "no GeoPackage geometry");
  EXPECT_EQ(refusal("47500000"
                    "00000000"),
            "flags 0")
      << "big-endian";
  EXPECT_EQ(refusal("47"), "1 bytes");
  database.run("UPDATE gpkg_geometry_columns SET geometry_type_name = 'MULTIPOLYGON'");
  EXPECT_THROW((void)read_stored_vector(database, "line"), BadInput);
}

TEST(MapLayers, GisProgramsSeeLayersWithTheirCoordinateSystemAndNothingElse) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  const std::string text = output_of("ogrinfo -so -al " + path.string());
  EXPECT_NE(text.find("Layer name: poses"), std::string::npos) << text;
  EXPECT_NE(text.find("Feature Count: 24"), std::string::npos) << text;
  EXPECT_NE(text.find("roadbook local frame"), std::string::npos) << text;
  EXPECT_NE(text.find("Measured Point"), std::string::npos) << text;
  EXPECT_EQ(text.find("Undefined"), std::string::npos) << text;
  EXPECT_EQ(text.find("observations"), std::string::npos) << text;
  EXPECT_EQ(text.find("ERROR"), std::string::npos) << text;
}

TEST(MapLayers, PoseLayerHoldsThePosesOfTheMap) {
  const Folder folder;
  const Map map = small_map(1);
  MapFileBuilder(folder / "a.gpkg", "key").finish(map, {});
  const VectorLayer poses = MapLayers(folder / "a.gpkg").read_layer("poses");
  const auto t_ns = poses.field("t_ns");
  ASSERT_TRUE(t_ns);
  for (std::size_t i = 0; i < map.keyframes.size(); ++i) {
    const Eigen::Vector3d p = map.T_map_vehicle(static_cast<int>(i)).translation();
    EXPECT_EQ(poses.features[i].points.front().head<3>(), p);
    EXPECT_EQ(std::get<std::int64_t>(poses.features[i].values[*t_ns]), map.keyframes[i].t_ns);
  }
}

TEST(MapLayers, TablesAndRemovalsWork) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  PlainTable table;
  table.name = "detector";
  table.fields = {{"name", FieldType::kText}, {"weights", FieldType::kBytes}};
  table.rows = {{std::string("svm"), Bytes{0, 1, 2}}, {std::string("none"), std::monostate{}}};
  {
    MapUpdate update(path);
    update.write_table(table);
    EXPECT_TRUE(update.remove("landmark_points"));
    EXPECT_FALSE(update.remove("landmark_points"));
    EXPECT_THROW(update.remove("keyframes"), InvalidOption);
    EXPECT_THROW(update.remove("x; DROP TABLE y"), InvalidOption);
    update.commit();
  }
  const MapLayers layers(path);
  EXPECT_EQ(layers.read_table("detector").rows, table.rows);
  EXPECT_FALSE(layers.has("landmark_points"));
  EXPECT_THROW((void)layers.read_layer("pose"), BadInput);
  EXPECT_TRUE(check_map(path).problems.empty());
}

TEST(MapLayers, WithoutCommitNothingChanges) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  const std::string digest = map_digest(path);
  {
    MapUpdate update(path);
    update.write_layer(some_spaces());
  }
  EXPECT_EQ(map_digest(path), digest);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.gpkg.new"));
  EXPECT_FALSE(std::filesystem::exists(folder / "a.gpkg.part"));
}

// A killed process leaves files. The next update removes them.
TEST(MapLayers, AnUpdateRemovesWhatAKilledOneHasLeft) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  const pid_t child = fork();
  if (child == 0) {
    MapUpdate killed(path);
    killed.write_layer(some_spaces());
    _exit(0);
  }
  waitpid(child, nullptr, 0);
  ASSERT_TRUE(std::filesystem::exists(folder / "a.gpkg.part"));
  MapUpdate update(path);
  update.note("next", "change");
  update.commit();
  for (const auto& entry : std::filesystem::directory_iterator(path.parent_path()))
    EXPECT_EQ(entry.path(), path);
}

TEST(MapLayers, AnUpdateKeepsTheCheckpointsOfAnInterruptedBuild) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  MapFileBuilder(path, "next").save("odometry", {{"poses", "1"}});
  MapUpdate(path).commit();
  EXPECT_TRUE(MapFileBuilder(path, "next").has("odometry"));
}

/// A GeoTIFF of a known pattern at 0.05 m a pixel, first corner at (-3, 7).
void write_geotiff(const std::filesystem::path& path, const cv::Mat& pixels) {
  const GdalScope scope;
  const GDALDataType type = pixels.depth() == CV_8U ? GDT_Byte : GDT_Float32;
  GDALDriver* driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  const GdalDataset file(
      driver->Create(path.c_str(), pixels.cols, pixels.rows, pixels.channels(), type, nullptr));
  std::array<double, 6> transform{-3.0, 0.05, 0.0, 7.0, 0.0, -0.05};
  file->SetGeoTransform(transform.data());
  file->SetProjection(map_crs_wkt().c_str());
  ASSERT_EQ(
      file->RasterIO(GF_Write, 0, 0, pixels.cols, pixels.rows, pixels.data, pixels.cols,
                     pixels.rows, type, pixels.channels(), nullptr,
                     static_cast<GSpacing>(pixels.elemSize()), static_cast<GSpacing>(pixels.step),
                     static_cast<GSpacing>(pixels.elemSize1()), nullptr),
      CE_None);
}

TEST(MapLayers, RastersComeBackAsTheyWere) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  cv::Mat grey(700, 900, CV_8UC1);
  cv::Mat colour(300, 400, CV_8UC3);
  cv::Mat variance(520, 610, CV_32FC1);
  for (int r = 0; r < grey.rows; ++r)
    for (int c = 0; c < grey.cols; ++c)
      grey.at<std::uint8_t>(r, c) = static_cast<std::uint8_t>((r * 7 + c * 3) & 255);
  for (int r = 0; r < colour.rows; ++r)
    for (int c = 0; c < colour.cols; ++c)
      colour.at<cv::Vec3b>(r, c) =
          cv::Vec3b(static_cast<std::uint8_t>(r & 255), static_cast<std::uint8_t>(c & 255), 77);
  for (int r = 0; r < variance.rows; ++r)
    for (int c = 0; c < variance.cols; ++c)
      variance.at<float>(r, c) = std::sqrt(static_cast<float>(r * c)) - 3.0F;
  const std::array<std::pair<const char*, cv::Mat>, 3> rasters{
      {{"overhead", grey}, {"overhead_colour", colour}, {"overhead_variance", variance}}};
  for (int round = 0; round < 2; ++round) {
    MapUpdate update(path);
    for (const auto& [name, pixels] : rasters) {
      write_geotiff(folder / "r.tif", pixels);
      update.write_raster(name, folder / "r.tif", {.description = "a raster"});
    }
    update.commit();
  }
  EXPECT_TRUE(check_map(path).problems.empty());
  const MapLayers layers(path);
  EXPECT_EQ(layers.list().size(), 5U);
  for (const auto& [name, pixels] : rasters) {
    SCOPED_TRACE(name);
    const RasterInfo info = layers.raster_info(name);
    EXPECT_EQ(info.width, pixels.cols);
    EXPECT_EQ(info.height, pixels.rows);
    EXPECT_EQ(info.bands, pixels.channels());
    EXPECT_NEAR(info.corner.x(), -3.0, 1e-9);
    EXPECT_NEAR(info.corner.y(), 7.0, 1e-9);
    EXPECT_NEAR(info.resolution_m, 0.05, 1e-12);
    const cv::Rect part(37, 120, 301, 155);
    const cv::Mat window = layers.read_raster(name, {part.x, part.y, part.width, part.height});
    ASSERT_EQ(window.type(), pixels.type());
    EXPECT_EQ(cv::norm(window, pixels(part), cv::NORM_INF), 0.0);
    EXPECT_THROW((void)layers.read_raster(name, {0, 0, pixels.cols + 1, 5}), InvalidOption);
  }
}

// GDAL finds a tile by an index. An index that has lost its entries would turn the tile into no
// data.
TEST(MapLayers, ARasterWhoseIndexLostItsEntriesIsRefused) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  {
    MapUpdate update(path);
    write_geotiff(folder / "r.tif", cv::Mat(700, 900, CV_8UC1, cv::Scalar(9)));
    update.write_raster("strip", folder / "r.tif", {.description = "a raster"});
    update.commit();
  }
  const std::string good = test::read_bytes(path);
  std::vector<std::size_t> index_pages;  // where they begin in the file
  std::size_t page_bytes = 0;
  {
    const SqlDatabase database(path, SqlMode::kRead);
    page_bytes = std::stoul(database.value("PRAGMA page_size"));
    SqlStatement rows = database.prepare(
        "SELECT rootpage FROM sqlite_master WHERE type = 'index' AND tbl_name IN "
        "('strip', 'gpkg_2d_gridded_tile_ancillary', 'gpkg_tile_matrix')");
    while (rows.step())
      index_pages.push_back((static_cast<std::size_t>(rows.integer(0)) - 1) * page_bytes);
  }
  ASSERT_GE(index_pages.size(), 2U);
  int filled = 0;
  for (const std::size_t page : index_pages) {
    std::string bad = good;
    constexpr std::size_t kCells = 3;  // of the page's header: how many entries it has
    if (bad[page + kCells] == 0 && bad[page + kCells + 1] == 0) continue;
    bad[page + kCells] = bad[page + kCells + 1] = 0;
    test::write_bytes(path, bad);
    const auto read = [&] {
      (void)MapLayers(path, VerifiedPart::kWhatIsRead).read_raster("strip", {0, 0, 900, 700});
    };
    EXPECT_THROW(read(), BadInput) << page / page_bytes + 1;
    ++filled;
  }
  EXPECT_GE(filled, 2);
  test::write_bytes(path, good);
  const MapLayers layers(path, VerifiedPart::kWhatIsRead);
  EXPECT_EQ(cv::countNonZero(layers.read_raster("strip", {0, 0, 900, 700}) != 9), 0);
}

TEST(MapLayers, RastersOfAnyShapeGetOverviewsUntilOneTileHoldsThem) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  // Width [px], overviews above tiles of 256 px; whole tiles are where one too many is refused.
  for (const auto& [width, overviews] :
       {std::pair{255, 0}, {256, 0}, {257, 1}, {512, 1}, {513, 2}, {1024, 2}}) {
    SCOPED_TRACE(width);
    const cv::Mat pixels(31, width, CV_8UC1, cv::Scalar(9));
    MapUpdate update(path);
    write_geotiff(folder / "r.tif", pixels);
    update.write_raster("strip", folder / "r.tif", {.description = "a raster"});
    update.commit();
    const std::string text =
        output_of("(gdalinfo -json GPKG:" + path.string() + ":strip 2> /dev/null)");
    const auto info = nlohmann::json::parse(text);
    const auto found = info["bands"][0].value("overviews", nlohmann::json::array());
    EXPECT_EQ(found.size(), static_cast<std::size_t>(overviews));
  }
}

}  // namespace
}  // namespace roadbook
