#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "exchange/layers/path_layers.hpp"
#include "tests/apps/friction_place.hpp"

// Tests `roadbook query` and the report page about the layers that `query` reads.

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;
using test::FrictionPlace;
using test::json_of;
using test::read_text;
using test::write_text;

// A user asks the query that a planner asks. The gradients are compared with finite differences.
TEST(QueryVerb, TellsWhatIsKnownAtAPlaceOfALane) {
  const FrictionPlace place;
  ASSERT_EQ(place.run("roadbook roads -m place.gpkg").status, 0);
  EXPECT_EQ(place.run("roadbook query -m place.gpkg --lane 1 --s 3").status, 2) << "no speeds yet";
  json_of(place.run("roadbook friction road -m place.gpkg --json -q"));
  json_of(place.run("roadbook speeds -m place.gpkg --json"));
  const MapLayers layers(place.file());
  const std::string lane = std::to_string(read_path_layers(layers).front().lane);
  const auto ask = [&](double s, double e) {
    std::ostringstream command;
    command << "roadbook query -m place.gpkg --json --lane " << lane << " --s " << std::fixed << s
            << " --e " << e;
    return json_of(place.run(command.str())).at("answers").at(0);
  };
  const Json here = ask(10.0, 0.4);
  EXPECT_GT(here.at("ground").at("asphalt"), 0.5);
  EXPECT_EQ(here.at("place"), "lane");
  const double h = 0.01;
  const double slope = (ask(10.0 + h, 0.4)["properties"]["friction"]["value"].get<double>() -
                        ask(10.0 - h, 0.4)["properties"]["friction"]["value"].get<double>()) /
                       (2.0 * h);
  EXPECT_NEAR(here["properties"]["friction"]["d_ds"].get<double>(), slope, 1e-4);
  // The query by coordinates must give the values of the same ground.
  std::ostringstream at;
  at << "roadbook query -m place.gpkg --json --at " << here.at("x_m") << "," << here.at("y_m");
  bool found = false;
  const Json by_coordinates = json_of(place.run(at.str()));
  for (const Json& answer : by_coordinates.at("answers"))
    if (answer.at("lane") == lane) {
      found = true;
      EXPECT_NEAR(answer.at("s_m").get<double>(), 10.0, 1e-6);
      EXPECT_NEAR(answer.at("speed_mps").at("value").get<double>(),
                  here.at("speed_mps").at("value").get<double>(), 1e-6);
    }
  EXPECT_TRUE(found);
  // The report shows both maps over the same ground, and the profiles.
  std::filesystem::create_directories(place.path("evaluation"));
  write_text(place.path("evaluation/kl.svg"), "<svg xmlns=\"http://www.w3.org/2000/svg\"/>");
  ASSERT_EQ(place.run("roadbook report -m place.gpkg -o r.html --evaluation evaluation").status, 0);
  const std::string page = read_text(place.path("r.html"));
  for (const char* part : {"Speed map: recommended speed", "Friction map: mean friction",
                           "Speed profiles", "allowed by grip", "<h2>Experiments", "kl.svg"})
    EXPECT_NE(page.find(part), std::string::npos) << part;
  EXPECT_EQ(place.run("roadbook report -m place.gpkg -o r.html --evaluation road/cam0").status, 2);
  const auto loaded =
      place.run("LD_DEBUG=libs roadbook query -m place.gpkg --lane " + lane + " --s 3");
  EXPECT_EQ(loaded.status, 0);
  if (ROADBOOK_LATE_LIBRARIES) {
    EXPECT_EQ(loaded.err.find("libgdal"), std::string::npos) << "a tenth of a second";
  }
  const auto outside = place.run("roadbook query -m place.gpkg --at 900,900");
  EXPECT_EQ(outside.status, 1);
  EXPECT_NE(outside.err.find("--at: got 900,900"), std::string::npos) << outside.err;
  EXPECT_EQ(place.run("roadbook query -m place.gpkg --lane " + lane + " --s 1e5").status, 1);
}

}  // namespace
}  // namespace roadbook
