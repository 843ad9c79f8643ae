#include "drive/import/import_video.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <opencv2/videoio.hpp>

#include "base/text.hpp"
#include "base/text_file.hpp"
#include "drive/csv.hpp"
#include "drive/import/import_support.hpp"
#include "drive/plausible.hpp"
#include "drive/sensor_yaml.hpp"
#include "drive/table_faults.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

constexpr const char* kFramesWanted =
    "one stamp for each frame: with another count nobody knows which frame is which";

void warn_of_frames_without_stamp(const fs::path& file,
                                  const FrameStamps& stamps,
                                  ImportResult& result) {
  const auto blank = std::count(stamps.begin(), stamps.end(), std::nullopt);
  if (blank == 0) return;
  result.warnings.push_back({Severity::kWarning, file.string(), 0, "frames",
                             std::to_string(blank) + " of " + std::to_string(stamps.size()) +
                                 " frames with a blank line for their stamp; left out",
                             "a stamp for each frame"});
}

// A row a frame: a blank line is a frame without a stamp.
FrameStamps read_frame_stamps(const fs::path& file) {
  ProblemList problems;
  CsvReader csv(file, CsvHeader::kRequired, problems);
  FrameStamps stamps;
  std::int64_t last = -1;
  if (csv.good()) {
    const auto column = csv.require("timestamp", "ns|");
    while (csv.next()) {
      stamps.resize(stamps.size() + csv.blank_lines_before());
      const auto t = csv.stamp(*column);
      if (t && *t <= last)
        problems.error(csv.file(), csv.line(), "timestamp", std::to_string(*t),
                       "more than " + std::to_string(last));
      if (t) last = *t;
      stamps.push_back(t);
    }
  }
  if (problems.has_errors()) throw BadInput(problems.problems());
  if (stamps.empty()) refuse(file, 0, "", "no rows", "a stamp for each frame");
  return stamps;
}

std::string frames_and_stamps(std::size_t frames, const FrameStamps& stamps) {
  const auto blank =
      static_cast<std::size_t>(std::count(stamps.begin(), stamps.end(), std::nullopt));
  return std::to_string(frames) + " for " + std::to_string(stamps.size() - blank) + " stamps" +
         (blank > 0 ? " and " + std::to_string(blank) + " blank lines" : "");
}

}  // namespace

std::size_t import_video_frames(const fs::path& file,
                                const FrameStamps& stamps_ns,
                                DriveWriter& writer,
                                const Progress& progress) {
  require_regular_file(file, "a video that FFmpeg decodes");
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
  std::size_t written = 0;
  for (std::size_t i = 0; i < stamps_ns.size(); ++i) {
    report(progress, "import", i, stamps_ns.size());
    if (!video.read(frame))
      refuse(file, 0, "frames", frames_and_stamps(i, stamps_ns), kFramesWanted);
    if (!stamps_ns[i]) continue;
    if (frame.channels() == 1)
      grey = frame;
    else
      cv::cvtColor(frame, grey, cv::COLOR_BGR2GRAY);
    const Camera& lens = writer.rig().cameras[0].camera;
    if (grey.cols != lens.width || grey.rows != lens.height)
      refuse(file, 0, "frame",
             std::to_string(grey.cols) + "x" + std::to_string(grey.rows) +
                 in_brackets(size_cause(grey.cols, grey.rows, lens.width, lens.height)),
             std::to_string(lens.width) + "x" + std::to_string(lens.height) +
                 ", the camera's resolution");
    writer.write_image(0, *stamps_ns[i], grey);
    ++written;
  }
  std::size_t frames = stamps_ns.size();
  while (video.grab()) ++frames;
  if (frames > stamps_ns.size())
    refuse(file, 0, "frames", frames_and_stamps(frames, stamps_ns), kFramesWanted);
  return written;
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
  warn_of_frames_without_stamp(job.source / "frames.csv", stamps, result);
  result.images = import_video_frames(videos.front(), stamps, writer, job.progress);
  writer.finish();
  return result;
}

}  // namespace roadbook
