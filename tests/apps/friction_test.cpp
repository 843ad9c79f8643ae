#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/error.hpp"
#include "exchange/layers/friction_carry.hpp"
#include "exchange/layers/path_layers.hpp"
#include "tests/apps/friction_place.hpp"
#include "workflows/settings/friction_config.hpp"

// Tests `roadbook friction` with real files; each command runs in a separate process.

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;
using test::FrictionPlace;
using test::json_of;
using test::read_text;
using test::write_text;

double of_class(const Json& result, const std::string& name, const char* what) {
  for (const Json& one : result.at("classes"))
    if (one.at("class") == name) return one.at(what);
  return NAN;
}

TEST(FrictionVerb, LearnsWhatTheSimulatedRoadHasAndKeepsIt) {
  const FrictionPlace place;
  ASSERT_EQ(place.run("roadbook roads -m place.gpkg").status, 0);
  const Json made =
      json_of(place.run("roadbook friction road -m place.gpkg --slice grip.json --json -q"));
  EXPECT_GT(made.at("frames"), 100);
  EXPECT_GT(made.at("values"), 100);
  // The true friction of the simulated ground.
  const Json truth =
      Json::parse(read_text(place.path("road/truth/world.json")))["ground"]["friction"];
  for (const char* name : {"asphalt", "wet"})
    for (const auto& [kind, ground] : truth.items())
      if (ground.at("class") == (std::string(name) == "asphalt" ? 1 : 5)) {
        EXPECT_NEAR(of_class(made, name, "mean"), ground.at("friction").get<double>(),
                    3.0 * of_class(made, name, "sigma_of_mean"))
            << kind;
      }
  EXPECT_EQ(place.run("roadbook check place.gpkg").status, 0);
  EXPECT_TRUE(Json::accept(read_text(place.path("grip.json"))));
  // A second run with the same drive gives the same map: the command does not count the drive
  // twice.
  const std::string before = place.digest();
  const Json again = json_of(place.run("roadbook friction road -m place.gpkg --json -q"));
  EXPECT_EQ(again.at("classes"), made.at("classes"));
  EXPECT_EQ(place.run("roadbook export -m place.gpkg --format path -o p.json").status, 0);
  EXPECT_NE(read_text(place.path("p.json")).find("friction_coverage"), std::string::npos);
  EXPECT_FALSE(before.empty());
}

TEST(FrictionVerb, ABadValueIsToldWithFileAndLineAndChangesNothing) {
  const FrictionPlace place;
  ASSERT_EQ(place.run("roadbook roads -m place.gpkg").status, 0);
  const std::string table = read_text(place.path("road/friction0/data.csv"));
  std::vector<std::string> lines;
  std::istringstream in(table);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  const auto with = [&](const std::string& value) {
    std::string text;
    for (std::size_t i = 0; i < lines.size(); ++i) {
      std::string line = lines[i];
      if (i == 6) {
        const auto first = line.find(',') + 1;
        line.replace(first, line.find(',', first) - first, value);
      }
      text += line + "\n";
    }
    write_text(place.path("road/friction0/data.csv"), text);
    if (value == "nan") return;  // a map cannot be made from this drive
    place.write_map({"road"});   // of the damaged drive
    EXPECT_EQ(place.run("roadbook roads -m place.gpkg").status, 0);
  };
  for (const char* value : {"40", "-3", "nan"}) {
    with(value);
    const std::string before = place.digest();
    const auto result = place.run("roadbook friction road -m place.gpkg -q");
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_NE(result.err.find("road/friction0/data.csv:7: friction: got " + std::string(value)),
              std::string::npos)
        << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(place.digest(), before);
  }
}

