#include <opencv2/core/mat.hpp>

#include "drive/images/png_grey.hpp"
#include "drive/import/import.hpp"
#include "tests/fuzz/fuzz_support.hpp"

using namespace roadbook;

namespace {

std::string small_png() {
  const auto bytes = encode_grey_png(cv::Mat(12, 16, CV_8UC1, cv::Scalar(90)));
  return {bytes.begin(), bytes.end()};
}

void put_images(const fuzz::fs::path& folder, const char* ending) {
  static const std::string png = small_png();
  for (int i = 0; i < 3; ++i) fuzz::put(folder / ("00000000" + std::to_string(i) + ending), png);
}

}  // namespace

// The first byte chooses the importer; the parts of the rest are its text files.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const auto parts = fuzz::parts_of(fuzz::text_of(data + 1, size - 1), 4);
  const fuzz::fs::path root = fuzz::work_folder() / "source";
  fuzz::fs::remove_all(root);
  const char* format = "";
  switch (data[0] % 4) {
    case 0:
      format = "kitti";
      put_images(root / "image_0", ".png");
      fuzz::put(root / "calib.txt", parts[0]);
      fuzz::put(root / "times.txt", parts[1]);
      fuzz::put(root / "poses.txt", parts[2]);
      break;
    case 1:
      format = "kitti360";
      put_images(root / "image_02" / "data_rgb", ".png");
      fuzz::put(root / "calibration" / "image_02.yaml", parts[0]);
      fuzz::put(root / "calibration" / "calib_cam_to_pose.txt", parts[1]);
      fuzz::put(root / "image_02" / "timestamps.txt", parts[2]);
      fuzz::put(root / "poses.txt", parts[3]);
      break;
    case 2:
      format = "kaist";
      fuzz::put(root / "calibration" / "EncoderParameter.txt", parts[0]);
      fuzz::put(root / "calibration" / "Vehicle2Stereo.txt", parts[1]);
      fuzz::put(root / "sensor_data" / "encoder.csv", parts[2]);
      fuzz::put(root / "global_pose.csv", parts[3]);
      break;
    default:
      format = "euroc";
      put_images(root / "cam0" / "data", ".png");
      fuzz::put(root / "cam0" / "sensor.yaml", parts[0]);
      fuzz::put(root / "cam0" / "data.csv", parts[1]);
      fuzz::put(root / "imu0" / "data.csv", parts[2]);
      fuzz::put(root / "state_groundtruth_estimate0" / "data.csv", parts[3]);
  }
  return fuzz::try_parse([&] {
    ImportOptions options;
    options.overwrite = true;
    (void)import_drive(format, root, fuzz::work_folder() / "drive", options);
  });
}
