#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "base/messages.hpp"
#include "tests/pipeline/malaga_pairs.hpp"
#include "tests/pipeline/visits.hpp"
#include "tests/support/real_data.hpp"
#include "workflows/localisation/localisation_files.hpp"
#include "workflows/localisation/localise_in_map.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;
using test::Visits;

LocaliseResult localised(const fs::path& drive, const fs::path& map, int num_threads = 0) {
  LocaliseRequest request;
  request.drive = drive;
  request.map = map;
  request.options.tracking.num_threads = num_threads;
  NoMessages messages;
  return localise_in_map(request, messages);
}

std::vector<TimedFrame> without_times(std::vector<TimedFrame> frames) {
  for (TimedFrame& frame : frames) frame.cpu_ms = 0.0;
  return frames;
}

std::string bytes_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::stringstream bytes;
  bytes << in.rdbuf();
  return bytes.str();
}

// A later visit, with other parked cars and people, in the map of the first one.
TEST_F(Visits, AreLocalisedInTheMapOfTheFirstWithoutAGuess) {
  const fs::path second = drives()[1];
  const fs::path map = map_of_first("place.gpkg");
  const std::string before = bytes_of(map);
  const LocaliseResult result = localised(second, map, 1);
  EXPECT_EQ(bytes_of(map), before);
  const LocalisationFigures& f = result.figures;
  EXPECT_FALSE(result.refusal);
  EXPECT_EQ(f.localised, f.frames);
  EXPECT_TRUE(f.lost.empty());
  ASSERT_TRUE(f.truth);
  // The map itself is off by 1.1 cm in the median: the images have 320 x 240 pixels.
  EXPECT_LT(f.truth->median_m, 0.02);
  EXPECT_LT(f.truth->p95_m, 0.05);
  EXPECT_LT(f.truth->max_m, 0.15);
  EXPECT_LT(f.truth->heading_median_rad, 0.1 / 57.3);
  EXPECT_LT(f.truth->heading_p95_rad, 0.3 / 57.3);
  EXPECT_GE(f.truth->recall_0_1_m, 0.99);
  ASSERT_TRUE(f.jump_p999_m);
  EXPECT_LT(*f.jump_p999_m, 0.03);
  ASSERT_TRUE(f.truth->nees);
  EXPECT_GT(*f.truth->nees, 0.3);
  EXPECT_LT(*f.truth->nees, 2.0);
  EXPECT_GT(*f.truth->in_ellipse, 0.9);

  // The same bytes on two threads.
  const LocaliseResult again = localised(second, map, 2);
  EXPECT_EQ(localised_tum(again.frames, true), localised_tum(result.frames, true));
  const Map loaded = load_map(map);
  EXPECT_EQ(localised_csv(without_times(again.frames), loaded),
            localised_csv(without_times(result.frames), loaded));

  // Without a guess, and not allowed to search the whole map.
  LocaliseRequest wrong;
  wrong.drive = second;
  wrong.map = map;
  wrong.want = 1.0;
  wrong.options.localiser.may_relocalise = false;
  NoMessages messages;
  const LocaliseResult lost = localise_in_map(wrong, messages);
  ASSERT_TRUE(lost.refusal) << "without a start pose";
  EXPECT_EQ(lost.figures.localised, 0U);
  EXPECT_EQ(lost.figures.lost.size(), 1U);
  wrong.options.start = StartPose{0.5, -0.5, 0.1};
  EXPECT_EQ(localise_in_map(wrong, messages).figures.localised, f.frames);
}

// The frames of a drive for which `keep` is true, as a drive of its own that shares the images.
fs::path some_frames(const fs::path& drive, const fs::path& copy, bool (*keep)(std::size_t)) {
  fs::create_directories(copy / "cam0" / "data");
  fs::copy_file(drive / "cam0" / "sensor.yaml", copy / "cam0" / "sensor.yaml");
  std::ifstream rows(drive / "cam0" / "data.csv");
  std::ofstream table(copy / "cam0" / "data.csv");
  std::string row;
  std::getline(rows, row);
  table << row << '\n';
  for (std::size_t i = 0; std::getline(rows, row); ++i) {
    if (!keep(i)) continue;
    table << row << '\n';
    const std::string image = row.substr(row.find(',') + 1);
    fs::create_symlink(fs::absolute(drive / "cam0" / "data" / image),
                       copy / "cam0" / "data" / image);
  }
  if (fs::exists(drive / "state_groundtruth_estimate0"))
    fs::copy(drive / "state_groundtruth_estimate0", copy / "state_groundtruth_estimate0");
  return copy;
}

