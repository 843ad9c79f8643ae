#include "exchange/layers/occupancy_layers.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>

#include "base/error.hpp"
#include "base/text_file.hpp"
#include "exchange/export/export_map.hpp"
#include "exchange/export/nav2/nav2_occupancy.hpp"
#include "exchange/layers/packed_numbers.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/mapping/occupancy/hall_scans.hpp"
#include "tests/mapping/store/small_map.hpp"

// The occupancy grid stored, read back and exported.

namespace roadbook {
namespace {

using test::Folder;

struct StoredHall {
  Folder folder;
  std::filesystem::path map = folder / "hall.gpkg";
  StoredOccupancy stored;
  OccupancyGrid grid;

  StoredHall() {
    const auto drive = test::hall_drive(1, {0.02, 0.02, 0.01, 0.5});
    const RangeMixture mixture = mixture_of({0.02, 0.02, 0.01, 0.5}, 0.03);
    stored.surfaces_per_m = 0.2;
    stored.prior = 0.05;
    const InverseRangeModel inverse(mixture, test::kHallMax_m,
                                    {.cell_m = 0.1, .surfaces_per_m = 0.2});
    stored.patches =
        build_patches(drive.scans, drive.anchor_of, drive.anchors, "hall", inverse, {}).patches;
    OccupancyDrive one;
    one.drive = "hall";
    one.digest = "0123";
    one.sensor = "range0";
    one.model = "fitted";
    one.scans = 120;
    one.max_m = test::kHallMax_m;
    one.temper = 0.25;
    one.mixture = mixture;
    stored.drives.push_back(one);
    grid = place_patches(
        stored.patches,
        [&](const std::string&, std::int64_t t) -> std::optional<PlanePose> {
          for (const PatchAnchor& anchor : drive.anchors)
            if (anchor.t_ns == t) return anchor.map_vehicle;
          return std::nullopt;
        },
        stored.reading_weights());
    MapFileBuilder(map, "key").finish(test::small_map(1), {});
    MapUpdate update(map);
    write_occupancy_layers(update, stored, grid);
    update.commit();
  }
};

TEST(OccupancyLayers, PatchesReadBackToTheSameNumbers) {
  const StoredHall hall;
  const auto read = read_occupancy_layers(MapLayers(hall.map));
  ASSERT_TRUE(read);
  EXPECT_EQ(read->surfaces_per_m, 0.2);
  ASSERT_EQ(read->drives.size(), 1U);
  EXPECT_EQ(read->drives[0].temper, 0.25);
  EXPECT_EQ(read->drives[0].mixture.share[kShort], 0.02);
  ASSERT_EQ(read->patches.size(), hall.stored.patches.size());
  for (std::size_t i = 0; i < read->patches.size(); ++i) {
    const OccupancyPatch& a = read->patches[i];
    const OccupancyPatch& b = hall.stored.patches[i];
    EXPECT_EQ(a.log_odds, b.log_odds);
    EXPECT_EQ(a.seen, b.seen);
    EXPECT_EQ(a.hits, b.hits);
    EXPECT_EQ(a.ends, b.ends);
    EXPECT_EQ(a.vehicle_patch.x_m, b.vehicle_patch.x_m);
    EXPECT_EQ(a.placed.y_m, b.placed.y_m);
    EXPECT_EQ(a.t_ns, b.t_ns);
  }
}

// Maps of earlier versions do not have column `ends`: surfaces lie in the middles of cells then.
TEST(OccupancyLayers, GridsWithoutEndsAreRead) {
  const StoredHall hall;
  MapLayers layers(hall.map);
  PlainTable table = layers.read_table("occupancy_patches");
  ASSERT_EQ(table.fields.back().name, "ends");
  table.fields.pop_back();
  for (auto& row : table.rows) row.pop_back();
  MapUpdate update(hall.map);
  update.write_table(table);
  update.commit();
  const auto read = read_occupancy_layers(MapLayers(hall.map));
  ASSERT_TRUE(read);
  const OccupancyPatch& patch = read->patches[0];
  EXPECT_EQ(patch.hits, hall.stored.patches[0].hits);
  EXPECT_TRUE(patch.ends.empty());
  EXPECT_EQ(patch.end_in(3, 2, 7), Eigen::Vector2d(3.5, 2.5));
  // Written by this version beside a patch with ends, it is read again.
  StoredOccupancy both = *read;
  both.patches.push_back(hall.stored.patches[1]);
  MapUpdate again(hall.map);
  write_occupancy_layers(again, both, hall.grid);
  again.commit();
  const auto mixed = read_occupancy_layers(MapLayers(hall.map));
  ASSERT_TRUE(mixed);
  EXPECT_EQ(mixed->patches[0].end_in(3, 2, 7), Eigen::Vector2d(3.5, 2.5));
  EXPECT_EQ(mixed->patches.back().ends, hall.stored.patches[1].ends);
}

TEST(OccupancyLayers, FewSightsOfCamerasCountAndFewRaysDoNot) {
  StoredOccupancy stored;
  stored.drives.resize(2);
  stored.drives[0].drive = "by cameras";
  stored.drives[0].sensor = "cameras";
  stored.drives[0].temper = 0.5;
  stored.drives[1].drive = "by scanner";
  stored.drives[1].sensor = "range0";
  const auto weights = stored.reading_weights();
  EXPECT_TRUE(weights.at("by cameras").few_count);
  EXPECT_EQ(weights.at("by cameras").temper, 0.5);
  EXPECT_FALSE(weights.at("by scanner").few_count);
}

TEST(OccupancyLayers, RastersHoldTheGridAndNothingWhereNoReadingCame) {
  const StoredHall hall;
  const MapLayers layers(hall.map);
  const RasterInfo info = layers.raster_info("occupancy");
  ASSERT_EQ(info.width, hall.grid.shape.columns);
  ASSERT_EQ(info.height, hall.grid.shape.rows);
  EXPECT_NEAR(info.corner.x(), hall.grid.shape.low.x(), 1e-9);
  const RasterWindow all{0, 0, info.width, info.height};
  const cv::Mat p = layers.read_raster("occupancy", all);
  const cv::Mat readings = layers.read_raster("occupancy_coverage", all);
  const cv::Mat drives = layers.read_raster("occupancy_sessions", all);
  std::size_t unknown = 0;
  for (int r = 0; r < info.height; ++r)
    for (int c = 0; c < info.width; ++c) {
      const std::size_t cell = hall.grid.shape.index(c, info.height - 1 - r);
      if (hall.grid.seen[cell] == 0) {
        EXPECT_EQ(p.at<float>(r, c), -9999.0F);
        ++unknown;
        continue;
      }
      ASSERT_NEAR(static_cast<double>(p.at<float>(r, c)),
                  hall.grid.probability(cell, hall.stored.prior_log_odds()), 1e-6);
      ASSERT_EQ(readings.at<float>(r, c), static_cast<float>(hall.grid.seen[cell]));
      ASSERT_EQ(drives.at<float>(r, c), 1.0F);
    }
  EXPECT_GT(unknown, 1000U);
}

TEST(OccupancyLayers, DamagedPatchesAreRefused) {
  Bytes packed = packed_numbers<std::int16_t>({1, -2, 300});
  EXPECT_EQ(*unpacked_numbers<std::int16_t>(packed, 3), (std::vector<std::int16_t>{1, -2, 300}));
  EXPECT_FALSE(unpacked_numbers<std::int16_t>(packed, 4));
  EXPECT_FALSE(unpacked_numbers<std::int16_t>(packed, 2));
  packed[packed.size() / 2] ^= 0x40U;
  EXPECT_FALSE(unpacked_numbers<std::int16_t>(packed, 3));
  const StoredHall hall;
  const PlainTable good = MapLayers(hall.map).read_table("occupancy_patches");
  const auto expect_refused = [&](const std::string& column, const FieldValue& value) {
    PlainTable table = good;
    for (std::size_t f = 0; f < table.fields.size(); ++f)
      if (table.fields[f].name == column) table.rows[0][f] = value;
    MapUpdate update(hall.map);
    update.write_table(table);
    update.commit();
    EXPECT_THROW((void)read_occupancy_layers(MapLayers(hall.map)), BadInput) << column;
  };
  expect_refused("rows", std::int64_t{7});
  expect_refused("ends", packed);
}

// What nav2_map_server makes of a grey value: loadMapFromFile in nav2_map_server/src/map_io.cpp
// (ros-navigation/navigation2). -1 is unknown. `opacity` below 255 is unknown in both modes.
int map_server_cell(int grey, int opacity, bool scale, double free_thresh, double occupied_thresh) {
  const float occupancy = 1.0F - static_cast<float>(grey) / 255.0F;
  if (opacity < 255) return -1;
  if (static_cast<double>(occupancy) <= free_thresh) return 0;
  if (static_cast<double>(occupancy) >= occupied_thresh) return 100;
  if (!scale) return -1;
  return static_cast<int>(std::round((occupancy - static_cast<float>(free_thresh)) /
                                     static_cast<float>(occupied_thresh - free_thresh) * 100.0F));
}

double yaml_number(const std::string& text, const std::string& key) {
  const auto at = text.find("\n" + key + ": ");
  EXPECT_NE(at, std::string::npos) << key << "\n" << text;
  return std::stod(text.substr(at + key.size() + 3));
}

TEST(Nav2Occupancy, GreyOfUnknownCellsIsUnknownWithTheThresholdsWrittenAndFreeWithTheCommonOnes) {
  EXPECT_EQ(map_server_cell(trinary_pixel(NAN, NAN), 255, false, 0.196, 0.65), -1);
  EXPECT_EQ(map_server_cell(trinary_pixel(0.4F, 0.0F), 255, false, 0.196, 0.65), -1);
  EXPECT_EQ(map_server_cell(trinary_pixel(0.1F, 0.01F), 255, false, 0.196, 0.65), 0);
  EXPECT_EQ(map_server_cell(trinary_pixel(0.1F, 0.05F), 255, false, 0.196, 0.65), -1);
  EXPECT_EQ(map_server_cell(trinary_pixel(0.9F, 0.1F), 255, false, 0.196, 0.65), 100);
  EXPECT_EQ(map_server_cell(trinary_pixel(NAN, NAN), 255, false, 0.25, 0.65), 0);
}

TEST(Nav2Occupancy, MapServerReadsTheGridThatTheMapHolds) {
  const StoredHall hall;
  ExportOptions options;
  options.layers = {"occupancy"};
  const auto files = export_map(hall.map, "nav2", hall.folder / "free.pgm", options);
  ASSERT_EQ(files.size(), 4U);
  const double prior = hall.stored.prior_log_odds();
  for (const bool scale : {false, true}) {
    const std::string stem = scale ? "free_scale" : "free";
    const std::string yaml = read_regular_file(hall.folder / (stem + ".yaml"), "a YAML file");
    EXPECT_NE(yaml.find(scale ? "mode: scale" : "mode: trinary"), std::string::npos);
    const double free_thresh = yaml_number(yaml, "free_thresh");
    const double occupied_thresh = yaml_number(yaml, "occupied_thresh");
    const cv::Mat image = cv::imread((hall.folder / (stem + (scale ? ".png" : ".pgm"))).string(),
                                     cv::IMREAD_UNCHANGED);
    ASSERT_EQ(image.rows, hall.grid.shape.rows);
    ASSERT_EQ(image.cols, hall.grid.shape.columns);
    std::size_t known = 0;
    for (int r = 0; r < image.rows; ++r)
      for (int c = 0; c < image.cols; ++c) {
        // The first row of the image is the top.
        const std::size_t cell = hall.grid.shape.index(c, image.rows - 1 - r);
        const int grey = scale ? image.at<cv::Vec4b>(r, c)[0] : image.at<std::uint8_t>(r, c);
        const int opacity = scale ? image.at<cv::Vec4b>(r, c)[3] : 255;
        const int read = map_server_cell(grey, opacity, scale, free_thresh, occupied_thresh);
        if (hall.grid.seen[cell] == 0) {
          ASSERT_EQ(read, -1);
          continue;
        }
        ++known;
        const double p = hall.grid.probability(cell, prior);
        // In per cent: half a grey value, and rounding to a whole per cent.
        if (scale) {
          ASSERT_NEAR(read, 100.0 * p, 0.75);
          continue;
        }
        const double above = p + 2.0 * hall.grid.sigma(cell, prior);
        const bool rounded = std::abs(above - 0.196) < 1e-5 || std::abs(p - 0.65) < 1e-5;
        ASSERT_TRUE(rounded || read == (above < 0.196 ? 0 : p >= 0.65 ? 100 : -1)) << p;
      }
    EXPECT_GT(known, 5000U);
  }
}

TEST(Nav2Occupancy, AMapWithoutAGridNamesTheVerbThatMakesOne) {
  const Folder folder;
  MapFileBuilder(folder / "empty.gpkg", "key").finish(test::small_map(1), {});
  ExportOptions options;
  options.layers = {"occupancy"};
  try {
    (void)export_map(folder / "empty.gpkg", "nav2", folder / "free.pgm", options);
    FAIL();
  } catch (const BadInput& fault) {
    EXPECT_NE(fault.problems().front().want.find("roadbook occupancy"), std::string::npos);
  }
  options.layers = {"overhead"};
  EXPECT_THROW((void)export_map(folder / "empty.gpkg", "nav2", folder / "free.pgm", options),
               InvalidOption);
}

}  // namespace
}  // namespace roadbook
