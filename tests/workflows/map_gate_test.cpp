#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/imgcodecs.hpp>

#include "mapping/pieces.hpp"
#include "mapping/store/map_file.hpp"
#include "tests/apps/run_command.hpp"
#include "tests/apps/shared_drives.hpp"
#include "tests/workflows/recorded_messages.hpp"
#include "workflows/map_drives.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// Rendered drives from which no map may be made, or not without a word.
class MapGates : public testing::Test {
 protected:
  // Simulates some seconds in a small place.
  [[nodiscard]] fs::path drive(const std::string& place, const std::string& name) const {
    const auto made =
        test::simulate_drive(place + " --size small --max-duration-s 6 --image-scale 0.5 --visit 0",
                             folder_.path() / name);
    EXPECT_EQ(made.status, 0) << made.err;
    return folder_.path() / name;
  }
  [[nodiscard]] fs::path map() const { return folder_.path() / "place.gpkg"; }

  [[nodiscard]] MapResult build(const std::vector<fs::path>& drives, bool apart = false) const {
    MapRequest request;
    request.drives = drives;
    request.map = map();
    request.options.gate.apart = apart;
    test::RecordedMessages messages;
    return map_drives(request, messages);
  }
  [[nodiscard]] std::string refusal(const std::vector<fs::path>& drives) const {
    try {
      (void)build(drives);
    } catch (const Refused& refused) {
      return refused.what();
    }
    return "";
  }

  test::ScratchFolder folder_;
};

// Replaces every image of the camera.
template <typename Change>
void change_images(const fs::path& drive, int camera, const Change& change) {
  for (const auto& entry :
       fs::directory_iterator(drive / ("cam" + std::to_string(camera)) / "data")) {
    const cv::Mat grey = cv::imread(entry.path().string(), cv::IMREAD_GRAYSCALE);
    ASSERT_TRUE(cv::imwrite(entry.path().string(), change(grey)));
  }
}

cv::Mat all_grey(const cv::Mat& image) { return {image.size(), CV_8UC1, cv::Scalar(90)}; }

TEST_F(MapGates, ImagesOfOneGreyMakeNoMap) {
  const fs::path grey = drive("zurich", "grey");
  for (int c = 0; c < 4; ++c) change_images(grey, c, all_grey);
  const std::string line = refusal({grey});
  EXPECT_NE(line.find("landmarks: got 0, want at least 30"), std::string::npos) << line;
  EXPECT_FALSE(fs::exists(map()));
}

TEST_F(MapGates, OneCameraInFourMakesNoMap) {
  const fs::path covered = drive("zurich", "covered");
  for (const int c : {0, 1}) change_images(covered, c, all_grey);
  const MapResult two = build({covered});
  std::string warned;
  for (const Problem& warning : two.summary.warnings)
    if (warning.field == "landmarks") warned += fs::path(warning.file).filename().string() + " ";
  EXPECT_EQ(warned, "cam0 cam1 ");
  ASSERT_EQ(two.summary.cameras.size(), 4U);
  EXPECT_FALSE(two.summary.cameras[0].fit_share.has_value());
  EXPECT_GT(two.summary.cameras[3].fit_share.value_or(0.0), 0.9);
  fs::remove(map());
  change_images(covered, 2, all_grey);
  const std::string line = refusal({covered});
  EXPECT_NE(line.find("cameras: got 1 of 4 in use, hardly a landmark in cam0, cam1, cam2"),
            std::string::npos)
      << line;
}

TEST_F(MapGates, ADriveOfAnotherPlaceLeavesTheMapAsItIs) {
  const fs::path here = drive("zurich", "here");
  const fs::path elsewhere = drive("stuttgart", "elsewhere");
  (void)build({here});
  const std::string before = test::read_text(map());
  const std::string line = refusal({elsewhere});
  EXPECT_EQ(line.find("error: " + map().string() + ": sessions: got " + elsewhere.string() +
                      " with 0 of "),
            0U)
      << line;
  EXPECT_NE(line.find("want a drive of its place (--apart keeps it as a map of its own)"),
            std::string::npos)
      << line;
  EXPECT_EQ(test::read_text(map()), before);

  const MapResult apart = build({elsewhere}, true);
  EXPECT_EQ(apart.summary.components, 2U);
  const Map pieces = load_map(map());
  for (const Keyframe& keyframe : pieces.keyframes) EXPECT_EQ(keyframe.piece, keyframe.session);
  EXPECT_THROW((void)load_joined_map(map()), Refused);
  for (const char* verb : {"roads", "overhead", "label", "speeds", "detect",
                           "export --format tum -o out", "diagnose here", "friction here"}) {
    const auto run = test::run_command(
        std::string("roadbook ") + verb + " -m place.gpkg -q < /dev/null", folder_.path());
    EXPECT_EQ(run.status, 4) << verb << run.err;
    EXPECT_NE(run.err.find("pieces: got 2 that nothing joins"), std::string::npos)
        << verb << run.err;
  }
}

TEST_F(MapGates, UnscaledTwelveBitsGiveTheMapOfEightBits) {
  const fs::path drive_of_bits = drive("zurich", "bits");
  (void)build({drive_of_bits});
  const Map eight = load_map(map());
  fs::remove(map());
  for (int c = 0; c < 4; ++c)
    change_images(drive_of_bits, c, [](const cv::Mat& grey) {
      cv::Mat deep;
      grey.convertTo(deep, CV_16UC1, 16.0);
      return deep;
    });
  const MapResult made = build({drive_of_bits});
  const Map twelve = load_map(map());
  ASSERT_EQ(eight.landmarks.size(), twelve.landmarks.size());
  for (std::size_t i = 0; i < eight.landmarks.size(); ++i)
    EXPECT_EQ(eight.landmarks[i].p_frame, twelve.landmarks[i].p_frame);
  const auto& warnings = made.summary.warnings;
  EXPECT_EQ(std::count_if(warnings.begin(), warnings.end(),
                          [](const Problem& p) { return p.got.find("16-bit") == 0; }),
            4);
}

}  // namespace
}  // namespace roadbook
