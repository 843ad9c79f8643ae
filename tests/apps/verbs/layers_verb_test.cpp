#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "exchange/layers/item_table.hpp"
#include "exchange/layers/layer_ages.hpp"
#include "exchange/layers/value_raster.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/apps/driven_road.hpp"
#include "tests/apps/run_command.hpp"

// Tests `roadbook layers`, and that `speeds` and `query` use what it stores.

namespace roadbook {
namespace {

constexpr std::int64_t kObserved_ns = 1'600'100'000'000'000'000;

// A straight road of 60 m along x, with lanes and speeds.
class LayersVerb : public ::testing::Test {
 protected:
  using Json = nlohmann::json;

  LayersVerb() {
    MapFileBuilder(file(), "inputs").finish(test::driven_road(), {});
    for (const char* command : {"roadbook roads -m place.gpkg", "roadbook speeds -m place.gpkg"})
      EXPECT_EQ(run(command).status, 0) << command;
  }
  [[nodiscard]] test::CommandResult run(const std::string& command) const {
    return test::run_command(command, folder_.path());
  }
  Json result_of(const std::string& command) const {
    const auto result = run(command + " --json");
    EXPECT_EQ(result.status, 0) << command << "\n" << result.err;
    return Json::parse(result.out, nullptr, false);
  }
  [[nodiscard]] std::filesystem::path file() const { return folder_.path() / "place.gpkg"; }
  [[nodiscard]] std::string digest() const { return load_meta(file()).digest; }

  static std::string now(double seconds) {
    return " --now " + utc_text(kObserved_ns + std::llround(seconds * 1e3) * 1'000'000);
  }
  static Json feature(const Json& properties,
                      const std::string& type = "Point",
                      const Json& coordinates = Json::array({30.0, 0.0})) {
    Json all{{"observed_utc", utc_text(kObserved_ns)}};
    all.update(properties);
    return {{"type", "Feature"},
            {"geometry", {{"type", type}, {"coordinates", coordinates}}},
            {"properties", all}};
  }
  void write(const Json& content, const std::string& name = "items.geojson") const {
    test::write_text(folder_.path() / name, content.dump());
  }
  void write_items(const std::vector<Json>& features) const {
    write({{"type", "FeatureCollection"}, {"features", features}});
  }
  [[nodiscard]] Json query(const std::string& more = {}) const {
    return result_of("roadbook query -m place.gpkg --at 30,0" + more);
  }
  static double speed_of(const Json& answer) { return answer["answers"][0]["speed_mps"]["value"]; }

