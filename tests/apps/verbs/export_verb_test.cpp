#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "mapping/store/map_file_builder.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_store.hpp"
#include "tests/apps/label_server/lot.hpp"
#include "tests/apps/run_command.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

constexpr const char* kDegrees = " --latitude-deg 47.3769 --longitude-deg 8.5417";

// Writes a map with three spaces and a rejection. A second map then replaces it, without a pose at
// the second space and at the rejection.
void write_map_with_a_gap(const fs::path& file) {
  Map map = test::lot_map({});
  MapFileBuilder(file, "lot").finish(map, {});
  {
    LabelStore store(file);
    for (const auto& [k, kind] :
         std::vector<std::pair<std::size_t, std::string>>{{4, test::kSpace},
                                                          {8, test::kSpace},
                                                          {9, rejected_kind(test::kSpace)},
                                                          {20, test::kSpace}}) {
      Label label = label_of_box(store.map(), {0, map.keyframes[k].t_ns, 1},
                                 {{0.8 * static_cast<double>(k), 5.5}, 1.57, 5.0, 2.5});
      label.kind = kind;
      store.create(label, "ann");
    }
  }
  map.keyframes.erase(map.keyframes.begin() + 8, map.keyframes.begin() + 10);
  map.map_frames.erase(map.map_frames.begin() + 8, map.map_frames.begin() + 10);
  for (std::size_t k = 8; k < map.keyframes.size(); ++k)
    map.keyframes[k].map_frame = static_cast<int>(k);
  map.keyframes[8].after_gap = true;
  MapFileBuilder(file, "lot").finish(map, {});
}

TEST(ExportVerb, TellsHowManyLabelsItLeavesOutForWantOfAPlace) {
  const test::ScratchFolder folder;
  write_map_with_a_gap(folder.path() / "place.gpkg");
  const auto run = [&](const std::string& options) {
    return test::run_command("roadbook export -m place.gpkg " + options, folder.path());
  };
  const auto labels = run("-f geojson -o labels.geojson" + std::string(kDegrees));
  EXPECT_EQ(labels.status, 0) << labels.err;
  EXPECT_EQ(labels.err.rfind("warning: place.gpkg: labels without a place: got 1 of drive lot", 0),
            0U)
      << labels.err;
  const auto json = nlohmann::json::parse(test::read_text(folder.path() / "labels.geojson"));
  std::size_t spaces = 0;
  for (const auto& feature : json.at("features"))
    spaces += feature.at("properties").at("layer") == "parking_spaces" ? 1U : 0U;
  EXPECT_EQ(spaces, 2U);
  // A format without labels leaves no label out.
  const auto poses = run("-f tum -o poses.txt");
  EXPECT_EQ(poses.status, 0) << poses.err;
  EXPECT_EQ(poses.err.find("without a place"), std::string::npos) << poses.err;
}

TEST(ExportVerb, TellsHowManyLabelsItCutsAtTheEdgeOfTheImage) {
  const test::ScratchFolder folder;
  const fs::path file = folder.path() / "place.gpkg";
  test::Lot lot;
  lot.side_px = 400;  // ends at y = -4 m, in the spaces on the right
  test::write_lot(file, lot);
  {
    LabelStore store(file);
    for (const double side : {1.0, -1.0}) {
      Label label = label_of_box(store.map(), {0, store.map().keyframes[4].t_ns, 1},
                                 {{2.5, 5.5 * side}, 1.57, 5.0, 2.5});
      label.kind = test::kSpace;
      store.create(label, "ann");
    }
  }
  const auto told = [&](const std::string& format) {
    const auto run = test::run_command(
        "roadbook export -m place.gpkg -f " + format + " -o labels_" + format, folder.path());
    EXPECT_EQ(run.status, 0) << run.err;
    return run.err;
  };
  EXPECT_EQ(told("coco"), "");
  const std::string yolo = told("yolo");
  EXPECT_EQ(
      yolo.rfind("warning: place.gpkg: labels over the overhead image's edge: got 1, want none", 0),
      0U)
      << yolo;
}

