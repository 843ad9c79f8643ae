#include "semantics/overhead/overhead_layers.hpp"

#include <gtest/gtest.h>

#include "mapping/layers/map_layers.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/mapping/store/small_map.hpp"
#include "tests/semantics/overhead_scene.hpp"

namespace roadbook {
namespace {

/// Four views of painted lines, two in each session of a map, and the overhead image made from
/// them.
class OverheadLayers : public ::testing::Test {
 protected:
  void SetUp() override {
    map_ = test::small_map(3);
    MapFileBuilder(file_, "test").finish(map_, {});
    static const OverheadInput scene = test::drive_over({.grey = test::lines}, 4, 1.0);
    input_ = scene;
    for (std::size_t i = 0; i < input_.views.size(); ++i) input_.views[i].session = i < 2 ? 0 : 1;
    options_.max_range_m = 5.0;
    options_.resolution_m = 0.05;
    made_ = make_overhead(input_, folder_ / "images", options_);
  }
  void store() {
    MapUpdate update(file_);
    store_overhead(map_, made_, &update);
    update.commit();
  }

  const test::Folder folder_;
  const std::filesystem::path file_ = folder_ / "place.gpkg";
  Map map_;
  OverheadInput input_;
  OverheadOptions options_;
  OverheadSummary made_;
};

TEST_F(OverheadLayers, HoldTheImagesPixelByPixelInTheirPlace) {
  store();
  const MapLayers layers(file_);
  const RasterInfo info = layers.raster_info("overhead");
  EXPECT_NEAR(info.corner.x(), made_.west_m, 1e-9);
  EXPECT_NEAR(info.corner.y(), made_.north_m, 1e-9);
  EXPECT_NEAR(info.resolution_m, made_.resolution_m, 1e-12);
  for (const auto& [name, path] : {std::pair{"overhead", made_.image},
                                   {"overhead_count", made_.count},
                                   {"overhead_variance", made_.variance}}) {
    SCOPED_TRACE(name);
    cv::Mat_<double> stored;
    layers.read_raster(name, {0, 0, made_.columns, made_.rows}).convertTo(stored, CV_64F);
    EXPECT_EQ(cv::norm(stored, test::read_band(path), cv::NORM_INF), 0.0);
  }
}

TEST_F(OverheadLayers, NameTheFramesOfEverySessionAndBlock) {
  store();
  const MapLayers layers(file_);
  const PlainTable sources = layers.read_table("overhead_sources");
  ASSERT_EQ(sources.rows.size(), 2U);
  for (std::size_t s = 0; s < 2; ++s) {
    const auto& row = sources.rows[s];
    EXPECT_EQ(std::get<std::int64_t>(row[0]), static_cast<std::int64_t>(s));
    EXPECT_EQ(std::get<std::string>(row[1]), map_.sessions[s].name);
    EXPECT_EQ(std::get<std::int64_t>(row[2]), 2);
    // Views are one second apart, starting in 1970.
    EXPECT_EQ(std::get<std::string>(row[3]),
              utc_text(static_cast<std::int64_t>(2 * s) * 1'000'000'000));
    EXPECT_EQ(std::get<std::string>(row[4]),
              utc_text(static_cast<std::int64_t>(2 * s + 1) * 1'000'000'000));
  }
  EXPECT_EQ(layers.read_table("overhead_frames").rows.size(), 4U);
  const PlainTable blocks = layers.read_table("overhead_blocks");
  ASSERT_EQ(blocks.rows.size(), made_.blocks.size());
  EXPECT_EQ(std::get<std::string>(blocks.rows[0][2]), made_.blocks[0].frames);
}

TEST_F(OverheadLayers, AreReplacedByALaterImageAndLeaveTheMapAsItWas) {
  store();
  input_.views.resize(2);
  made_ = make_overhead(input_, folder_ / "later", options_);
  store();
  const MapLayers layers(file_);
  EXPECT_EQ(layers.read_table("overhead_sources").rows.size(), 1U);
  EXPECT_EQ(layers.read_table("overhead_frames").rows.size(), 2U);
  EXPECT_EQ(layers.raster_info("overhead").width, made_.columns);
  const Map read = load_map(file_);
  EXPECT_EQ(read.keyframes.size(), map_.keyframes.size());
  EXPECT_EQ(read.sessions[1].drive_digest, map_.sessions[1].drive_digest);
}

}  // namespace
}  // namespace roadbook
