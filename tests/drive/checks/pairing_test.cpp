#include <cmath>

#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

// The images of one instant: stamps within a tolerance.

constexpr std::int64_t kInterval = 100'000'000;

// A drive of cameras without wheels; `stamp(camera, i)` of the i-th image, negative: no image.
template <typename Stamp>
fs::path write_cameras(const fs::path& folder,
                       std::size_t cameras,
                       int images,
                       const Stamp& stamp) {
  Rig rig;
  for (std::size_t c = 0; c < cameras; ++c) {
    MountedCamera camera = small_rig().cameras[0];
    camera.name = "cam" + std::to_string(c);
    rig.cameras.push_back(camera);
  }
  DriveWriter writer(folder, rig, std::nullopt, {});
  for (int i = 0; i < images; ++i)
    for (std::size_t c = 0; c < cameras; ++c)
      if (const std::int64_t t = stamp(c, i); t >= 0)
        writer.write_image(c, t, noise_image(16, 12, static_cast<std::uint64_t>(i) * 8 + c));
  writer.finish();
  return folder;
}

// Frames with images of all cameras.
std::size_t whole_frames(const Drive& drive) {
  std::size_t whole = 0;
  for (std::size_t f = 0; f < drive.frame_count(); ++f) {
    bool all = true;
    for (std::size_t c = 0; c < drive.rig().cameras.size(); ++c) all = all && drive.has_image(f, c);
    whole += all ? 1 : 0;
  }
  return whole;
}

TEST(Pairing, StampsThatDifferByMicrosecondsAreOneInstant) {
  const TemporaryFolder f;
  const auto stamp = [](std::size_t c, int i) {
    return kStart + i * kInterval + static_cast<std::int64_t>(c) * 1000;
  };
  const auto drive = Drive::open(write_cameras(f.path() / "d", 3, 20, stamp));
  EXPECT_EQ(all_lines(check_drive(f.path() / "d")), "");
  ASSERT_EQ(drive.frame_count(), 20u);
  EXPECT_EQ(whole_frames(drive), 20u);
  for (std::size_t i = 0; i < 20; ++i) {
    EXPECT_EQ(drive.frame_stamp_ns(i), stamp(0, static_cast<int>(i)));
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(drive.image_stamp_ns(i, c), stamp(c, static_cast<int>(i)));
      // The image itself, by its pixels: each has its own seed.
      const cv::Mat image = drive.read_image(i, c);
      ASSERT_FALSE(image.empty());
      EXPECT_EQ(cv::norm(image, noise_image(16, 12, i * 8 + c)), 0.0);
    }
  }
}

TEST(Pairing, JitterWithinTheToleranceAndLostImagesKeepTheInstants) {
  const TemporaryFolder f;
  const auto stamp = [](std::size_t c, int i) -> std::int64_t {
    if (c == 0 && i % 7 == 3) return -1;
    Random random(7, "jitter", static_cast<std::uint64_t>(i) * 4 + c);
    return kStart + i * kInterval + static_cast<std::int64_t>(random.below(4'900'000));
  };
  const auto drive = Drive::open(write_cameras(f.path() / "d", 2, 50, stamp));
  ASSERT_EQ(drive.frame_count(), 50u);
  EXPECT_EQ(whole_frames(drive), 43u);
  for (std::size_t i = 1; i < 50; ++i)
    EXPECT_GT(drive.frame_stamp_ns(i), drive.frame_stamp_ns(i - 1));
  // Where the first camera has no image, the instant has the stamp of the second.
  EXPECT_EQ(drive.frame_stamp_ns(3), stamp(1, 3));
  EXPECT_EQ(all_lines(check_drive(f.path() / "d")), "");
}

TEST(Pairing, BeyondTheToleranceCheckNamesTheCameraAndTheDifference) {
  for (const std::int64_t late : {20'000'000, -40'000'000}) {
    const TemporaryFolder f;
    const auto folder = write_cameras(f.path() / "d", 2, 20, [&](std::size_t c, int i) {
      return kStart + i * kInterval + (c == 1 ? late : 0);
    });
    const auto report = check_drive(folder);
    EXPECT_TRUE(report.usable);
    const std::string text = all_lines(report);
    EXPECT_NE(text.find("cam1/data.csv: timestamp: got 20 of 20 images about " +
                        std::string(late > 0 ? "20 ms after" : "40 ms before") + " those of cam0"),
              std::string::npos)
        << text;
    EXPECT_EQ(report.frames, 40u);
    DriveOptions wide;
    wide.stamp_tolerance_s = 0.045;
    EXPECT_EQ(Drive::open(folder, wide).frame_count(), 20u);
  }
}

TEST(Pairing, AFasterCameraOrOneWithFewerImagesIsNoFault) {
  const TemporaryFolder f;
  const auto stamp = [](std::size_t c, int i) -> std::int64_t {
    return c == 0 || i % 2 == 0 ? kStart + i * kInterval : -1;
  };
  const auto folder = write_cameras(f.path() / "d", 2, 40, stamp);
  EXPECT_EQ(all_lines(check_drive(folder)), "");
  EXPECT_EQ(whole_frames(Drive::open(folder)), 20u);
}

TEST(Pairing, ImagesOfAFastCameraAreNotMergedWithTheirNeighbours) {
  const TemporaryFolder f;
  // 500 Hz: two intervals lie within the tolerance of 5 ms. The second camera loses every third.
  const auto folder =
      write_cameras(f.path() / "d", 2, 60, [](std::size_t c, int i) -> std::int64_t {
        return c == 1 && i % 3 == 1 ? -1 : kStart + i * 2'000'000;
      });
  const auto drive = Drive::open(folder);
  ASSERT_EQ(drive.frame_count(), 60u);
  for (std::size_t i = 0; i < 60; ++i) EXPECT_EQ(drive.has_image(i, 1), i % 3 != 1);
}

}  // namespace
}  // namespace roadbook::test
