#include "drive/import_video.hpp"

#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "base/text.hpp"
#include "drive/csv.hpp"
#include "drive/import_support.hpp"
#include "drive/sensor_yaml.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

std::vector<std::int64_t> read_frame_stamps(const fs::path& file) {
  ProblemList problems;
  CsvReader csv(file, CsvHeader::kRequired, problems);
  std::vector<std::int64_t> stamps;
  if (csv.good()) {
    const auto column = csv.require("timestamp", "ns|");
    while (csv.next()) {
      const auto t = csv.stamp(*column);
      if (!t) continue;
      if (!stamps.empty() && *t <= stamps.back())
        problems.error(csv.file(), csv.line(), "timestamp", std::to_string(*t),
                       "more than " + std::to_string(stamps.back()));
      else
        stamps.push_back(*t);
    }
  }
  if (problems.has_errors()) throw BadInput(problems.problems());
  if (stamps.empty()) refuse(file, 0, "", "no rows", "a stamp for each frame");
  return stamps;
}

}  // namespace

std::size_t import_video_frames(const fs::path& file,
                                const std::vector<std::int64_t>& stamps_ns,
                                DriveWriter& writer,
                                const Progress& progress) {
  cv::VideoCapture video;
  try {
    video.open(file.string(), cv::CAP_FFMPEG);
    if (!video.isOpened()) video.open(file.string(), cv::CAP_OPENCV_MJPEG);
  } catch (const cv::Exception&) {
    video.release();
  }
  if (!video.isOpened()) refuse(file, 0, "", "no readable video", "a video that FFmpeg decodes");
  cv::Mat frame;
  cv::Mat grey;
  for (std::size_t i = 0; i < stamps_ns.size(); ++i) {
    report(progress, "import", i, stamps_ns.size());
    if (!video.read(frame))
      refuse(file, 0, "frames", std::to_string(i),
             std::to_string(stamps_ns.size()) + " as there are stamps");
    if (frame.channels() == 1)
      grey = frame;
    else
      cv::cvtColor(frame, grey, cv::COLOR_BGR2GRAY);
    if (grey.cols != writer.rig().cameras[0].camera.width ||
        grey.rows != writer.rig().cameras[0].camera.height)
      refuse(file, 0, "frame", std::to_string(grey.cols) + "x" + std::to_string(grey.rows),
             "the camera's resolution");
    writer.write_image(0, stamps_ns[i], grey);
  }
  return stamps_ns.size();
}

MountedCamera comma_camera() {
  MountedCamera camera;
  camera.name = "cam0";
  camera.camera.model = CameraModel::kPinholeRadtan;
  camera.camera.parameters = {910.0, 910.0, 582.0, 437.0};
  camera.camera.width = 1164;
  camera.camera.height = 874;
  camera.T_vehicle_camera.linear() = forward_camera_axes();
  camera.T_vehicle_camera.translation() << 1.7, 0.0, 1.22;
  return camera;
}

ImportResult import_video(const ImportJob& job) {
  const std::vector<std::string> extensions = {".mp4",  ".avi",  ".mkv", ".mov",
                                               ".hevc", ".h264", ".webm"};
  const auto videos = files_in(job.source, extensions);
  if (videos.size() != 1)
    refuse(job.source, 0, "", std::to_string(videos.size()) + " video files", "one");
  const auto stamps = read_frame_stamps(job.source / "frames.csv");
  ProblemList problems;
  const auto camera = read_camera_yaml(job.source / "sensor.yaml", "cam0", 64.0, problems);
  if (!camera) throw BadInput(problems.problems());
  Rig rig;
  rig.cameras.push_back(camera->camera);
  DriveWriterOptions writing;
  writing.overwrite = job.options.overwrite;
  writing.comment = "frames of " + videos.front().filename().string();
  ImportResult result;
  DriveWriter writer(job.out, rig, std::nullopt, writing);
  result.images = import_video_frames(videos.front(), stamps, writer, job.progress);
  writer.finish();
  return result;
}

}  // namespace roadbook
