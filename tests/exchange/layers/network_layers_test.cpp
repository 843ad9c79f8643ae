#include "exchange/layers/network_layers.hpp"

#include <gtest/gtest.h>

#include "base/error.hpp"
#include "mapping/store/map_check.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/mapping/store/small_map.hpp"

namespace roadbook {
namespace {

using test::Folder;
using test::small_map;

RoadNetwork some_network() {
  Random random(3, "network");
  RoadNetwork network;
  for (int i = 0; i < 4; ++i)
    network.intersections.push_back({~std::uint64_t{0} - static_cast<std::uint64_t>(i),
                                     {random.normal(), random.normal(), 0.1}});
  for (int i = 0; i < 6; ++i) {
    Lane lane;
    lane.id = random();
    for (int p = 0; p < 2 + i; ++p)
      lane.centre.emplace_back(random.normal(), random.normal(), random.normal());
    lane.from_intersection = i % 4;
    lane.to_intersection = i == 5 ? -1 : (i + 1) % 4;
    lane.closed = i == 3;
    lane.forward_passes = i;
    lane.backward_passes = 2;
    lane.reverse_gear_passes = i % 2;
    lane.length_m = random.uniform(1.0, 50.0);
    lane.width_m = random.uniform();
    network.lanes.push_back(lane);
  }
  network.length_m = 123.456789;
  network.coverage = 0.995;
  network.reach_m = 1.5;
  network.cycle_rank = 3;
  network.components = 1;
  return network;
}

TEST(NetworkLayers, ComeBackBitForBit) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  const RoadNetwork a = some_network();
  {
    MapUpdate update(path);
    write_network_layers(update, a, {"drive 0,drive 1", "2014-06-24T18:02:59.763Z", 0.02});
    update.commit();
  }
  EXPECT_TRUE(check_map(path).problems.empty());
  const RoadNetwork b = read_network_layers(MapLayers(path));
  ASSERT_EQ(a.intersections.size(), b.intersections.size());
  for (std::size_t i = 0; i < a.intersections.size(); ++i) {
    EXPECT_EQ(a.intersections[i].id, b.intersections[i].id);
    EXPECT_EQ(a.intersections[i].position, b.intersections[i].position);
  }
  ASSERT_EQ(a.lanes.size(), b.lanes.size());
  for (std::size_t i = 0; i < a.lanes.size(); ++i) {
    EXPECT_EQ(a.lanes[i].id, b.lanes[i].id);
    EXPECT_EQ(a.lanes[i].centre, b.lanes[i].centre);
    EXPECT_EQ(a.lanes[i].from_intersection, b.lanes[i].from_intersection);
    EXPECT_EQ(a.lanes[i].to_intersection, b.lanes[i].to_intersection);
    EXPECT_EQ(a.lanes[i].closed, b.lanes[i].closed);
    EXPECT_EQ(a.lanes[i].forward_passes, b.lanes[i].forward_passes);
    EXPECT_EQ(a.lanes[i].backward_passes, b.lanes[i].backward_passes);
    EXPECT_EQ(a.lanes[i].reverse_gear_passes, b.lanes[i].reverse_gear_passes);
    EXPECT_EQ(a.lanes[i].length_m, b.lanes[i].length_m);
    EXPECT_EQ(a.lanes[i].width_m, b.lanes[i].width_m);
  }
  EXPECT_EQ(a.length_m, b.length_m);
  EXPECT_EQ(a.coverage, b.coverage);
  EXPECT_EQ(a.reach_m, b.reach_m);
  EXPECT_EQ(a.cycle_rank, b.cycle_rank);
  EXPECT_EQ(a.components, b.components);
}

TEST(NetworkLayers, CarryWhatAConsumerNeedsToRefuseThem) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  MapUpdate update(path);
  write_network_layers(update, some_network(), {"drive 0", "2014-06-24T18:02:59.763Z", 0.02});
  update.commit();
  const MapLayers layers(path);
  for (const char* name : {"lanes", "intersections"})
    for (const char* field : {"sigma_m", "date_utc", "coverage", "sessions"})
      EXPECT_TRUE(layers.read_layer(name).field(field)) << name << " " << field;
}

TEST(NetworkLayers, TwoLanesWithOneIdAreRefused) {
  const Folder folder;
  const auto path = folder / "a.gpkg";
  MapFileBuilder(path, "key").finish(small_map(1), {});
  RoadNetwork network = some_network();
  network.lanes[1].id = network.lanes[0].id;
  MapUpdate update(path);
  EXPECT_THROW(write_network_layers(update, network, {}), Refused);
}

}  // namespace
}  // namespace roadbook
