#include "workflows/compare/compare_files.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <map>

#include "base/error.hpp"
#include "mapping/store/map_file.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/mapping/store/small_map.hpp"

namespace roadbook {
namespace {

using Lines = std::vector<std::vector<Eigen::Vector3d>>;

Eigen::Isometry3d quarter_turn() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  T.translation() << 5.0, -7.0, 0.0;
  return T;
}

Label box_at(const Map& map, std::int64_t id, const Eigen::Vector3d& place, const char* kind) {
  Label label;
  label.id = id;
  label.kind = kind;
  label.anchor.t_ns = map.keyframes[0].t_ns;
  label.T_vehicle_label.translation() = place;
  return label;
}

Map map_at(const Eigen::Isometry3d& T) {
  Map map;
  map.sessions.resize(1);
  map.map_frames.resize(1);
  for (int i = 0; i < 3; ++i) {
    Keyframe keyframe;
    keyframe.t_ns = 1'000'000'000 * std::int64_t{i};
    keyframe.T_frame_vehicle = T * Eigen::Translation3d(i, 0.0, 0.0);
    map.keyframes.push_back(keyframe);
  }
  return map;
}

TEST(CompareLabels, CountsByIdAndMeasuresInTheFrameOfA) {
  const Map a = map_at(Eigen::Isometry3d::Identity());
  const Map b = map_at(quarter_turn());
  const std::vector<Label> in_a{
      box_at(a, 1, {4, 2, 0}, "crossing"), box_at(a, 2, {5, 2, 0}, "crossing"),
      box_at(a, 3, {6, 2, 0}, "crossing"), box_at(a, 4, {7, 2, 0}, "crossing")};
  const std::vector<Label> in_b{
      box_at(b, 1, {4.09, 2, 0}, "crossing"), box_at(b, 2, {5, 2.11, 0}, "crossing"),
      box_at(b, 3, {6, 2, 0}, "parking_space"), box_at(b, 7, {7, 2, 0}, "crossing"),
      box_at(b, 9, {8, 2, 0}, "crossing")};
  const LabelComparison c = compare_labels(a, in_a, b, in_b, quarter_turn().inverse());
  EXPECT_EQ(c.both, 3U);
  EXPECT_EQ(c.only_a, 1U);
  EXPECT_EQ(c.only_b, 2U);
  EXPECT_EQ(c.kind_changed, 1U);
  EXPECT_EQ(c.compared, 3U);
  EXPECT_EQ(c.moved, std::vector<std::int64_t>{2});
  EXPECT_EQ(compare_labels(a, in_a, b, in_b, std::nullopt).compared, 0U);
}

TEST(CompareLanes, ShareOfTheLengthAfterTheMotion) {
  const Lines a{{{0, 0, 0}, {80, 0, 0}}};
  Lines b{{{0, 0, 0}, {40, 0, 0}}, {{0, 30, 0}, {60, 30, 0}}};
  for (auto& line : b)
    for (Eigen::Vector3d& p : line) p = quarter_turn() * p;
  const LaneComparison c = compare_lanes(a, b, quarter_turn().inverse());
  EXPECT_NEAR(c.length_a_m, 80.0, 1e-9);
  EXPECT_NEAR(c.length_b_m, 100.0, 1e-9);
  EXPECT_NEAR(*c.share_a, 40.5 / 80.0, 0.1 / 80.0);
  EXPECT_NEAR(*c.share_b, 0.4, 1e-9);
  EXPECT_FALSE(compare_lanes(a, b, std::nullopt).share_a.has_value());
  EXPECT_EQ(*compare_lanes(a, {}, quarter_turn()).share_a, 0.0);
  EXPECT_FALSE(compare_lanes(a, {}, quarter_turn()).share_b.has_value());
}

TEST(CompareFiles, AFileIsItselfAndLayersAreToldApart) {
  const test::Folder folder;
  const auto a = folder / "a.gpkg";
  MapFileBuilder(a, "key").finish(test::small_map(1), {});
  const auto add = [](const std::filesystem::path& map, const std::string& table, double value) {
    MapUpdate update(map);
    update.write_table({table, {{"value", FieldType::kReal}}, {{value}}});
    update.commit();
  };
  add(a, "same", 1.0);
  const auto b = folder / "b.gpkg";
  std::filesystem::copy_file(a, b);
  add(a, "changed", 1.0);
  add(b, "changed", 2.0);
  add(a, "first", 1.0);
  add(b, "second", 1.0);
  const FileComparison c = compare_files(a, b);
  ASSERT_EQ(c.maps.poses.size(), 24U);
  EXPECT_NEAR(c.maps.poses[*c.maps.worst].distance_m, 0.0, 1e-9);
  EXPECT_EQ(c.layers.only_a, std::vector<std::string>{"first"});
  EXPECT_EQ(c.layers.only_b, std::vector<std::string>{"second"});
  std::map<std::string, bool> same;
  for (const CommonLayer& layer : c.layers.both) same[layer.name] = layer.same;
  EXPECT_TRUE(same.at("same"));
  EXPECT_TRUE(same.at("poses"));
  EXPECT_FALSE(same.at("changed"));
}

TEST(CompareFiles, WhatIsNoMapIsRefused) {
  const test::Folder folder;
  const auto a = folder / "a.gpkg";
  MapFileBuilder(a, "key").finish(test::small_map(1), {});
  EXPECT_THROW((void)compare_files(a, folder / "none.gpkg"), BadInput);
  const auto text = folder / "text.gpkg";
  std::ofstream(text) << "no map";
  EXPECT_THROW((void)compare_files(a, text), BadInput);
  EXPECT_THROW((void)compare_files(text, a), BadInput);
}

}  // namespace
}  // namespace roadbook