TEST(FrictionVerb, AWrongConfigurationIsToldWithFileAndLine) {
  const FrictionPlace place;
  ASSERT_EQ(place.run("roadbook roads -m place.gpkg").status, 0);
  const std::string before = place.digest();
  const auto refused = [&](const std::string& text, const std::string& want) {
    write_text(place.path("c.yaml"), text);
    const auto result = place.run("roadbook friction road -m place.gpkg --config c.yaml -q");
    EXPECT_EQ(result.status, 2) << result.err;
    EXPECT_EQ(result.err.find("error: c.yaml:" + want), 0U) << result.err;
    EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
    EXPECT_EQ(place.digest(), before);
  };
  refused("spacing_m: 1\nprior_counts: [1, 2]\n", "2: prior_counts: got 2 for 4 classes");
  refused("prior_counts: [5, 1, -1, 1]\n", "1: prior_counts: got -1");
  refused("\nclasses: []\n", "2: classes: got 0 names, want 1 to 32");
  refused("range_m: 20\nspacing_m: 3\n", "2: kernel_width_m: got 2");
  refused("kernel_width_m: 0.5\n", "1: kernel_width_m: got 0.5");
  refused("confusion: [0.5, 0.5]\n", "1: confusion: got 2 numbers, want 16");
  refused("semantics: discrete\n", "1: confusion: got nothing");
  refused("semantics: guessed\n", "1: semantics: got guessed, want one of linear_pool");
  refused("friction_mean: [0.8, 0.7, 9, 0.5]\n", "1: friction_mean: got 9");
  refused("properties: {roughness: {range: [0, 9], mean: [1], spread: [1, 1, 1, 1]}}\n",
          "1: properties.roughness.mean: got 1 for 4 classes");
  const auto called = [](const std::string& name) {
    return "  " + name + ": {range: [0, 9], mean: [1, 1, 1, 1], spread: [1, 1, 1, 1]}\n";
  };
  refused("properties:\n" + called("grip") + called("grip_sigma"),
          "2: properties: got grip_sigma, want another name: so the sigma of grip");
  // A property cannot have the name of a column in a table of paths, or the name of a layer.
  ASSERT_EQ(place.run("roadbook speeds -m place.gpkg").status, 0);
  ASSERT_EQ(place.run("roadbook export -m place.gpkg --format path -o p.json").status, 0);
  const auto lane = Json::parse(read_text(place.path("p.json"))).at("lanes").at(0);
  const auto is_taken = [&](const std::string& name) {
    EXPECT_THROW((void)FrictionConfig::parse("properties:\n" + called(name), "c.yaml"), BadInput)
        << name;
  };
  for (const auto& [column, values] : lane.items()) is_taken(column);
  for (const LayerInfo& layer : MapLayers(place.file()).list())
    for (const std::string end : {"_mean", "_sigma", "_colours"})
      if (layer.name.ends_with(end)) is_taken(layer.name.substr(0, layer.name.size() - end.size()));
  EXPECT_NO_THROW((void)FrictionConfig::parse("properties:\n" + called("roughness"), "c.yaml"));
}

// The command refuses options that would have no effect, and reports a property without any
// reading.
TEST(FrictionVerb, NothingThatWasAskedForIsSilentlyLeftOut) {
  const FrictionPlace place;
  ASSERT_EQ(place.run("roadbook roads -m place.gpkg").status, 0);
  const std::string before = place.digest();
  const auto refused = [&](const std::string& options, const std::string& what) {
    const auto result = place.run("roadbook friction road -m place.gpkg -q " + options);
    EXPECT_EQ(result.status, 1) << result.err;
    EXPECT_EQ(result.err.find("error: " + what), 0U) << result.err;
    EXPECT_EQ(place.digest(), before);
  };
  refused("--property friction0", "--slice: got nothing");
  refused("--to-m 20", "--slice: got nothing");
  refused("--slice f.txt", "--slice: got f.txt, want a file .json, .h or .hpp");
  refused("--slice f.json --from-m 30 --to-m 20", "--from-m: got 30.000, want less than 20.000");
  write_text(place.path("c.yaml"),
             "properties:\n  roughness: {unit: mm, table: roughnes0/data.csv, range: [0, 9],\n"
             "    mean: [1, 1, 1, 1], spread: [1, 1, 1, 1]}\n");
  const auto learned = place.run("roadbook friction road -m place.gpkg --config c.yaml -q");
  EXPECT_EQ(learned.status, 0) << learned.err;
  EXPECT_NE(learned.err.find("road/roughnes0/data.csv: roughness: nothing learned, no such table"),
            std::string::npos)
      << learned.err;
}