TEST(LocaliseRecorded, MalagaIsFoundWhereItsPairsAreAndNowhereElse) {
  ROADBOOK_REQUIRE_DATA(a, "drives/malaga07_a");
  ROADBOOK_REQUIRE_DATA(b, "drives/malaga07_b");
  ROADBOOK_REQUIRE_DATA(kitti, "drives/kitti00");
  const auto folder = test::fresh_folder("localise_malaga");
  static_cast<void>(build_map({a}, folder / "a.gpkg", {}));
  const LocaliseResult of_b = localised(b, folder / "a.gpkg");
  const Map map = load_map(folder / "a.gpkg");
  std::size_t right = 0;
  for (const TimedFrame& frame : of_b.frames) {
    if (frame.pose.status == LocalisationStatus::kLost) continue;
    const int in_a = map.keyframes[static_cast<std::size_t>(frame.pose.keyframe)].drive_frame;
    const double expected =
        test::frame_of_malaga_a(1600.0 + 2.0 * static_cast<double>(frame.pose.frame));
    EXPECT_NEAR(2.0 * in_a, expected, 16.0) << frame.pose.frame;
    ++right;
  }
  EXPECT_GE(static_cast<double>(right), 0.95 * static_cast<double>(of_b.frames.size()));
  // The car drives at most 15 m/s, 1.5 m between frames: steps are even without wheels too.
  for (std::size_t i = 2; i < of_b.frames.size(); ++i) {
    const auto& f = of_b.frames;
    if (f[i - 2].pose.status == LocalisationStatus::kLost) continue;
    const auto place = [&](std::size_t k) { return f[k].pose.T_map_vehicle.translation().eval(); };
    EXPECT_LT((place(i) - 2.0 * place(i - 1) + place(i - 2)).norm(), 0.5) << i;
  }
  // Another town, and the part of the way that b never drives.
  EXPECT_EQ(localised(kitti, folder / "a.gpkg").figures.localised, 0U);
  static_cast<void>(build_map({b}, folder / "b.gpkg", {}));
  const fs::path late = some_frames(a, folder / "late", [](std::size_t i) { return i >= 100; });
  const LocaliseResult elsewhere = localised(late, folder / "b.gpkg");
  EXPECT_EQ(elsewhere.figures.localised, 0U);
  ASSERT_TRUE(elsewhere.refusal);
}

// One camera, no wheels: every second frame against the reference, after the alignment of the map
// of the other frames.
TEST(LocaliseRecorded, Kitti00BetweenTheFramesOfItsMap) {
  ROADBOOK_REQUIRE_DATA(kitti, "drives/kitti00");
  const auto folder = test::fresh_folder("localise_kitti");
  const fs::path even =
      some_frames(kitti, folder / "even", [](std::size_t i) { return i % 2 == 0; });
  const fs::path odd = some_frames(kitti, folder / "odd", [](std::size_t i) { return i % 2 == 1; });
  static_cast<void>(build_map({even}, folder / "even.gpkg", {}));
  const Map map = load_map(folder / "even.gpkg");
  const TrajectoryError of_map = test::error_of(map, Drive::open(even), true);
  const LocaliseResult result = localised(odd, folder / "even.gpkg");
  // At five frames a second, one frame in a bend contradicts the velocity of the frames before.
  EXPECT_GE(result.figures.localised, result.figures.frames - 2);
  const auto truth = Drive::open(odd).truth();
  std::vector<double> off_m;
  for (const TimedFrame& frame : result.frames)
    if (const auto T = true_pose_at(truth, frame.pose.t_ns))
      off_m.push_back(
          (of_map.T_reference_estimate * frame.pose.T_map_vehicle.translation() - T->translation())
              .norm());
  ASSERT_GT(off_m.size(), 55U);
  std::nth_element(off_m.begin(), off_m.begin() + off_m.size() / 2, off_m.end());
  const double median_m = off_m[off_m.size() / 2];
  RecordProperty("median_m", std::to_string(median_m));
  RecordProperty("map_median_m", std::to_string(of_map.median_m));
  // Localisation adds nothing to the error of the map itself.
  EXPECT_LT(median_m, of_map.median_m + 0.05);
}

}  // namespace
}  // namespace roadbook
