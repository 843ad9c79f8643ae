#include <algorithm>
#include <opencv2/videoio.hpp>

#include "drive/images/image_files.hpp"
#include "tests/drive/foreign_recordings.hpp"

namespace roadbook::test {
namespace {

// Which image belongs to which stamp.

std::vector<std::string> numbered_names(const std::string& before,
                                        int count,
                                        const std::string& after) {
  std::vector<std::string> names;
  for (int i = 0; i < count; ++i) names.push_back(before + std::to_string(i) + after);
  return names;
}

std::vector<int> ten_each(int count) {
  std::vector<int> values;
  for (int i = 0; i < count; ++i) values.push_back(10 * i + 1);
  return values;
}

TEST(ImageFiles, NamesAreOrderedByTheirNumbers) {
  const std::vector<std::vector<std::string>> orders = {
      {"0", "1", "2", "9", "10", "11", "100"},
      {"frame2", "frame12", "Frame13", "frame100"},
      {"cam0_9", "cam0_10", "cam1_1"},
      {"007", "8", "0010"},
      {"999999999999999999", "1000000000000000000", "123456789012345678901234567890"},
      {"1.25", "1.5", "2.0625"},
      {"v.9", "v.10"}};
  for (const auto& order : orders)
    for (std::size_t i = 0; i < order.size(); ++i)
      for (std::size_t j = 0; j < order.size(); ++j)
        EXPECT_EQ(precedes_by_number(order[i], order[j]), i < j) << order[i] << " " << order[j];
  EXPECT_FALSE(precedes_by_number("1", "01"));
  EXPECT_FALSE(precedes_by_number("01", "1"));
}

// Sorting needs a strict weak order for all names.
TEST(ImageFiles, TheOrderOfRandomNamesIsTransitive) {
  Random random(7, "names");
  const std::string letters = "0019aA._-";
  const auto name = [&] {
    std::string text;
    for (std::uint64_t i = 0, n = random.below(6); i < n; ++i)
      text += letters[random.below(letters.size())];
    return text;
  };
  for (int i = 0; i < 200'000; ++i) {
    const std::string a = name(), b = name(), c = name();
    ASSERT_FALSE(precedes_by_number(a, b) && precedes_by_number(b, a)) << a << " " << b;
    if (precedes_by_number(a, b) && precedes_by_number(b, c)) {
      ASSERT_TRUE(precedes_by_number(a, c)) << a << " " << b << " " << c;
    }
    const bool same_ab = !precedes_by_number(a, b) && !precedes_by_number(b, a);
    const bool same_bc = !precedes_by_number(b, c) && !precedes_by_number(c, b);
    if (same_ab && same_bc) {
      ASSERT_FALSE(precedes_by_number(a, c) || precedes_by_number(c, a))
          << a << " " << b << " " << c;
    }
  }
}

TEST(ImportFrames, KittiImagesComeInTheOrderOfTheirNumbers) {
  for (const auto& names : {numbered_names("", 12, ".png"), numbered_names("frame", 12, ".png"),
                            numbered_names("left_", 12, ".PNG"), numbered_names("0", 12, ".png")}) {
    const TemporaryFolder f;
    const auto s = write_kitti(f.path() / "s", names, kitti_times(12));
    EXPECT_EQ(try_import("kitti", s, f.path() / "out").text, "");
    EXPECT_EQ(greys(f.path() / "out"), ten_each(12)) << names.front();
  }
}

TEST(ImportFrames, NamesWhoseOrderIsNotCertainAreRefused) {
  const TemporaryFolder f;
  const auto twice = write_kitti(f.path() / "a", {"0.png", "1.png", "01.png"}, kitti_times(3));
  ROADBOOK_EXPECT_TEXT(try_import("kitti", twice, f.path() / "o").text,
                       "image_0: images: got 01.png and 1.png, want one image for each number");
  const auto mixed = write_kitti(f.path() / "b", {"a0.png", "b1.png"}, kitti_times(2));
  ROADBOOK_EXPECT_TEXT(try_import("kitti", mixed, f.path() / "o").text,
                       "got a0.png and b1.png, want names that differ only in their numbers");
  const auto formats = write_kitti(f.path() / "c", {"0.png", "0.jpg"}, kitti_times(2));
  EXPECT_TRUE(try_import("kitti", formats, f.path() / "o").refused);
}

TEST(ImportFrames, MoreOrFewerKittiImagesThanStampsNameBothCounts) {
  const TemporaryFolder f;
  const auto more = write_kitti(f.path() / "a", numbered_names("", 5, ".png"), kitti_times(3));
  ROADBOOK_EXPECT_TEXT(try_import("kitti", more, f.path() / "o").text,
                       "images: got 5, want 3 as times.txt has");
  // The numbers do not begin at 0, so the importer cannot know whether the first or the last image
  // is missing.
  const auto from_one = write_kitti(f.path() / "b", {"1.png", "2.png"}, kitti_times(3));
  ROADBOOK_EXPECT_TEXT(try_import("kitti", from_one, f.path() / "o").text, "images: got 2, want 3");
}

TEST(ImportFrames, AKittiFrameThatIsMissingLeavesTheOthersAtTheirTimes) {
  const TemporaryFolder f;
  const auto s = write_kitti(f.path() / "s", {"0.png", "1.png", "3.png"}, kitti_times(4));
  write_text(f.path() / "s/poses.txt",
             "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1\n1 0 0 0 0 1 0 0 0 0 1 2\n"
             "1 0 0 0 0 1 0 0 0 0 1 3\n");
  const auto made = try_import("kitti", s, f.path() / "out");
  ROADBOOK_EXPECT_TEXT(made.text, "images: got 3 for 4 stamps");
  EXPECT_EQ(frame_stamps_ns(f.path() / "out"),
            (std::vector<std::int64_t>{0, 100'000'000, 300'000'000}));
  const auto truth = Drive::open(f.path() / "out").truth();
  ASSERT_EQ(truth.size(), 4u);
  EXPECT_NEAR(truth[3].T_world_vehicle.translation().x(), 3.0, 1e-12);
}

TEST(ImportFrames, ABlankLineOfKittiTimesIsAFrameThatWasLost) {
  const TemporaryFolder f;
  const auto s = write_kitti(f.path() / "s", {"0.png", "1.png", "3.png"}, "0.0\n0.1\n\n0.3\n\n");
  write_text(f.path() / "s/poses.txt",
             "1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 0 0 1 0 0 0 0 1 1\n \n1 0 0 0 0 1 0 0 0 0 1 3\n");
  EXPECT_EQ(try_import("kitti", s, f.path() / "out").text, "");
  EXPECT_EQ(frame_stamps_ns(f.path() / "out"),
            (std::vector<std::int64_t>{0, 100'000'000, 300'000'000}));
  const auto truth = Drive::open(f.path() / "out").truth();
  ASSERT_EQ(truth.size(), 3u);
  EXPECT_EQ(truth[2].t_ns, 300'000'000);
  EXPECT_NEAR(truth[2].T_world_vehicle.translation().x(), 3.0, 1e-12);
  // An image for the lost frame contradicts the blank line.
  write_flat_image(s / "image_0/2.png", 1);
  ROADBOOK_EXPECT_TEXT(try_import("kitti", s, f.path() / "o").text,
                       "times.txt:3: time: got a blank line, want the time of 2.png");
}

const std::string kDay = "2013-05-28 08:46:0";

TEST(ImportFrames, ABlankLineOfKitti360StampsKeepsTheFramesBehindItAligned) {
  for (const char* const prefix : {"", "000000000"}) {
    const TemporaryFolder f;
    std::vector<std::string> names;
    for (const char* const n : {"0", "1", "3", "4"})
      names.push_back(prefix + std::string(n) + ".png");
    const auto s = write_kitti360(
        f.path(), names, kDay + "2.0\n" + kDay + "2.1\n\n" + kDay + "2.3\n" + kDay + "2.4\n\n\n");
    write_text(f.path() / "data_poses/seq/poses.txt", "3 1 0 0 30 0 -1 0 0 0 0 -1 0\n");
    EXPECT_EQ(try_import("kitti360", s, f.path() / "out").text, "");
    const auto stamps = frame_stamps_ns(f.path() / "out");
    ASSERT_EQ(stamps.size(), 4u);
    EXPECT_EQ(stamps[2] - stamps[0], 300'000'000);
    EXPECT_EQ(stamps[3] - stamps[0], 400'000'000);
    EXPECT_EQ(Drive::open(f.path() / "out").truth()[0].t_ns, stamps[2]);
  }
}

TEST(ImportFrames, Kitti360CountsAndDoubledNumbersAreSaid) {
  const TemporaryFolder f;
  const std::string three = kDay + "2.0\n" + kDay + "2.1\n" + kDay + "2.2\n";
  const auto more = write_kitti360(f.path() / "a", numbered_names("", 4, ".png"), three);
  ROADBOOK_EXPECT_TEXT(try_import("kitti360", more, f.path() / "o").text,
                       "frame: got 3, want 0 to 2, as timestamps.txt has 3 lines");
  const auto fewer = write_kitti360(f.path() / "b", {"0.png", "2.png"}, three);
  ROADBOOK_EXPECT_TEXT(try_import("kitti360", fewer, f.path() / "o2").text,
                       "images: got 2 for 3 stamps");
  const auto twice = write_kitti360(f.path() / "c", {"0.png", "1.png", "001.png"}, three);
  ROADBOOK_EXPECT_TEXT(try_import("kitti360", twice, f.path() / "o3").text,
                       "got 001.png and 1.png, want one image for each number");
  const auto blank =
      write_kitti360(f.path() / "d", {"0.png", "1.png"}, kDay + "2.0\n\n" + kDay + "2.2\n");
  ROADBOOK_EXPECT_TEXT(
      try_import("kitti360", blank, f.path() / "o4").text,
      "timestamps.txt:2: time: got a blank line, want the stamp of frame 1, which 1.png has");
}

TEST(ImportFrames, CapitalsInExtensionsAreReadAndNoImageIsSaid) {
  const TemporaryFolder f;
  const std::string two = kDay + "2.0\n" + kDay + "2.1\n";
  const auto s = write_kitti360(f.path() / "a", {"0.PNG", "1.Png"}, two);
  EXPECT_EQ(try_import("kitti360", s, f.path() / "out").text, "");
  EXPECT_EQ(greys(f.path() / "out"), ten_each(2));
  const auto none = write_kitti360(f.path() / "b", {"0.tif"}, two);
  ROADBOOK_EXPECT_TEXT(try_import("kitti360", none, f.path() / "o").text,
                       "data_rgb: images: got no .png or .jpg file");
}

// MJPEG frames of 40, 50, 60, ... grey.
fs::path write_video(const fs::path& folder, int frames, const std::string& stamps) {
  fs::create_directories(folder);
  cv::VideoWriter video((folder / "v.avi").string(), cv::VideoWriter::fourcc('M', 'J', 'P', 'G'),
                        10.0, {64, 48}, false);
  EXPECT_TRUE(video.isOpened());
  for (int i = 0; i < frames; ++i) video.write(cv::Mat(48, 64, CV_8UC1, cv::Scalar(40 + 10 * i)));
  video.release();
  write_text(folder / "frames.csv", "#timestamp [ns]\n" + stamps);
  write_text(folder / "sensor.yaml",
             "sensor_type: camera\nT_BS: {rows: 4, cols: 4, data: [0,0,1,0, -1,0,0,0, 0,-1,0,1, "
             "0,0,0,1]}\nresolution: [64, 48]\ncamera_model: pinhole\nintrinsics: [40, 40, 31.5, "
             "23.5]\ndistortion_model: none\n");
  return folder;
}

TEST(ImportFrames, AVideoWithMoreOrFewerFramesThanStampsIsRefusedWithBothCounts) {
  const TemporaryFolder f;
  const auto longer = write_video(f.path() / "a", 5, "0\n100000000\n200000000\n");
  ROADBOOK_EXPECT_TEXT(try_import("video", longer, f.path() / "o").text,
                       "v.avi: frames: got 5 for 3 stamps, want one stamp for each frame");
  const auto shorter = write_video(f.path() / "b", 2, "0\n100000000\n200000000\n");
  ROADBOOK_EXPECT_TEXT(try_import("video", shorter, f.path() / "o").text,
                       "frames: got 2 for 3 stamps, want one stamp for each frame");
}

TEST(ImportFrames, AVideoOfHalfTheSizeIsSaidToBeSo) {
  const TemporaryFolder f;
  const auto s = write_video(f.path() / "a", 2, "0\n100000000\n");
  std::string yaml = read_text(s / "sensor.yaml");
  yaml.replace(yaml.find("[64, 48]"), 8, "[128, 96]");
  write_text(s / "sensor.yaml", yaml);
  ROADBOOK_EXPECT_TEXT(try_import("video", s, f.path() / "o").text,
                       "frame: got 64x48 (half the size: resolution and intrinsics times 0.5?), "
                       "want 128x96, the camera's resolution");
}

TEST(ImportFrames, ABlankLineOfVideoStampsIsAFrameWithoutStamp) {
  const TemporaryFolder f;
  const auto s = write_video(f.path() / "a", 4, "0\n100000000\n\n300000000\n");
  EXPECT_FALSE(try_import("video", s, f.path() / "out").refused);
  EXPECT_EQ(frame_stamps_ns(f.path() / "out"),
            (std::vector<std::int64_t>{0, 100'000'000, 300'000'000}));
  const auto grey = greys(f.path() / "out");
  ASSERT_EQ(grey.size(), 3u);
  EXPECT_NEAR(grey[2], 70, 4);  // the fourth frame, not the third
  const auto fewer = write_video(f.path() / "b", 3, "0\n100000000\n\n300000000\n");
  ROADBOOK_EXPECT_TEXT(try_import("video", fewer, f.path() / "o").text,
                       "frames: got 3 for 3 stamps and 1 blank lines");
}

// Two runs of digits: the files' order is not that of the frame numbers, which come last.
TEST(ImportFrames, NumbersBeyondTheStampsOrGivenTwiceAreRefused) {
  const TemporaryFolder f;
  const auto beyond =
      write_kitti(f.path() / "a", {"1_0.png", "1_9.png", "2_2.png"}, kitti_times(4));
  ROADBOOK_EXPECT_TEXT(try_import("kitti", beyond, f.path() / "o").text,
                       "1_9.png: name: got 1_9, want a frame number from 0 to 3");
  const auto twice = write_kitti(f.path() / "b", {"1_0.png", "1_1.png", "2_1.png"}, kitti_times(4));
  ROADBOOK_EXPECT_TEXT(try_import("kitti", twice, f.path() / "o").text,
                       "2_1.png: name: got frame 1 again, want one image for each frame (1_1.png");
  const auto other = write_kitti360(f.path() / "c", {"1_0.png", "2_0.png"},
                                    "2013-05-28 08:46:02.1\n2013-05-28 08:46:02.2\n");
  ROADBOOK_EXPECT_TEXT(try_import("kitti360", other, f.path() / "o").text,
                       "2_0.png: name: got frame 0 again, want one image for each frame (1_0.png");
}

}  // namespace
}  // namespace roadbook::test