TEST(FrictionVerb, AMapIsExtendedByTheRulesItWasBegunWith) {
  const FrictionPlace place;
  place.simulate("second", 2);
  place.write_map({"road", "second"});
  ASSERT_EQ(place.run("roadbook roads -m place.gpkg").status, 0);
  write_text(place.path("c.yaml"), "kernel_width_m: 3\n");
  json_of(place.run("roadbook friction road -m place.gpkg --config c.yaml --json -q"));
  // Without a configuration, the command uses the one stored in the map. It refuses a different
  // configuration and names the key.
  write_text(place.path("other.yaml"), "spacing_m: 1\nkernel_width_m: 2.5\n");
  const auto other = place.run("roadbook friction second -m place.gpkg --config other.yaml -q");
  EXPECT_EQ(other.status, 2);
  EXPECT_EQ(other.err.find("error: other.yaml:2: kernel_width_m: got 2.5, want 3.0"), 0U)
      << other.err;
  json_of(place.run("roadbook speeds -m place.gpkg --json"));
  const auto added = place.run("roadbook friction second -m place.gpkg --json -q");
  EXPECT_NE(added.err.find("`roadbook speeds` takes the new grip up"), std::string::npos);
  const Json two = json_of(added);
  EXPECT_EQ(two.at("sessions").size(), 2U);
  const MapLayers layers(place.file());
  EXPECT_EQ(read_friction_layers(layers, read_path_layers(layers))->kernel_width_m, 3.0);
  EXPECT_EQ(place.run("roadbook friction second -m place.gpkg -q").status, 2) << "twice";
}

TEST(FrictionVerb, AFurtherPropertyNeedsAConfigurationAlone) {
  const FrictionPlace place;
  // Roughness of the asphalt is about 2 mm, in a separate table.
  std::ostringstream table;
  table << "#timestamp [ns],rms [mm]\n";
  std::istringstream in(read_text(place.path("road/friction0/data.csv")));
  std::string line;
  std::getline(in, line);
  for (int i = 0; std::getline(in, line); ++i)
    table << line.substr(0, line.find(',')) << ',' << 2.0 + 0.1 * (i % 3 - 1) << '\n';
  std::filesystem::create_directories(place.path("road/roughness0"));
  write_text(place.path("road/roughness0/data.csv"), table.str());
  ASSERT_EQ(place.run("roadbook roads -m place.gpkg").status, 0);
  write_text(place.path("c.yaml"),
             "half_life_s: 1e9\n"
             "properties:\n"
             "  roughness:\n"
             "    {unit: mm, table: roughness0/data.csv, column: rms, sensor_sigma: 0.05,\n"
             "     range: [0, 20], mean: [5, 5, 5, 5], spread: [2, 2, 2, 2]}\n");
  const Json made = json_of(
      place.run("roadbook friction road -m place.gpkg --config c.yaml --slice r.h --property "
                "roughness --json -q"));
  ASSERT_EQ(made.at("properties").size(), 2U);
  EXPECT_EQ(made.at("properties")[1].at("property"), "roughness");
  EXPECT_GT(made.at("properties")[1].at("values"), 100);
  EXPECT_NEAR(made.at("properties")[1].at("classes")[0].at("mean").get<double>(), 2.0, 0.1);
  EXPECT_NE(read_text(place.path("r.h")).find("roughness_evaluate"), std::string::npos);
  const MapLayers layers(place.file());
  const auto read = read_friction_layers(layers, read_path_layers(layers));
  ASSERT_EQ(read->map.prior().properties.size(), 2U);
  EXPECT_EQ(read->map.options().half_life_s, 1e9);
  EXPECT_TRUE(layers.has("roughness_mean"));
  EXPECT_EQ(place.run("roadbook export -m place.gpkg --format path -o p.csv").status, 0);
  EXPECT_NE(read_text(place.path("p.csv")).find("roughness_sigma"), std::string::npos);
  // With `--replace` and without the table, no layer of roughness remains.
  json_of(place.run("roadbook friction road -m place.gpkg --replace --json -q"));
  EXPECT_FALSE(MapLayers(place.file()).has("roughness_mean"));
}

}  // namespace
}  // namespace roadbook
