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
TEST(PaintWatch, LabelsWhosePaintIsGoneAreToldUntilAPersonHasLookedAtThem) {
  test::TwoDrives drives;
  for (int i = 4; i < 9; ++i) drives.second.repainted.insert(i);
  const auto images = drives.images(drives.poses());
  const auto folder =
      std::filesystem::temp_directory_path() / ("paint_watch." + std::to_string(getpid()));
  std::filesystem::create_directories(folder);
  const auto file = folder / "map.gpkg";
  {
    Map first = drives.map;
    first.sessions.resize(1);
    std::erase_if(first.keyframes, [](const Keyframe& k) { return k.session > 0; });
    first.map_frames.resize(first.keyframes.size());
    MapBuild(file, "first").finish(first, {});
    LabelStore(file).create_all(drives.spaces(), "ann");
  }
  MapBuild(file, "both").finish(drives.map, {});
  const auto watched = [&] {
    LabelStore store(file);
    EventHub hub;
    const std::vector<std::optional<Drive>> none(2);
    const PeopleImages people(&store.map(), &none, {}, 0.4);
    const LabelBook book(&store, &hub, &people, {});
    const auto told = hub.subscribe();
    const PaintWatch watch(&book, images, &hub);
    for (std::string text; text.find("done") == std::string::npos;)
      text += told->next(std::chrono::seconds(60)).value_or("done");
    return watch.gone();
  };
  const auto before = watched();
  EXPECT_EQ(before.at("session"), "drive1");
  EXPECT_EQ(before.at("looked"), 2 * test::kSpaces);
  int right = 0;
  for (const auto& one : before.at("gone")) {
    const auto space = one.at("id").get<int>() - 1;  // ids count from 1
    right += drives.second.repainted.contains(space) ? 1 : 0;
  }
  EXPECT_GE(right, 4);
  EXPECT_LE(before.at("gone").size(), 6U);
  {
    LabelStore store(file);
    for (const auto& one : before.at("gone")) store.change(*store.find(one.at("id")), "bob");
  }
  const auto after = watched();
  EXPECT_EQ(after.at("looked"), 2 * test::kSpaces - before.at("gone").size());
  EXPECT_TRUE(after.at("gone").empty());
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace roadbook