  const std::string put_ = "roadbook layers -m place.gpkg --map-coordinates --put items.geojson";
  test::ScratchFolder folder_;
};

struct OfAge {
  const char* kind;
  const char* layer;
  double half_life_s;
};

class EachAge : public LayersVerb, public ::testing::WithParamInterface<OfAge> {};

// Until its half-life, the item slows the vehicle by its weight. Afterwards it is named and unused.
TEST_P(EachAge, IsUsedUntilItsOwnHalfLifeThenSaidAndNotUsed) {
  const auto [kind, layer, half_life_s] = GetParam();
  const double without = speed_of(query());
  ASSERT_GT(without, 4.0);
  write_items({feature({{"kind", kind}, {"speed_mps", 3.0}})});
  const Json put = result_of(put_ + now(0.0));
  EXPECT_EQ(put["put"], 1);
  EXPECT_EQ(put["items"][0]["layer"], layer);
  EXPECT_EQ(put["items"][0]["half_life_s"], half_life_s);
  EXPECT_EQ(put["items"][0]["weight"], 1.0);

  const std::string before = now(0.9 * half_life_s);
  const double weight = std::exp2(-0.9);
  const Json used = result_of("roadbook layers -m place.gpkg" + before);
  EXPECT_EQ(used["items"][0]["state"], "used");
  EXPECT_NEAR(used["items"][0]["weight"], weight, 1e-6);
  // The query needs no new speeds.
  const double slowed = weight * 3.0 + (1.0 - weight) * without;
  const Json asked = query(before);
  EXPECT_NEAR(speed_of(asked), slowed, 1e-6);
  EXPECT_EQ(asked["answers"][0]["limited_by"], "item");
  EXPECT_NEAR(asked["answers"][0]["speed_mps"]["sigma"],
              std::sqrt(weight * (1.0 - weight)) * (without - 3.0), 1e-6);
  ASSERT_EQ(asked["answers"][0]["items"].size(), 1U);
  EXPECT_EQ(asked["answers"][0]["items"][0]["kind"], kind);
  const Json speeds = result_of("roadbook speeds -m place.gpkg" + before);
  EXPECT_NEAR(speeds["lanes"][0]["slowest_mps"], slowed, 1e-6);
  EXPECT_EQ(speeds["items"]["used"].size(), 1U);
  EXPECT_EQ(read_layer_ages(MapLayers(file())).find(std::string(kind) + " 0")->half_life_s,
            half_life_s);

  const std::string after = now(1.1 * half_life_s);
  const Json stale = result_of("roadbook layers -m place.gpkg" + after);
  EXPECT_EQ(stale["items"][0]["state"], "stale");
  const auto said = run("roadbook query -m place.gpkg --at 30,0 --json" + after);
  EXPECT_NE(said.err.find(std::string(kind) + " 0 is stale and not used"), std::string::npos)
      << said.err;
  const Json late = Json::parse(said.out);
  EXPECT_NEAR(speed_of(late), without, 1e-9);
  EXPECT_TRUE(late["answers"][0]["items"].empty());
  ASSERT_EQ(late["items"]["not_used"].size(), 1U);
  EXPECT_EQ(late["items"]["not_used"][0]["state"], "stale");
  const auto again = run("roadbook speeds -m place.gpkg --json" + after);
  EXPECT_NE(again.err.find("stale and not used"), std::string::npos) << again.err;
  EXPECT_GT(Json::parse(again.out)["lanes"][0]["slowest_mps"].get<double>(), slowed + 0.5);
  EXPECT_NEAR(speed_of(query(after)), without, 1e-9);
}

INSTANTIATE_TEST_SUITE_P(Ages,
                         EachAge,
                         ::testing::Values(OfAge{"vehicle", "dynamic", 20.0},
                                           OfAge{"queue", "semi-dynamic", 600.0},
                                           OfAge{"planned_change", "semi-static", 43200.0},
                                           OfAge{"road_change", "static", 7776000.0}));

TEST_F(LayersVerb, OnlyAppendsAndMarksStaleItemsOnRequest) {
  write_items({feature({{"kind", "vehicle"}}),
               feature({{"kind", "road_works"}, {"half_life_s", 7200}, {"note", "a trench"}},
                       "LineString", {{25.0, 1.0}, {35.0, 1.0}})});
  ASSERT_EQ(result_of(put_ + now(5.0))["put"], 2);
  const std::string once = digest();
  const Json twice = result_of(put_ + now(6.0));
  EXPECT_EQ(twice["already"], 2);
  EXPECT_EQ(digest(), once) << "the same file again changes nothing";
  const auto rows = MapLayers(file()).read_table("layer_items").rows;
  ASSERT_EQ(rows.size(), 2U);

  EXPECT_TRUE(result_of("roadbook layers -m place.gpkg --expire" + now(10.0))["expired"].empty());
  EXPECT_EQ(digest(), once) << "nothing is stale";
  EXPECT_EQ(result_of("roadbook layers -m place.gpkg --expire" + now(60.0))["expired"],
            Json::array({0}));
  const auto marked = MapLayers(file()).read_table("layer_items").rows;
  ASSERT_EQ(marked.size(), 3U);
  EXPECT_TRUE(std::equal(rows.begin(), rows.end(), marked.begin()));
  const Json listed = result_of("roadbook layers -m place.gpkg" + now(61.0));
  EXPECT_EQ(listed["items"][0]["state"], "expired");
  EXPECT_EQ(listed["items"][1]["state"], "used");
  EXPECT_EQ(listed["items"][1]["note"], "a trench");
  EXPECT_TRUE(result_of("roadbook layers -m place.gpkg --expire" + now(62.0))["expired"].empty());
  EXPECT_EQ(run("roadbook check place.gpkg").status, 0);
  // Items of before stay, further ones follow.
  write_items({feature({{"kind", "queue"}})});
  EXPECT_EQ(result_of(put_ + now(70.0))["items"][2]["item"], 2);
}

TEST_F(LayersVerb, TakesDegreesWhereTheMapLiesOnTheEarth) {
  write_items({feature({{"kind", "queue"}}, "Point", {9.18, 48.78})});
  const auto refused = run("roadbook layers -m place.gpkg --put items.geojson" + now(0.0));
  EXPECT_EQ(refused.status, 2);
  EXPECT_NE(refused.err.find("place.gpkg: origin: got none, want latitude and longitude"),
            std::string::npos)
      << refused.err;
  EXPECT_NE(refused.err.find("--map-coordinates"), std::string::npos);
  MapUpdate update(file());
  update.set_meta("origin_latitude_deg", "48.78");
  update.set_meta("origin_longitude_deg", "9.18");
  update.set_meta("origin_x_axis_deg", "90");
  update.commit();
  result_of("roadbook layers -m place.gpkg --put items.geojson" + now(0.0));
  const auto items = read_items(MapLayers(file()));
  ASSERT_EQ(items.size(), 1U);
  EXPECT_LT(items[0].parts.at(0).at(0).norm(), 1e-6);
}

TEST_F(LayersVerb, BadInputIsOneLineAndLeavesTheMapAsItWas) {
  const std::string before = digest();
  const auto refused = [&](const Json& content, const std::string& message) {
    write(content);
    const auto result = run(put_ + now(0.0));
    EXPECT_EQ(result.status, 2) << content;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_NE(result.err.find("error: items.geojson: " + message), std::string::npos)
        << message << "\n"
        << result.err;
  };
  const auto odd = [&](const Json& one, const std::string& message) {
    refused({{"type", "FeatureCollection"}, {"features", {one}}}, message);
  };
  odd(feature({{"kind", "queues"}}), "features[0].properties.kind: got \"queues\", want one of");
  odd(feature({{"kind", "queue"}, {"observed_utc", "today"}}),
      "features[0].properties.observed_utc: got \"today\", want a time such as");
  odd(feature({{"kind", "queue"}, {"observed_utc", "2020-09-14T16:13:21Z"}}),
      "features[0].properties.observed_utc: got \"2020-09-14T16:13:21Z\", want a time up to");
  odd(feature({{"kind", "queue"}, {"half_life_s", 0}}),
      "features[0].properties.half_life_s: got 0, want seconds above 0");
  odd(feature({{"kind", "road_change"}}), "features[0].properties.speed_mps: got nothing, want");
  odd(feature({{"kind", "weather"}, {"speed_mps", 3}}),
      "features[0].properties.speed_mps: got 3, want none for weather");
  odd(feature({{"kind", "queue"}}, "Polygon", {{{0, 0}, {1, 0}, {0, 0}}}),
      "features[0].geometry.coordinates[0][0]: got 2 corners, want three or more");
  odd(feature({{"kind", "queue"}}, "GeometryCollection"),
      "features[0].geometry.type: got \"GeometryCollection\", want a point, line or polygon");
  odd(feature({{"kind", "queue"}}, "Point", {1e6, 0}),
      "features[0].geometry.coordinates[0]: got 1000000.000000, 0.000000, want x, y in metres");
  refused({{"type", "FeatureCollection"}, {"features", Json::array()}},
          "features: got none, want at least one item");
  refused({{"type", "Point"}}, "type: got \"Point\", want FeatureCollection");
  EXPECT_EQ(digest(), before);
  for (const char* coordinates : {" --map-coordinates", ""}) {
    const auto missing =
        run(std::string("roadbook layers -m place.gpkg --put none.geojson") + coordinates);
    EXPECT_EQ(missing.status, 2);
    EXPECT_TRUE(missing.err.starts_with("error: none.geojson: ")) << missing.err;
  }
  EXPECT_EQ(run("roadbook layers -m none.gpkg").status, 2);
  const auto time = run("roadbook layers -m place.gpkg --now yesterday");
  EXPECT_EQ(time.status, 1);
  EXPECT_NE(time.err.find("--now: got yesterday, want a time such as"), std::string::npos);
}

// A raster of one value over the road, unknown beyond x = 40.
ValueRaster known_to_40(float value) {
  ValueRaster raster = ValueRaster::over({-10.0, -10.0}, {70.0, 10.0}, 0.5);
  for (int row = 0; row < raster.place.rows; ++row)
    for (int column = 0; column < 100; ++column)
      raster.values[static_cast<std::size_t>(row * raster.place.columns + column)] = value;
  return raster;
}

TEST_F(LayersVerb, QueryTellsOccupancyAndLabelsAndNullWhereNothingIsKnown) {
  const Json nothing = query()["answers"][0];
  EXPECT_TRUE(nothing.at("occupancy").is_null());
  EXPECT_TRUE(nothing.at("labels").is_null());
  {
    MapUpdate update(file());
    write_value_raster(update, "occupancy", "probability", known_to_40(0.25F));
    write_value_raster(update, "occupancy_sigma", "sigma", known_to_40(0.125F));
    write_value_raster(update, "occupancy_age", "age", known_to_40(7.0F));
    write_raster_age(update, MapLayers(file()), {"occupancy", kObserved_ns, kOccupancyHalfLife_s},
                     kObserved_ns);
    VectorLayer spaces;
    spaces.name = "parking_spaces";
    spaces.type = GeometryType::kPolygonZ;
    spaces.fields = {
        {"space", FieldType::kInteger}, {"class", FieldType::kText}, {"sigma_m", FieldType::kReal}};
    spaces.features = {{{{28, 2, 0, 0}, {33, 2, 0, 0}, {33, 5, 0, 0}, {28, 5, 0, 0}, {28, 2, 0, 0}},
                        {std::int64_t{4}, std::string("parking_space"), 0.1}}};
    update.write_layer(spaces);
    update.commit();
  }
  const Json at = query(now(100.0))["answers"][0];
  EXPECT_NEAR(at["occupancy"]["value"], 0.25, 1e-6);
  EXPECT_NEAR(at["occupancy"]["sigma"], 0.125, 1e-6);
  EXPECT_NEAR(at["occupancy"]["age_s"], 107.0, 1e-3);
  EXPECT_NEAR(at["occupancy"]["d_ds"], 0.0, 1e-9);
  ASSERT_EQ(at["labels"].size(), 1U);
  EXPECT_EQ(at["labels"][0]["id"], 4);
  EXPECT_EQ(at["labels"][0]["class"], "parking_space");
  EXPECT_NEAR(at["labels"][0]["distance_m"], 2.0, 1e-9);
  EXPECT_NEAR(at["labels"][0]["sigma_m"], 0.1, 1e-12);
  EXPECT_NEAR(std::abs(at["labels"][0]["d_de"].get<double>()), 1.0, 1e-3);
  const Json beyond = result_of("roadbook query -m place.gpkg --at 50,0")["answers"][0];
  EXPECT_TRUE(beyond["occupancy"].is_null()) << "no reading is not free";
  EXPECT_EQ(beyond["labels"], Json::array());
  // The age of the grid is in the list, and speeds keep it.
  for (int round = 0; round < 2; ++round) {
    const Json layers = result_of("roadbook layers -m place.gpkg" + now(2.0 * 86400.0))["layers"];
    const auto grid = std::find_if(layers.begin(), layers.end(),
                                   [](const Json& one) { return one["name"] == "occupancy"; });
    ASSERT_NE(grid, layers.end());
    EXPECT_EQ((*grid)["layer"], "semi-static");
    EXPECT_NEAR((*grid)["weight"], 0.25, 1e-6);
    EXPECT_EQ((*grid)["stale"], true);
    ASSERT_EQ(run("roadbook speeds -m place.gpkg").status, 0);
  }
}

}  // namespace
}  // namespace roadbook
