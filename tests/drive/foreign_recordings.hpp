#pragma once

#include <opencv2/imgcodecs.hpp>

#include "drive/import/import.hpp"
#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {

/// A flat image: the number of its frame as grey, so that the order shows.
inline void write_flat_image(const fs::path& file, int grey, int width = 64, int height = 48) {
  fs::create_directories(file.parent_path());
  std::vector<std::uint8_t> bytes;
  // By hand: OpenCV does not write a file whose extension it does not know.
  cv::imencode(file.extension() == ".jpg" ? ".jpg" : ".png",
               cv::Mat(height, width, CV_8UC1, cv::Scalar(grey)), bytes);
  write_text(file, std::string(bytes.begin(), bytes.end()));
}

/// "0.0\n0.1\n...".
inline std::string kitti_times(int count) {
  std::string text;
  for (int i = 0; i < count; ++i)
    text += std::to_string(i / 10) + "." + std::to_string(i % 10) + "\n";
  return text;
}

/// A KITTI sequence of one camera with images of these names (no folder, with extension); frame i
/// has the grey 10 i + 1.
inline fs::path write_kitti(const fs::path& folder,
                            const std::vector<std::string>& names,
                            const std::string& times) {
  for (std::size_t i = 0; i < names.size(); ++i)
    write_flat_image(folder / "image_0" / names[i], 10 * static_cast<int>(i) + 1);
  write_text(folder / "times.txt", times);
  write_text(folder / "calib.txt", "P0: 40 0 31.5 0 0 40 23.5 0 0 0 1 0\n");
  return folder;
}

/// A KITTI-360 sequence of one fisheye; returns the sequence's folder. `stamps`: timestamps.txt.
inline fs::path write_kitti360(const fs::path& root,
                               const std::vector<std::string>& names,
                               const std::string& stamps) {
  const fs::path sequence = root / "data_2d_raw" / "seq";
  for (std::size_t i = 0; i < names.size(); ++i)
    write_flat_image(sequence / "image_02/data_rgb" / names[i], 10 * static_cast<int>(i) + 1);
  write_text(sequence / "image_02/timestamps.txt", stamps);
  write_text(root / "calibration/image_02.yaml",
             "%YAML:1.0\n---\nmodel_type: MEI\ncamera_name: image_02\nimage_width: 64\n"
             "image_height: 48\nmirror_parameters:\n   xi: 1\ndistortion_parameters:\n   k1: 0\n"
             "   k2: 0\n   p1: 0\n   p2: 0\nprojection_parameters:\n   gamma1: 40\n   gamma2: 40\n"
             "   u0: 31.5\n   v0: 23.5\n");
  write_text(root / "calibration/calib_cam_to_pose.txt",
             "image_02: 1 0 0 0.7 0 0 -1 -0.5 0 1 0 -1.0\n");
  return sequence;
}

/// A KAIST recording of wheels alone.
inline fs::path write_kaist(const fs::path& folder, const std::string& encoder) {
  write_text(folder / "calibration/EncoderParameter.txt",
             "Encoder resolution: 4096\nEncoder left wheel diameter: 0.62\n"
             "Encoder right wheel diameter: 0.62\nEncoder wheel base: 1.52\n");
  write_text(folder / "sensor_data/encoder.csv", encoder);
  return folder;
}

/// Whether the import is refused, and its lines: errors, or warnings.
struct ImportOutcome {
  bool refused = false;
  std::string text;
};
inline ImportOutcome try_import(const std::string& format,
                                const fs::path& source,
                                const fs::path& out,
                                const ImportOptions& options = {}) {
  ImportOutcome outcome;
  try {
    for (const auto& warning : import_drive(format, source, out, options).warnings)
      outcome.text += to_line(warning) + "\n";
  } catch (const BadInput& bad) {
    outcome.refused = true;
    outcome.text = bad.what();
  }
  return outcome;
}

/// Greys of camera 0's images in the order of their stamps.
inline std::vector<int> greys(const fs::path& drive) {
  const Drive opened = Drive::open(drive);
  std::vector<int> values;
  for (std::size_t i = 0; i < opened.frame_count(); ++i)
    values.push_back(opened.read_image(i, 0).at<std::uint8_t>(0, 0));
  return values;
}

inline std::vector<std::int64_t> frame_stamps_ns(const fs::path& drive) {
  const Drive opened = Drive::open(drive);
  std::vector<std::int64_t> stamps;
  for (std::size_t i = 0; i < opened.frame_count(); ++i) stamps.push_back(opened.frame_stamp_ns(i));
  return stamps;
}

#define ROADBOOK_EXPECT_TEXT(text, words) EXPECT_NE((text).find(words), std::string::npos) << (text)

}  // namespace roadbook::test
