#include "drive/images/grey_range.hpp"

#include <opencv2/imgcodecs.hpp>

#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

// 16-bit images: 8-bit images are the truth, from which deeper ones are made.

// Writes the images of camera 0 again with 16 bits: grey * factor + offset.
void deepen(const fs::path& drive, int factor, int offset) {
  for (const auto& entry : fs::directory_iterator(drive / "cam0" / "data")) {
    const cv::Mat grey = cv::imread(entry.path().string(), cv::IMREAD_GRAYSCALE);
    cv::Mat deep;
    grey.convertTo(deep, CV_16UC1, factor, offset);
    ASSERT_TRUE(cv::imwrite(entry.path().string(), deep));
  }
}

int largest_difference(const Drive& a, const Drive& b) {
  double largest = 0.0;
  for (std::size_t frame = 0; frame < a.frame_count(); ++frame) {
    const cv::Mat left = a.read_image(frame, 0);
    const cv::Mat right = b.read_image(frame, 0);
    EXPECT_FALSE(left.empty() || right.empty());
    largest = std::max(largest, cv::norm(left, right, cv::NORM_INF));
  }
  return static_cast<int>(largest);
}

TEST(GreyRange, UnscaledBitsGiveTheImagesOfEightBits) {
  const TemporaryFolder f;
  const Drive eight = Drive::open(write_small_drive(f.path() / "eight"));
  for (const int factor : {1, 4, 16, 64, 256}) {
    const auto folder = write_small_drive(f.path() / std::to_string(factor));
    deepen(folder, factor, 0);
    const Drive deep = Drive::open(folder);
    EXPECT_EQ(largest_difference(eight, deep), 0) << factor;
    const auto lines = lines_with(check_drive(folder), "16-bit");
    EXPECT_EQ(lines.size(), factor == 256 ? 0U : 1U) << factor;
    for (const auto& line : lines) {
      EXPECT_NE(line.find("cam0"), std::string::npos) << line;
      EXPECT_NE(line.find("0 to " + std::to_string(256 * factor - 1)), std::string::npos) << line;
    }
  }
}

// An image scaled by its own range would be brighter than its neighbours.
TEST(GreyRange, ADarkImageStaysDark) {
  const TemporaryFolder f;
  const auto folder = write_small_drive(f.path() / "drive");
  const Drive eight = Drive::open(folder);
  const auto file = eight.image_path(7, 0);
  cv::Mat dark = eight.read_image(7, 0) / 10;
  ASSERT_TRUE(cv::imwrite(file.string(), dark));
  deepen(folder, 4, 0);
  const cv::Mat read = Drive::open(folder).read_image(7, 0);
  EXPECT_EQ(cv::norm(dark, read, cv::NORM_INF), 0.0);
}

// Thermal cameras: few greys far from black. They must not fall into a handful of values.
TEST(GreyRange, GreysFarFromBlackKeepTheirDifferences) {
  const TemporaryFolder f;
  const Drive eight = Drive::open(write_small_drive(f.path() / "eight"));
  const auto folder = write_small_drive(f.path() / "deep");
  deepen(folder, 2, 7000);
  const Drive deep = Drive::open(folder);
  const cv::Mat expected = eight.read_image(3, 0);
  const cv::Mat read = deep.read_image(3, 0);
  double least = 0.0;
  double most = 0.0;
  cv::minMaxLoc(read, &least, &most);
  EXPECT_GT(least, 30.0);
  EXPECT_LT(most, 225.0);
  EXPECT_GT(most - least, 100.0);
  for (int y = 0; y < expected.rows; ++y)
    for (int x = 1; x < expected.cols; ++x)
      if (expected.at<std::uint8_t>(y, x) > expected.at<std::uint8_t>(y, x - 1)) {
        EXPECT_GE(read.at<std::uint8_t>(y, x), read.at<std::uint8_t>(y, x - 1));
      }
}

TEST(GreyRange, ClassImagesKeepTheirIndices) {
  const TemporaryFolder f;
  const auto folder = write_small_drive(f.path() / "drive");
  const cv::Mat before = Drive::open(folder).read_segmentation(0, 1);
  ASSERT_FALSE(before.empty());
  for (const auto& entry : fs::directory_iterator(folder / "segmentation1" / "data")) {
    cv::Mat deep;
    before.convertTo(deep, CV_16UC1);
    ASSERT_TRUE(cv::imwrite(entry.path().string(), deep));
  }
  const cv::Mat after = Drive::open(folder).read_segmentation(0, 1);
  EXPECT_EQ(cv::norm(before, after, cv::NORM_INF), 0.0);
}

TEST(GreyRange, BlackImagesHaveNoRangeOfTheirOwn) {
  EXPECT_EQ(grey_range(0, 0).span, 65536);
  EXPECT_EQ(grey_range(0, 3).span, 256);
  EXPECT_EQ(grey_range(0, 1023).span, 1024);
  EXPECT_EQ(grey_range(0, 1024).span, 2048);
  EXPECT_FALSE(measured_grey_range({}, 1).has_value());
}

}  // namespace
}  // namespace roadbook::test
