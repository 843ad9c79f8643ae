#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "exchange/layers/friction_carry.hpp"
#include "exchange/layers/path_layers.hpp"
#include "tests/apps/friction_place.hpp"

// Friction and speeds after the map is optimised again or gets other paths.

namespace roadbook {
namespace {

using Json = nlohmann::ordered_json;
using test::FrictionPlace;
using test::json_of;
using test::read_text;

// Poses after the map is optimised again: they drift smoothly by up to 0.9 m and 2 degrees, as
// after a loop closure.
Eigen::Isometry3d drifted(const Eigen::Isometry3d& T) {
  const Eigen::Vector3d p = T.translation();
  Eigen::Isometry3d moved = T;
  moved.translation() +=
      Eigen::Vector3d(0.5 * std::sin(p.x() / 30.0), 0.9 * std::sin(p.x() / 40.0), 0.0);
  moved.linear() =
      Eigen::AngleAxisd(std::atan(0.9 / 40.0 * std::cos(p.x() / 40.0)), Eigen::Vector3d::UnitZ()) *
      T.linear();
  return moved;
}

TEST(FrictionVerb, FrictionGoesWithTheGroundWhenTheMapIsOptimisedAgain) {
  const FrictionPlace place;
  ASSERT_EQ(place.run("roadbook roads -m place.gpkg").status, 0);
  json_of(place.run("roadbook friction road -m place.gpkg --json -q"));
  json_of(place.run("roadbook speeds -m place.gpkg --json"));
  const Map before = load_map(place.file());
  const MapLayers layers_before(place.file());
  const auto old = read_friction_layers(layers_before, read_path_layers(layers_before));

  place.write_map({"road"}, drifted);
  const Json roads = json_of(place.run("roadbook roads -m place.gpkg --json"));
  EXPECT_EQ(roads.at("friction_carried"), true);
  EXPECT_LT(roads.at("friction_evidence_dropped").get<double>(),
            0.001 * roads.at("friction_evidence_kept").get<double>());
  EXPECT_NEAR(roads.at("friction_evidence_kept").get<double>(), old->carry.evidence,
              0.001 * old->carry.evidence);

  // The test moves a piece of ground with the pose that saw it, as a label is moved, and looks up
  // its friction at the new place.
  const Map after = load_map(place.file());
  const MapLayers layers(place.file());
  const auto now = read_friction_layers(layers, read_path_layers(layers));
  ASSERT_TRUE(now);
  EXPECT_FALSE(now->carry.moved) << "carried over for good";
  std::vector<PathPlace> a;
  std::vector<PathPlace> b;
  double most_moved = 0.0;
  int compared = 0;
  for (std::size_t k = 5; k + 5 < before.keyframes.size(); k += 3)
    for (const double left : {-1.5, 0.0, 1.5}) {
      const Eigen::Vector3d label(1.0, left, 0.0);
      const Eigen::Vector3d p = before.T_map_vehicle(static_cast<int>(k)) * label;
      const Eigen::Vector3d q = after.T_map_vehicle(static_cast<int>(k)) * label;
      old->strips.places_of(p.head<2>(), a);
      now->strips.places_of(q.head<2>(), b);
      if (a.size() != 1 || b.size() != 1) continue;
      const auto was = old->map.moments_with_derivatives(0, a.front());
      const auto is = now->map.moments(0, b.front());
      ASSERT_TRUE(was && is);
      // The difference is at most the field's own slope over 5 cm, plus the blur of a bent kernel.
      EXPECT_NEAR(was->mean, is->mean, 0.05 * was->d_mean.norm() + 0.004) << p.transpose();
      most_moved = std::max(most_moved, (p - q).norm());
      ++compared;
    }
  EXPECT_GT(compared, 100);
  EXPECT_GT(most_moved, 0.5);

  // The speeds belong to the old paths, so the program refuses to export them. After another
  // `roadbook speeds`, the export works.
  json_of(place.run("roadbook speeds -m place.gpkg --json"));
  EXPECT_EQ(place.run("roadbook export -m place.gpkg --format path -o p.json").status, 0);
}

TEST(FrictionVerb, SpeedsOfOtherPathsAreRefusedUntilTheyAreMadeAnew) {
  const FrictionPlace place;
  ASSERT_EQ(place.run("roadbook roads -m place.gpkg").status, 0);
  json_of(place.run("roadbook speeds -m place.gpkg --json"));
  EXPECT_EQ(place.run("roadbook roads -m place.gpkg").status, 0);
  EXPECT_EQ(place.run("roadbook export -m place.gpkg --format path -o p.csv").status, 0)
      << "the same paths again";
  const auto roads = place.run("roadbook roads -m place.gpkg --vehicle-width-m 3.2 --reach-m 2");
  ASSERT_EQ(roads.status, 0) << roads.err;
  EXPECT_NE(roads.err.find("run `roadbook speeds` again"), std::string::npos) << roads.err;
  const auto page_says_so = [&] {
    EXPECT_EQ(place.run("roadbook report -m place.gpkg -o r.html").status, 0);
    return read_text(place.path("r.html")).find("was made on other paths") != std::string::npos;
  };
  EXPECT_TRUE(page_says_so());
  for (const char* format : {"path -o q.csv", "nav2 -o q.pgm"}) {
    const auto result = place.run("roadbook export -m place.gpkg --format " + std::string(format));
    EXPECT_EQ(result.status, 2) << format;
    EXPECT_NE(result.err.find("run `roadbook speeds` on the map"), std::string::npos) << result.err;
  }
  json_of(place.run("roadbook speeds -m place.gpkg --json"));
  EXPECT_FALSE(page_says_so());
  EXPECT_EQ(place.run("roadbook export -m place.gpkg --format path -o q.csv").status, 0);
}

}  // namespace
}  // namespace roadbook
