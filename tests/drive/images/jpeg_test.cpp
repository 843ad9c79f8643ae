#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "drive/images/jpeg_grey.hpp"
#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes jpeg_of(const cv::Mat& image, int progressive = 0) {
  Bytes bytes;
  cv::imencode(".jpg", image, bytes, {cv::IMWRITE_JPEG_PROGRESSIVE, progressive});
  return bytes;
}

std::optional<cv::Mat> decode(const Bytes& bytes) {
  return decode_grey_jpeg(bytes, inspect_image(std::span<const std::uint8_t>(bytes)));
}

cv::Mat smooth_image(std::uint64_t seed, int type) {
  cv::Mat image = noise_image(61 * CV_MAT_CN(type), 47, seed).reshape(CV_MAT_CN(type));
  cv::GaussianBlur(image, image, {5, 5}, 1.5);
  return image;
}

TEST(GreyJpeg, WholeFilesGiveThePixelsThatOpenCvGives) {
  for (std::uint64_t seed = 0; seed < 20; ++seed)
    for (const int type : {CV_8UC1, CV_8UC3}) {
      const Bytes bytes = jpeg_of(smooth_image(seed, type), seed % 2 == 0);
      const auto got = decode(bytes);
      ASSERT_TRUE(got) << seed;
      EXPECT_EQ(cv::norm(*got, cv::imdecode(bytes, cv::IMREAD_GRAYSCALE), cv::NORM_INF), 0.0);
    }
}

// The header and the end marker stay, so only decoding can find the damage. OpenCV returns an image
// in each case.
TEST(GreyJpeg, PixelsThatEndTooEarlyAreRefused) {
  const Bytes whole = jpeg_of(noise_image(61, 47, 1));
  for (std::size_t missing = 16; missing < whole.size() / 2; missing += 13) {
    Bytes cut(whole.begin(), whole.end() - 2 - static_cast<std::ptrdiff_t>(missing));
    cut.insert(cut.end(), whole.end() - 2, whole.end());
    ASSERT_FALSE(cv::imdecode(cut, cv::IMREAD_GRAYSCALE).empty()) << missing;
    EXPECT_FALSE(decode(cut)) << missing;
  }
}

TEST(GreyJpeg, ManglingNeverHarmsAndIsMostlySeen) {
  const Bytes whole = jpeg_of(smooth_image(1, CV_8UC1));
  int refused = 0;
  constexpr int kTrials = 500;
  for (std::uint64_t i = 0; i < kTrials; ++i) {
    Random random(6, "jpeg inside", i);
    Bytes bytes = whole;
    // A sector of a disk is lost: 64 bytes of other content among the pixels.
    const std::size_t at = whole.size() / 2 + random.below(whole.size() / 2 - 70);
    for (std::size_t k = 0; k < 64; ++k)
      bytes[at + k] = static_cast<std::uint8_t>(random.below(256));
    refused += !decode(bytes);
  }
  EXPECT_GT(refused, kTrials / 2);
}

TEST(GreyJpeg, ADriveCountsAJpegDamagedInsideOnceAndReadsNoPixelsOfIt) {
  const TemporaryFolder folder;
  const auto drive_folder = write_small_drive(folder.path() / "d");
  const auto file = drive_folder / "cam0/data" / (std::to_string(kStart + 3 * kFrame) + ".png");
  Bytes bytes = jpeg_of(noise_image(16, 12, 1));
  bytes.erase(bytes.end() - 60, bytes.end() - 2);
  write_text(file, std::string(bytes.begin(), bytes.end()));
  const Drive drive = Drive::open(drive_folder);
  EXPECT_TRUE(drive.warnings().empty());
  EXPECT_TRUE(drive.read_image(3, 0).empty());
  EXPECT_TRUE(drive.read_image_half(3, 0).empty());
  ASSERT_EQ(drive.warnings().size(), 1u);
  EXPECT_EQ(to_line(drive.warnings()[0]),
            "warning: " + file.string() + ": got damaged pixels, want an image");
}

}  // namespace
}  // namespace roadbook::test
