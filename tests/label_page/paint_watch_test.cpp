#include "apps/label_server/paint_watch.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "mapping/map_build.hpp"
#include "tests/semantics/two_drives.hpp"

namespace roadbook {
namespace {

// Five spaces are painted anew between two drives; whoever drew them knew the first alone.
class PaintWatchTest : public ::testing::Test {
 protected:
  PaintWatchTest()
      : folder_(std::filesystem::temp_directory_path() /
                ("paint_watch." + std::to_string(getpid()) + "." +
                 ::testing::UnitTest::GetInstance()->current_test_info()->name())) {
    for (int i = 4; i < 9; ++i) drives_.second.repainted.insert(i);
    std::filesystem::create_directories(folder_);
    Map first = drives_.map;
    first.sessions.resize(1);
    std::erase_if(first.keyframes, [](const Keyframe& k) { return k.session > 0; });
    first.map_frames.resize(first.keyframes.size());
    MapBuild(file(), "first").finish(first, {});
    LabelStore(file()).create_all(drives_.spaces(), "ann");
  }
  ~PaintWatchTest() override { std::filesystem::remove_all(folder_); }

  std::filesystem::path file() const { return folder_ / "map.gpkg"; }

  // When it has looked through.
  nlohmann::json watched() const {
    LabelStore store(file());
    EventHub hub;
    const std::vector<std::optional<Drive>> none(store.map().sessions.size());
    const PeopleImages people(&store.map(), &none, {}, 0.4);
    const LabelBook book(&store, &hub, &people, {});
    const auto told = hub.subscribe();
    const PaintWatch watch(&book, drives_.images(drives_.poses()), &hub);
    for (std::string text; text.find("done") == std::string::npos;)
      text += told->next(std::chrono::seconds(60)).value_or("done");
    return watch.gone();
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
  std::filesystem::path folder_;
};

TEST_F(PaintWatchTest, LabelsWhosePaintIsGoneAreToldUntilAPersonHasLookedAtThem) {
  MapBuild(file(), "both").finish(drives_.map, {});
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

TEST_F(PaintWatchTest, ASessionThatDidNotComeByLeavesTheWordToTheOneBefore) {
  Map& map = drives_.map;
  map.sessions.push_back(map.sessions.back());
  map.sessions.back().name = "drive2";
  Keyframe far = map.keyframes.back();
  far.session = 2;
  far.map_frame = static_cast<int>(map.map_frames.size());
  map.map_frames.push_back({pose_from_planar(500.0, 0.0, 0.0)});
  map.keyframes.push_back(far);
  MapBuild(file(), "three").finish(map, {});
  expect_the_repainted(watched());
}

}  // namespace
}  // namespace roadbook