// The layer that `speeds --truth` stores has no classes; the export of this layer adds them.
TEST(ExportVerb, OutlinesFromTruthComeBackAsLabels) {
  const test::ScratchFolder folder;
  const fs::path file = folder.path() / "place.gpkg";
  const test::Lot lot;
  test::write_lot(file, lot);
  const auto spaces = test::spaces_of(lot);
  {
    VectorLayer layer{
        "parking_spaces", "", GeometryType::kPolygonZ, {{"source", FieldType::kText}}, {}};
    for (const OrientedBox& space : spaces) {
      Feature feature;
      for (const Eigen::Vector2d& p : space.corners())
        feature.points.emplace_back(p.x(), p.y(), 0.0, 0.0);
      feature.points.push_back(feature.points.front());
      feature.values = {std::string("truth")};
      layer.features.push_back(feature);
    }
    MapUpdate update(file);
    update.write_layer(layer);
    update.commit();
  }
  const auto run = [&](const std::string& words) {
    const auto result = test::run_command("roadbook " + words + kDegrees, folder.path());
    EXPECT_EQ(result.status, 0) << result.err;
    return result;
  };
  run("export -m place.gpkg -f geojson -o all.geojson");
  run("import geojson all.geojson -m place.gpkg --who ann");
  EXPECT_EQ(read_labels(file).size(), spaces.size());
}

TEST(ExportVerb, CountsWhatAFormatCannotHold) {
  const test::ScratchFolder folder;
  const fs::path file = folder.path() / "place.gpkg";
  const test::Lot lot;
  Map map = test::lot_map(lot);
  map.landmarks.resize(7);
  for (Landmark& landmark : map.landmarks) landmark.covariance.setIdentity();
  MapFileBuilder(file, "lot").finish(map, {});
  const auto result = test::run_command(
      "roadbook export -m place.gpkg -f geojson -o layers --json" + std::string(kDegrees),
      folder.path());
  EXPECT_EQ(result.status, 0) << result.err;
  const auto json = nlohmann::json::parse(result.out);
  EXPECT_EQ(json.at("files"), nlohmann::json::array({"layers/poses.geojson"}));
  EXPECT_EQ(json.at("left_out").at(0).at("count"), 7);
  EXPECT_NE(result.err.find("7 features of layer landmark_points: not in the file"),
            std::string::npos)
      << result.err;
}

TEST(ExportVerb, CountsWhatAPlannersFormatCannotHold) {
  const test::ScratchFolder folder;
  const fs::path file = folder.path() / "place.gpkg";
  test::write_lot(file, {});
  {
    LabelStore store(file);
    Label label = label_of_box(store.map(), {0, store.map().keyframes[4].t_ns, 1},
                               {{3.2, 5.5}, 1.57, 5.0, 2.5});
    label.kind = test::kSpace;
    store.create(label, "ann");
  }
  const auto run = [&](const std::string& command) {
    const auto result = test::run_command("roadbook " + command, folder.path());
    EXPECT_EQ(result.status, 0) << result.err;
    return result;
  };
  run("roads -m place.gpkg");
  const std::string plain = "export -m place.gpkg -f lanelet2 -o place.osm" + std::string(kDegrees);
  const auto json = nlohmann::json::parse(run(plain + " --json").out);
  ASSERT_EQ(json.at("left_out").size(), 1U) << json;
  EXPECT_EQ(json.at("left_out")[0].at("what"), "links of parking spaces to lanes");
  EXPECT_EQ(json.at("left_out")[0].at("count"), 1);
  EXPECT_NE(run(plain).err.find("1 links of parking spaces to lanes: not in the file: "),
            std::string::npos);
  const auto autoware = nlohmann::json::parse(run(plain + " --profile autoware --json").out);
  EXPECT_EQ(autoware.at("left_out").size(), 0U) << autoware;
  EXPECT_NE(test::read_text(folder.path() / "place.osm").find("parking_space"), std::string::npos);
}

}  // namespace
}  // namespace roadbook
