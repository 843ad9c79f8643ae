// Reading of recorded images: roadbook's decoders against OpenCV's, and opening a long drive.

#include <benchmark/benchmark.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string>

#include "base/random.hpp"
#include "drive/drive.hpp"
#include "drive/images/image_stream.hpp"
#include "drive/images/png_grey.hpp"
#include "drive/writer.hpp"

namespace {

namespace fs = std::filesystem;

constexpr int kWidth = 1280;
constexpr int kHeight = 960;

class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "roadbook_bench_XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("no temporary folder");
    path_ = pattern;
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() {
    std::error_code error;
    fs::remove_all(path_, error);
  }
  [[nodiscard]] const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

// Shapes of all sizes with camera noise (sigma 2), because the noise limits the compression.
cv::Mat scene() {
  roadbook::Random random(1, "scene");
  cv::Mat image(kHeight, kWidth, CV_8UC1, cv::Scalar(120));
  for (int i = 0; i < 400; ++i)
    cv::circle(image, {int(random.below(kWidth)), int(random.below(kHeight))},
               2 + int(random.below(60)), cv::Scalar(double(random.below(256))), cv::FILLED);
  cv::GaussianBlur(image, image, {5, 5}, 1.0);
  for (int y = 0; y < kHeight; ++y)
    for (int x = 0; x < kWidth; ++x) {
      auto& pixel = image.at<std::uint8_t>(y, x);
      pixel = cv::saturate_cast<std::uint8_t>(pixel + 2.0 * random.normal());
    }
  return image;
}

enum Kind : std::int64_t { kOwnPng, kOpenCvPng, kJpeg };

// "png" as DriveWriter writes it, as OpenCV does, and a JPEG of quality 95.
fs::path write_scene(const fs::path& folder, std::int64_t kind) {
  const fs::path file = folder / "image";
  std::vector<std::uint8_t> bytes;
  if (kind == kOwnPng)
    bytes = roadbook::encode_grey_png(scene());
  else
    cv::imencode(kind == kJpeg ? ".jpg" : ".png", scene(), bytes);
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
  return file;
}

void read_by_roadbook(benchmark::State& state) {
  const Folder folder;
  const fs::path file = write_scene(folder.path(), state.range(0));
  std::string why;
  for (auto _ : state)
    benchmark::DoNotOptimize(roadbook::decode_image_file(file, {kWidth, kHeight}, why));
  state.counters["file_kB"] = double(fs::file_size(file)) / 1e3;
}

void read_by_opencv(benchmark::State& state) {
  const Folder folder;
  const fs::path file = write_scene(folder.path(), state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(cv::imread(file.string(), cv::IMREAD_GRAYSCALE));
}

// Four cameras with tiny images, so the time is that of opening files and reading tables.
void open_drive(benchmark::State& state) {
  const Folder folder;
  const fs::path place = folder.path() / "drive";
  roadbook::Rig rig;
  for (int c = 0; c < 4; ++c) {
    roadbook::MountedCamera camera;
    camera.name = "cam" + std::to_string(c);
    camera.camera.model = roadbook::CameraModel::kKannalaBrandt;
    camera.camera.width = camera.camera.height = 8;
    camera.camera.parameters = {5, 5, 3.5, 3.5};
    rig.cameras.push_back(camera);
  }
  const cv::Mat image(8, 8, CV_8UC1, cv::Scalar(9));
  roadbook::DriveWriter writer(place, rig, std::nullopt);
  for (std::int64_t i = 0; i < state.range(0); ++i)
    for (std::size_t c = 0; c < 4; ++c) writer.write_image(c, i * 80'000'000, image);
  writer.finish();
  for (auto _ : state) benchmark::DoNotOptimize(roadbook::Drive::open(place).frame_count());
}

}  // namespace

BENCHMARK(read_by_roadbook)
    ->ArgName("kind")
    ->DenseRange(kOwnPng, kJpeg)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(read_by_opencv)
    ->ArgName("kind")
    ->DenseRange(kOwnPng, kJpeg)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(open_drive)
    ->Arg(1'000)
    ->Arg(10'000)
    ->Iterations(3)
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime()
    ->MeasureProcessCPUTime();
