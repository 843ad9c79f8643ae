#include "apps/label_server/marking_check.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/semantics/two_drives_files.hpp"

namespace roadbook {
namespace {

// Five spaces were painted again between two drives; their labels were drawn with the first drive.
class PaintWatchTest : public ::testing::Test {
 protected:
  using Keep = std::function<void(LabelStore&, LabelService&, const std::vector<StoredSighting>&)>;

  PaintWatchTest()
      : folder_(std::filesystem::temp_directory_path() /
                ("paint_watch." + std::to_string(getpid()) + "." +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    for (int i = 4; i < 9; ++i) drives_.second.repainted.insert(i);
    std::filesystem::create_directories(folder_);
    test::write_first_drive(file(), drives_);
  }
  ~PaintWatchTest() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path file() const { return folder_ / "map.gpkg"; }

  // Waits until the check has ended. `keep`: whether to store its results.
  nlohmann::json watched(const Keep& keep = store_them) {
    LabelStore store(file());
    EventHub hub;
    const std::vector<std::optional<Drive>> none(store.map().sessions.size());
    const PeopleImages people(&store.map(), &none, {}, 0.4);
    LabelService service(&store, &hub, &people, {});
    const auto told = hub.subscribe();
    const PaintWatch watch(&service, drives_.images(truth_), &hub,
                           read_label_sightings(MapLayers(file())),
                           [&](const auto& found) { keep(store, service, found); });
    told_.clear();
    while (told_.find("done") == std::string::npos && told_.find("failed") == std::string::npos)
      told_ += told->next(std::chrono::seconds(60)).value_or("done");
    return watch.report();
  }
  static void store_them(LabelStore& store,
                         LabelService& /*service*/,
                         const std::vector<StoredSighting>& found) {
    store.write_table(label_sightings_table(found));
  }
  [[nodiscard]] std::size_t stored() const {
    return read_label_sightings(MapLayers(file())).size();
  }

  void expect_the_repainted(const nlohmann::json& report) const {
    EXPECT_EQ(report.at("looked"), 2 * test::kSpaces);
    int right = 0;
    for (const auto& one : report.at("gone")) {
      const auto space = one.at("id").get<int>() - 1;  // ids count from 1
      right += drives_.second.repainted.contains(space) ? 1 : 0;
      EXPECT_EQ(one.at("session"), "drive1");
    }
    EXPECT_GE(right, 4);
    EXPECT_LE(report.at("gone").size(), 6U);
  }

  test::TwoDrives drives_;
  const std::vector<Eigen::Isometry3d> truth_ = drives_.poses();
  std::filesystem::path folder_;
  std::string told_;  ///< to the pages, by the last look
};

TEST_F(PaintWatchTest, LabelsWhosePaintIsGoneAreToldUntilAPersonHasLookedAtThem) {
  MapFileBuilder(file(), "both").finish(drives_.map, {});
  const auto before = watched();
  expect_the_repainted(before);
  {
    LabelStore store(file());
    for (const auto& one : before.at("gone")) store.change(*store.find(one.at("id")), "bob");
  }
  const auto after = watched();
  EXPECT_EQ(after.at("looked"), 2 * test::kSpaces - before.at("gone").size());
  EXPECT_TRUE(after.at("gone").empty());
}

// Deleting and restoring, confirming and unconfirming a label: no user has looked at the paint, so
// the label stays listed as changed.
TEST_F(PaintWatchTest, WhatIsTakenBackIsToldAgain) {
  MapFileBuilder(file(), "both").finish(drives_.map, {});
  const auto before = watched().at("gone");
  ASSERT_GE(before.size(), 2U);
  {
    LabelStore store(file());
    const Label one = *store.find(before.at(0).at("id"));
    store.remove(one.id, one.version, "bob");
    store.change(*store.find(before.at(1).at("id")), "bob");
    store.undo("bob", {}, {.count = 2});
  }
  const auto after = watched().at("gone");
  ASSERT_EQ(after.size(), before.size());
  EXPECT_EQ(after.at(0).at("id"), before.at(0).at("id"));
  EXPECT_EQ(after.at(0).at("version"), 3);
}

TEST_F(PaintWatchTest, ASessionThatDidNotComeByLeavesTheWordToTheOneBefore) {
  Map& map = drives_.map;
  map.sessions.push_back(map.sessions.back());
  map.sessions.back().name = "drive2";
  Keyframe far = map.keyframes.back();
  far.session = 2;
  far.map_frame = static_cast<int>(map.map_frames.size());
  map.map_frames.push_back({pose_from_planar(500.0, 0.0, 0.0)});
  map.keyframes.push_back(far);
  MapFileBuilder(file(), "three").finish(map, {});
  expect_the_repainted(watched());
}

// Most labels whose paint did not change are found again. What a user does meanwhile stays. Results
// for an earlier version of a label do not count.
TEST_F(PaintWatchTest, WhatItFindsIsStoredBesideWhatPeopleSay) {
  MapFileBuilder(file(), "both").finish(drives_.map, {});
  std::int64_t shifted = 0;
  const auto report = watched([&](LabelStore& store, LabelService& service, const auto& found) {
    ASSERT_FALSE(found.empty());
    shifted = found.front().label;
    (void)service.change(shifted, {{"who", "bob"}, {"version", 1}, {"length", 4.7}});
    store_them(store, service, found);
    store.create(*store.find(found.back().label), "bob");
  });
  const auto& further = report.at("further");
  EXPECT_EQ(report.at("looked"), 2 * test::kSpaces);
  EXPECT_GE(further.size(), 18U);
  EXPECT_LE(further.size() + report.at("gone").size(), 2U * test::kSpaces);
  for (const auto& one : further) {
    EXPECT_NE(one.at("id"), shifted);
    EXPECT_EQ(one.at("images").size(), 1U);
    EXPECT_EQ(one.at("images")[0].at("session"), "drive1");
    EXPECT_FALSE(one.at("contradicts")) << one;
    EXPECT_LT(one.at("apart_m"), 0.1) << one;
  }
  EXPECT_EQ(stored(), further.size() + 1);
  const auto labels = read_labels(file());
  EXPECT_EQ(labels.size(), 2U * test::kSpaces + 1);
  EXPECT_EQ(labels.back().who, "bob");
  EXPECT_EQ(labels[static_cast<std::size_t>(shifted) - 1].version, 2);
}

// The second drive's poses run ahead by 3 %: labels from 10 m on lie apart by 40 cm and more.
TEST_F(PaintWatchTest, ABendOfTheMapIsToldOfTheLabelsThatShowIt) {
  test::bend_second_drive(drives_, 0.03);
  MapFileBuilder(file(), "bent").finish(drives_.map, {});
  int far = 0;
  const auto report = watched();
  for (const auto& one : report.at("further")) {
    const int place = one.at("id").get<int>() - 1 - test::kSpaces;  // on the right: nothing is new
    const double x = place * test::kWide;
    if (x < 10.0 || x > 25.0) continue;
    ++far;
    EXPECT_TRUE(one.at("contradicts")) << one;
    EXPECT_GT(one.at("sigmas"), 3.7) << one;
    EXPECT_NEAR(one.at("apart_m"), 0.03 * (x + 4.0), 0.15) << one;
  }
  EXPECT_GE(far, 6);
}

TEST_F(PaintWatchTest, WhatIsKnownStaysAndIsNotStoredAgain) {
  MapFileBuilder(file(), "both").finish(drives_.map, {});
  const auto first = watched();
  int again = 0;
  const auto second = watched([&](const auto&...) { ++again; });
  EXPECT_EQ(again, 0);
  EXPECT_EQ(second, first);
  // Without images, the check still reports what is stored.
  LabelStore store(file());
  EventHub hub;
  const std::vector<std::optional<Drive>> none(2);
  const PeopleImages people(&store.map(), &none, {}, 0.4);
  const LabelService service(&store, &hub, &people, {});
  const PaintWatch blind(&service, {}, &hub, read_label_sightings(MapLayers(file())));
  EXPECT_EQ(blind.report().at("further"), first.at("further"));
}

TEST_F(PaintWatchTest, ADiskThatTakesNoMoreCostsNoLabelAndIsTold) {
  MapFileBuilder(file(), "both").finish(drives_.map, {});
  const auto report = watched([](LabelStore& store, const auto&...) {
    store.create(store.labels().front(), "ann");
    throw StorageError("map.gpkg: the disk is full");
  });
  EXPECT_NE(told_.find("the disk is full"), std::string::npos) << told_;
  EXPECT_GE(report.at("further").size(), 18U);
  EXPECT_EQ(stored(), 0U);
  EXPECT_EQ(read_labels(file()).size(), 2U * test::kSpaces + 1);
}

}  // namespace
}  // namespace roadbook
