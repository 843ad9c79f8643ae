#include "exchange/layers/path_layers.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "mapping/store/map_check.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "roadnet/build_network.hpp"
#include "roadnet/paths/path_curve.hpp"
#include "tests/exchange/driven_place.hpp"
#include "tests/mapping/store/small_map.hpp"

namespace roadbook {
namespace {

using test::Folder;

TEST(PathLayers, ComeBackBitForBitAndTheMapStaysSound) {
  const Folder folder;
  const auto path = test::map_with_paths(folder);
  EXPECT_TRUE(check_map(path).problems.empty());
  const test::DrivenPlace place;
  const auto a = place.paths;
  const auto b = read_path_layers(MapLayers(path));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].lane, b[i].lane);
    EXPECT_EQ(a[i].status, b[i].status);
    EXPECT_EQ(a[i].path.closed, b[i].path.closed);
    EXPECT_EQ(a[i].path.knots, b[i].path.knots);
    EXPECT_EQ(a[i].path.points, b[i].path.points);
    EXPECT_EQ(a[i].length_m, b[i].length_m);
    EXPECT_EQ(a[i].width_m, b[i].width_m);
    EXPECT_EQ(a[i].max_curvature, b[i].max_curvature);
    EXPECT_EQ(a[i].deviation_m, b[i].deviation_m);
    EXPECT_EQ(a[i].tube_m, b[i].tube_m);
  }
}

TEST(PathLayers, CarryWhatAConsumerNeedsToRefuseThem) {
  const Folder folder;
  const MapLayers layers(test::map_with_paths(folder));
  for (const char* field :
       {"sigma_m", "date_utc", "coverage", "sessions", "deviation_m", "width_m"})
    EXPECT_TRUE(layers.read_layer("lane_paths").field(field)) << field;
}

TEST(PathLayers, SpacesFindTheirOpenSideAndTheirLane) {
  const Folder folder;
  const auto path = test::map_with_paths(folder);
  VectorLayer layer;
  layer.name = "parking_spaces";
  layer.type = GeometryType::kPolygonZ;
  layer.fields = {{"space", FieldType::kInteger}};
  // Along the lower road y = 0: spaces 2.5 x 5 m below it, corners in all four orders; one far off.
  for (int i = 0; i < 5; ++i) {
    const double x = 15.0 + 3.0 * i;
    const double top = i == 4 ? -60.0 : -3.0;
    std::vector<Eigen::Vector4d> ring{
        {x, top, 0, 0}, {x, top - 5, 0, 0}, {x + 2.5, top - 5, 0, 0}, {x + 2.5, top, 0, 0}};
    std::rotate(ring.begin(), ring.begin() + i % 4, ring.end());
    ring.push_back(ring.front());
    layer.features.push_back({ring, {std::int64_t{40 + i}}});
  }
  {
    MapUpdate update(path);
    update.write_layer(layer);
    update.commit();
  }
  const MapLayers layers(path);
  const RoadNetwork network = read_network_layers(layers);
  const auto spaces = read_spaces(layers.file(), layers.read_layer("parking_spaces"), network);
  ASSERT_EQ(spaces.size(), 5U);
  const auto links = link_spaces(network, spaces);
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(spaces[i].id, 40 + i);
    EXPECT_NEAR(spaces[i].front.y(), -3.0, 1e-12);
    EXPECT_NEAR(spaces[i].outwards.y(), 1.0, 1e-12);
    EXPECT_EQ(links[i].status, LinkStatus::kLinked) << links[i].reason;
    const Lane& lane = network.lanes[static_cast<std::size_t>(links[i].place.lane)];
    EXPECT_EQ(links[i].lane, lane.id);
    const Eigen::Vector3d at = lane_spot(lane, links[i].place.s_m).position;
    EXPECT_NEAR(at.x(), spaces[i].front.x(), 0.5);
    EXPECT_LT(std::abs(at.y()), 0.5);
  }
  EXPECT_EQ(links[4].status, LinkStatus::kNoLaneNear);
  EXPECT_EQ(links[4].reason, "no lane within 10.00 m");
  MapUpdate update(path);
  write_link_table(update, links);
  update.commit();
  EXPECT_EQ(MapLayers(path).read_table("space_links").rows.size(), 5U);
}

TEST(PathLayers, AMapWithoutPathsIsNamed) {
  const Folder folder;
  MapFileBuilder(folder / "a.gpkg", "key").finish(test::small_map(1), {});
  EXPECT_THROW((void)read_path_layers(MapLayers(folder / "a.gpkg")), BadInput);
}

}  // namespace
}  // namespace roadbook
