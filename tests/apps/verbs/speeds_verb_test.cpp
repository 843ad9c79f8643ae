#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/error.hpp"
#include "exchange/layers/friction_layers.hpp"
#include "exchange/layers/network_layers.hpp"
#include "exchange/layers/speed_layers.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/apps/driven_road.hpp"
#include "tests/apps/run_command.hpp"
#include "workflows/settings/speeds_rules.hpp"

// Tests `roadbook speeds` with real files; each command runs in a separate process.

namespace roadbook {
namespace {

// The map of a road and two visits, without images.
class SpeedsVerb : public ::testing::Test {
 protected:
  SpeedsVerb() { write_map(); }
  void write_map() const;
  [[nodiscard]] test::CommandResult run(const std::string& command) const {
    return test::run_command(command, folder_.path());
  }
  [[nodiscard]] std::string digest() const {
    return load_meta(folder_.path() / "place.gpkg").digest;
  }
  test::ScratchFolder folder_;
};

void SpeedsVerb::write_map() const {
  MapFileBuilder build(folder_.path() / "place.gpkg", "inputs");
  build.finish(test::driven_road(), {});
}

TEST_F(SpeedsVerb, KeepsWhatWasSeenAndForgetsIt) {
  ASSERT_EQ(run("roadbook roads -m place.gpkg").status, 0);
  // A person stands 8 m ahead at x = 30. The first visit sees this person from x = 22 on, at 11 s.
  std::string table = "#timestamp [ns],x [m],y [m],sigma [m],probability [-]\n";
  for (int i = 0; i < 20; ++i)
    table +=
        std::to_string(std::int64_t{1'600'000'011'000'000'000} + i * std::int64_t{100'000'000}) +
        "," + std::to_string(8.0 - 0.2 * i) + ",0.5,0.2,0.95\n";
  test::write_text(folder_.path() / "people.csv", table);
  const auto prior = run("roadbook speeds -m place.gpkg --json");
  ASSERT_EQ(prior.status, 0) << prior.err;
  const auto first =
      run("roadbook speeds -m place.gpkg --detections people.csv --observed visit1 --json");
  ASSERT_EQ(first.status, 0) << first.err;
  const auto a = nlohmann::json::parse(first.out);
  EXPECT_GT(a.at("presence_max"), 0.2);
  EXPECT_LT(nlohmann::json::parse(prior.out).at("presence_max"), 0.1);
  ASSERT_EQ(a.at("visits").size(), 2U);
  EXPECT_EQ(a.at("visits")[0].at("people"), 20);
  EXPECT_EQ(a.at("visits")[1].at("people"), 0);
  // The map stores the detections: a second run without the table gives the same map.
  const auto again = run("roadbook speeds -m place.gpkg --json");
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(nlohmann::json::parse(again.out).at("presence_max"), a.at("presence_max"));
  // After ten half-lives, the map equals the prior again.
  const auto late = run("roadbook speeds -m place.gpkg --days-later 1800 --json");
  ASSERT_EQ(late.status, 0) << late.err;
  EXPECT_NEAR(nlohmann::json::parse(late.out).at("presence_max").get<double>(),
              nlohmann::json::parse(prior.out).at("presence_max").get<double>(), 1e-3);
  EXPECT_EQ(run("roadbook check place.gpkg").status, 0);
}

// The command drops no earlier detection unless asked, and it reports each ignored detection.
TEST_F(SpeedsVerb, FurtherTablesAddToWhatIsThere) {
  ASSERT_EQ(run("roadbook roads -m place.gpkg").status, 0);
  const auto row = [](int i, double x, double y) {
    return std::to_string(std::int64_t{1'600'000'011'000'000'000} + i * std::int64_t{100'000'000}) +
           "," + std::to_string(x) + "," + std::to_string(y) + "\n";
  };
  const std::string head = "#timestamp [ns],x [m],y [m]\n";
  const auto speeds = [&](const std::string& options, std::string* notes = nullptr) {
    const auto result = run("roadbook speeds -m place.gpkg --json " + options);
    EXPECT_EQ(result.status, 0) << result.err;
    if (notes != nullptr) *notes = result.err;
    return nlohmann::json::parse(result.out);
  };
  test::write_text(folder_.path() / "a.csv", head + row(0, 5.0, 0.5) + row(1, 4.8, 0.5));
  test::write_text(folder_.path() / "b.csv", head + row(1, 4.8, 0.5) + row(2, 900.0, 0.0));
  test::write_text(folder_.path() / "empty.csv", head);
  EXPECT_EQ(speeds("--detections a.csv").at("visits")[0].at("people"), 2);
  std::string notes;
  const auto more = speeds("--detections b.csv --detections empty.csv", &notes);
  EXPECT_EQ(more.at("detections_added"), 1);
  EXPECT_EQ(more.at("detections_known"), 1);
  EXPECT_EQ(more.at("visits")[0].at("people_off_map"), 1);
  EXPECT_NE(notes.find("empty.csv: no rows"), std::string::npos) << notes;
  EXPECT_NE(notes.find("visit0: 1 people where the map has no place"), std::string::npos) << notes;
  EXPECT_NE(notes.find("1 detections are in the map already"), std::string::npos) << notes;
  const auto replaced = speeds("--detections b.csv --replace", &notes);
  EXPECT_EQ(replaced.at("detections_replaced"), 1);
  EXPECT_NE(notes.find("1 older detections replaced"), std::string::npos) << notes;
  EXPECT_EQ(speeds("").at("visits")[0].at("people_off_map"), 1);
}

// A few new rows change the map locally. The local solution equals the full solution to 1e-6.
TEST_F(SpeedsVerb, AFewNewRowsAreSolvedForLocally) {
  ASSERT_EQ(run("roadbook roads -m place.gpkg").status, 0);
  const std::string head = "#timestamp [ns],x [m],y [m]\n";
  test::write_text(folder_.path() / "a.csv", head + "1600000011000000000,5,0.5\n");
  test::write_text(folder_.path() / "b.csv", head + "1600000025000000000,4,1.5\n");
  ASSERT_EQ(run("roadbook speeds -m place.gpkg --detections a.csv").status, 0);
  const auto presence = [&] {
    std::vector<double> values;
    const auto speeds = read_speed_layers(MapLayers(folder_.path() / "place.gpkg"));
    for (const SpeedCell& cell : speeds->cells) values.push_back(cell.presence);
    return values;
  };
  const std::vector<double> before = presence();
  const auto local = run("roadbook speeds -m place.gpkg --detections b.csv --local --json");
  ASSERT_EQ(local.status, 0) << local.err;
  const auto json = nlohmann::json::parse(local.out);
  EXPECT_GT(json.at("places_solved"), 0);
  EXPECT_LT(2 * json.at("places_solved").get<int>(), json.at("places").get<int>());
  const std::vector<double> around = presence();
  ASSERT_EQ(run("roadbook speeds -m place.gpkg").status, 0);
  const std::vector<double> whole = presence();
  double moved = 0.0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    EXPECT_NEAR(around[i], whole[i], 1e-6);
    moved = std::max(moved, std::abs(whole[i] - before[i]));
  }
  EXPECT_GT(moved, 0.01) << "ten thousand times what is left out";
}

// A rebuild of the map from its drives keeps the detections of people, because they are stored
// relative to the vehicle.
TEST_F(SpeedsVerb, PeopleOutliveABuildOfTheMap) {
  ASSERT_EQ(run("roadbook roads -m place.gpkg").status, 0);
  test::write_text(folder_.path() / "a.csv",
                   "#timestamp [ns],x [m],y [m]\n1600000011000000000,5,0.5\n");
  const auto before = run("roadbook speeds -m place.gpkg --detections a.csv --json");
  ASSERT_EQ(before.status, 0) << before.err;
  MapFinishOptions options;
  options.keep_tables = measured_tables();
  MapFileBuilder(folder_.path() / "place.gpkg", "inputs").finish(test::driven_road(), {}, options);
  ASSERT_EQ(run("roadbook roads -m place.gpkg").status, 0);
  const auto after = run("roadbook speeds -m place.gpkg --json");
  ASSERT_EQ(after.status, 0) << after.err;
  EXPECT_EQ(nlohmann::json::parse(after.out).at("presence_max"),
            nlohmann::json::parse(before.out).at("presence_max"));
}

// Limits of lanes stay valid until the user gives others: with new speeds, a rebuilt map and new
// lanes.
TEST_F(SpeedsVerb, LimitsHoldUntilOthersAreTold) {
  ASSERT_EQ(run("roadbook roads -m place.gpkg").status, 0);
  const auto fastest = [&](const std::string& options, std::string* notes = nullptr) {
    const auto result = run("roadbook speeds -m place.gpkg --json " + options);
    EXPECT_EQ(result.status, 0) << result.err;
    if (notes != nullptr) *notes = result.err;
    double most = 0.0;
    const auto speeds = read_speed_layers(MapLayers(folder_.path() / "place.gpkg"));
    for (const LaneProfile& lane : speeds->profiles)
      for (const LaneSpeed& at : lane.places) most = std::max(most, at.speed);
    return most;
  };
  EXPECT_GT(fastest(""), 3.0);
  const auto lane = read_network_layers(MapLayers(folder_.path() / "place.gpkg")).lanes.front().id;
  test::write_text(folder_.path() / "c.yaml",
                   "max_speed_mps: 7\npriors: {lane: {presence: 0.01}}\nlimits_mps: {" +
                       std::to_string(lane) + ": 2}\n");
  EXPECT_DOUBLE_EQ(fastest("--config c.yaml"), 2.0);
  EXPECT_DOUBLE_EQ(fastest(""), 2.0);
  EXPECT_DOUBLE_EQ(fastest("--local"), 2.0);
  MapFinishOptions options;
  options.keep_tables = measured_tables();
  MapFileBuilder(folder_.path() / "place.gpkg", "inputs").finish(test::driven_road(), {}, options);
  ASSERT_EQ(run("roadbook roads -m place.gpkg").status, 0);
  EXPECT_DOUBLE_EQ(fastest(""), 2.0);
  // The configuration must survive being written and parsed, key by key.
  const auto kept = SpeedsConfig::load(folder_.path() / "c.yaml", {}).text();
  EXPECT_EQ(SpeedsConfig::parse(kept, "kept", {}).text(), kept);
  EXPECT_NE(kept, SpeedsConfig{}.text());
  // The lane no longer exists. The command reports that its limit cannot apply.
  SpeedsConfig other;
  other.limits[999] = 3.0;
  MapUpdate update(folder_.path() / "place.gpkg");
  write_speeds_rules(update, other);
  update.commit();
  std::string notes;
  (void)fastest("", &notes);
  EXPECT_NE(notes.find("limits_mps: lane 999 is no more"), std::string::npos) << notes;
  // An empty file resets to the defaults.
  test::write_text(folder_.path() / "c.yaml", "");
  EXPECT_GT(fastest("--config c.yaml"), 3.0);
}

// The map knows no friction of some ground. A planner may assume a friction there. The speed that
// still allows stopping within sight is then lower.
TEST_F(SpeedsVerb, AnAssumedGripSlowsWhereNoneIsKnown) {
  ASSERT_EQ(run("roadbook roads -m place.gpkg").status, 0);
  const auto slowest = [&](const std::string& config) {
    test::write_text(folder_.path() / "c.yaml", config);
    const auto result = run("roadbook speeds -m place.gpkg --config c.yaml --json");
    EXPECT_EQ(result.status, 0) << result.err;
    return nlohmann::json::parse(result.out).at("lanes")[0].at("slowest_mps").get<double>();
  };
  const double free = slowest("max_speed_mps: 20\n");
  // v 0.5 s + v^2 / (2 0.7 0.1 g) = 15 m
  const double a = 0.7 * 0.1 * 9.81;
  EXPECT_NEAR(slowest("max_speed_mps: 20\nunknown_grip: 0.1\n"),
              std::min(free, -0.5 * a + std::sqrt(0.25 * a * a + 2.0 * a * 15.0)), 1e-6);
}

TEST_F(SpeedsVerb, BadInputIsOneLineAndLeavesTheMapAsItWas) {
  ASSERT_EQ(run("roadbook roads -m place.gpkg").status, 0);
  const std::string before = digest();
  const auto refused = [&](const std::string& options, int status, const std::string& what) {
    const auto result = run("roadbook speeds -m place.gpkg " + options);
    EXPECT_EQ(result.status, status) << options << "\n" << result.err;
    EXPECT_NE(result.err.find(what), std::string::npos) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(digest(), before);
  };
  const auto table = [&](const std::string& text) {
    test::write_text(folder_.path() / "t.csv", text);
    return std::string("--detections t.csv");
  };
  refused(table("#timestamp [ns],x [m]\n"), 2, "t.csv:1: ");
  refused(table("#timestamp [ns],x [m],y [m]\n1600000011000000000,nan,0\n"), 2, "t.csv:2: x");
  refused(table("#timestamp [ns],x [m],y [m],probability [-]\n1600000011000000000,1,0,1.5\n"), 2,
          "probability: got 1.5");
  refused("--observed nowhere", 1, "--observed: got nowhere");
  const auto config = [&](const std::string& text) {
    test::write_text(folder_.path() / "c.yaml", text);
    return std::string("--config c.yaml");
  };
  refused(config("max_sped_mps: 3\n"), 2, "did you mean max_speed_mps");
  refused(config("priors: {crossing: {presence: 1.5}}\n"), 2, "presence");
  refused(config("limits_mps: {main: 3}\n"), 2, "the id of a lane");
  refused(config("limits_mps:\n  999: 3\n"), 2,
          "c.yaml:2: limits_mps: got 999, want a lane of place");
  refused(config("step_m: 20\n"), 2, "step_m");
  refused(config("unknown_grip: 3\n"), 2, "c.yaml:1: unknown_grip");
  refused(config("caution: 1\nmin_speed_mps: 9\n"), 2,
          "c.yaml:2: max_speed_mps: got 8.333333, want min_speed_mps to 100");
  refused("--truth", 2, "visit0");
}

}  // namespace
}  // namespace roadbook
