#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "drive/true_poses.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/labels/label_store.hpp"
#include "sim/simulate.hpp"
#include "sim/world/layout.hpp"
#include "tests/apps/run_command.hpp"

// `roadbook map --equal-rows` on a drive of half a round, whose spaces are labelled by the truth.

namespace roadbook {
namespace {

namespace fs = std::filesystem;

void label_all_spaces(const fs::path& file, const fs::path& drive, const Scenario& scenario) {
  LabelStore store(file);
  const Map& map = store.map();
  const Eigen::Isometry3d T_map_world =
      map.T_map_vehicle(0) * true_poses(Drive::open(drive)).front().T_world_vehicle.inverse();
  std::vector<Label> labels;
  for (const ParkingSpace& space : make_layout(scenario).spaces) {
    const Eigen::Vector3d middle =
        T_map_world * Eigen::Vector3d(space.centre.x(), space.centre.y(), 0.0);
    const OrientedBox box{middle.head<2>(), space.heading + heading_of(T_map_world), 5.0, 2.5};
    const auto corners = box.corners();
    const auto anchor = most_central_view(map, {corners.begin(), corners.end()});
    if (!anchor) continue;
    labels.push_back(label_of_box(map, *anchor, box));
    labels.back().kind = "parking_space";
  }
  store.create_all(labels, "ann");
}

nlohmann::json map_again(const std::string& options, const fs::path& folder) {
  fs::copy_file(folder / "place.gpkg", folder / "again.gpkg", fs::copy_options::overwrite_existing);
  const auto result =
      test::run_command("roadbook map drive -m again.gpkg -q --json " + options, folder);
  EXPECT_EQ(result.status, 0) << result.err;
  return nlohmann::json::parse(result.out);
}

TEST(EqualRowsVerb, RowsTakePartWhereTheyAreAskedForAndNowhereElse) {
  const test::ScratchFolder scratch;
  const fs::path folder = scratch.path();
  const Scenario scenario = load_scenario("stuttgart", {.size = "small", .image_scale = 0.5});
  SimulateOptions options;
  options.max_duration_s = 10.0;
  simulate(scenario, folder / "drive", options);
  ASSERT_EQ(test::run_command("roadbook map drive -m place.gpkg -q", folder).status, 0);
  const auto no_labels = map_again("--equal-rows", folder);
  EXPECT_EQ(no_labels["rows"]["used"], 0);
  label_all_spaces(folder / "place.gpkg", folder / "drive", scenario);

  const auto off = map_again("", folder);
  EXPECT_FALSE(off.contains("rows"));
  const Map without = load_map(folder / "again.gpkg");
  const auto on = map_again("--equal-rows --threads 1", folder);
  EXPECT_GE(on["rows"]["used"], 1);
  EXPECT_GE(on["rows"]["spaces"], 8);
  const Map with = load_map(folder / "again.gpkg");
  ASSERT_EQ(with.keyframes.size(), without.keyframes.size());
  EXPECT_NE(with.T_map_vehicle(40).matrix(), without.T_map_vehicle(40).matrix());
  EXPECT_EQ(map_again("--equal-rows --threads 2", folder)["digest"], on["digest"]);
  EXPECT_EQ(map_again("", folder)["digest"], off["digest"]);
}

}  // namespace
}  // namespace roadbook
