#include <array>
#include <map>

#include "base/text.hpp"
#include "base/yaml.hpp"
#include "drive/csv.hpp"
#include "drive/images/image_header.hpp"
#include "drive/import/import_support.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// Height of KITTI-360's GPS/IMU unit over the ground (the vehicle's set-up drawing).
constexpr double kImuHeight = 0.93;

// IMU axes: forward, right, down.
Eigen::Isometry3d vehicle_from_imu() {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = Eigen::Vector3d(1, -1, -1).asDiagonal();
  T.translation() << 0, 0, kImuHeight;
  return T;
}

Camera read_mei(const fs::path& file) {
  YamlMap yaml = YamlMap::load(file);
  Camera camera;
  camera.model = CameraModel::kOmni;
  auto& p = camera.parameters;
  yaml.require("image_width", camera.width, Range{1, 1e5});
  yaml.require("image_height", camera.height, Range{1, 1e5});
  const auto part = [&](const char* key,
                        std::initializer_list<std::pair<const char*, double*>> values) {
    auto map = yaml.map(key);
    if (!map) return yaml.report(key, "nothing", "a mapping");
    for (const auto& [name, value] : values) map->require(name, *value);
  };
  part("mirror_parameters", {{"xi", &p[0]}});
  part("projection_parameters",
       {{"gamma1", &p[1]}, {"gamma2", &p[2]}, {"u0", &p[3]}, {"v0", &p[4]}});
  part("distortion_parameters", {{"k1", &p[5]}, {"k2", &p[6]}, {"p1", &p[7]}, {"p2", &p[8]}});
  for (const auto& key : yaml.keys()) yaml.ignore(key);
  yaml.finish();
  return camera;
}

// P_rect_00 and S_rect_00 of perspective.txt: the rectified cameras.
Camera read_perspective(const fs::path& file, const std::string& number) {
  const TextTable table = read_text_table(file, ' ', 0);
  Camera camera;
  std::size_t found = 0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::string& key = table.rows[i].front();
    if (key != "P_rect_" + number + ":" && key != "S_rect_" + number + ":") continue;
    const auto v = row_numbers(file, table, i, 1);
    const bool projection = key.front() == 'P';
    if (v.size() != (projection ? 12u : 2u))
      refuse(file, table.lines[i], key, "another count", projection ? "12 numbers" : "2 numbers");
    if (!projection && !(v[0] >= 1.0 && v[0] <= 1e5 && v[1] >= 1.0 && v[1] <= 1e5))
      refuse(file, table.lines[i], key, table.rows[i][1] + " " + table.rows[i][2],
             "width and height, 1 to 100000");
    if (projection)
      camera.parameters = {v[0], v[5], v[2], v[6]};
    else
      camera.width = static_cast<int>(v[0]), camera.height = static_cast<int>(v[1]);
    ++found;
  }
  if (found != 2)
    refuse(file, 0, "P_rect_" + number, "no such line", "P_rect and S_rect of the camera");
  return camera;
}

struct Views {
  Rig rig;
  std::vector<fs::path> folders;                         // of image_0X
  std::vector<std::map<std::int64_t, fs::path>> images;  // by frame number
};

Eigen::Isometry3d read_kitti_mount(const fs::path& file, const std::string& key) {
  const TextTable table = read_text_table(file, ' ', 0);
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    if (table.rows[i].front() == key + ":")
      return pose_of_rows(file, table.lines[i], row_numbers(file, table, i, 1));
  refuse(file, 0, key, "no such line", "12 numbers");
}

Views read_views(const fs::path& source, const fs::path& calibration) {
  Views views;
  for (const char* const number : {"00", "01", "02", "03"}) {
    const std::string key = std::string("image_") + number;
    const auto data = first_existing({source / key / "data_rgb", source / key / "data_rect"});
    if (!data) continue;
    const bool fisheye = data->filename() == "data_rgb";
    MountedCamera camera;
    camera.name = "cam" + std::to_string(views.rig.cameras.size());
    camera.camera = fisheye ? read_mei(calibration / (key + ".yaml"))
                            : read_perspective(calibration / "perspective.txt", number);
    camera.T_vehicle_camera =
        vehicle_from_imu() * read_kitti_mount(calibration / "calib_cam_to_pose.txt", key);
    std::map<std::int64_t, fs::path> images;
    for (const auto& file : image_files(*data)) {
      const auto frame = frame_number(file);
      if (!frame || *frame < 0)
        refuse(file, 0, "name", printable(file.stem().string()), "a frame number");
      const auto [there, is_new] = images.emplace(*frame, file);
      if (!is_new)
        refuse(file, 0, "name", "frame " + std::to_string(*frame) + " again",
               "one image for each frame (" + there->second.filename().string() + " has it)");
    }
    if (images.empty()) refuse(*data, 0, "images", "no .png or .jpg file", "the camera's images");
    views.rig.cameras.push_back(camera);
    views.folders.push_back(source / key);
    views.images.push_back(std::move(images));
  }
  if (views.rig.cameras.empty())
    refuse(source, 0, "", "no image_00..03 with data_rgb or data_rect", "a KITTI-360 sequence");
  return views;
}

constexpr const char* kStampText = "YYYY-MM-DD HH:MM:SS.fff";

// One stamp a line, line number = frame number; a frame that the recorder lost has a blank line.
struct FrameTimes {
  fs::path file;
  FrameLines lines;
  std::vector<std::optional<std::int64_t>> t_ns;

  explicit FrameTimes(const fs::path& timestamps)
      : file(timestamps),
        lines(read_frame_lines(timestamps)),
        t_ns(frame_stamps(timestamps, lines, &date_to_ns, kStampText)) {}

  // Stamp of a frame that has an image or a pose in the source.
  [[nodiscard]] std::int64_t at(std::int64_t frame,
                                const fs::path& source,
                                std::int64_t line) const {
    if (frame < 0 || frame >= static_cast<std::int64_t>(t_ns.size()))
      refuse(source, line, "frame", std::to_string(frame),
             "0 to " + std::to_string(t_ns.size() - 1) + ", as timestamps.txt has " +
                 std::to_string(t_ns.size()) + " lines");
    const auto i = static_cast<std::size_t>(frame);
    if (!t_ns[i])
      refuse(file, lines.lines[i], "time", "a blank line",
             "the stamp of frame " + std::to_string(frame) + ", which " +
                 source.filename().string() + " has");
    return *t_ns[i];
  }
};

void warn_of_frames_without_image(const Views& views,
                                  const FrameTimes& times,
                                  ImportResult& result) {
  for (std::size_t camera = 0; camera < views.images.size(); ++camera) {
    const std::size_t images = views.images[camera].size();
    const std::size_t stamps = times.lines.filled();
    if (images == stamps) continue;
    result.warnings.push_back({Severity::kWarning, views.folders[camera].string(), 0, "images",
                               std::to_string(images) + " for " + std::to_string(stamps) +
                                   " stamps; frames without an image are left out",
                               "an image for each stamp"});
  }
}

void import_kitti360_poses(const ImportJob& job,
                           const fs::path& file,
                           const FrameTimes& times,
                           DriveWriter& writer,
                           ImportResult& result) {
  const TextTable table = read_text_table(file, ' ', 13);
  std::vector<TimedPose> poses;
  Ascending order(file);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto frame = parse_int(table.rows[i][0]);
    if (!frame)
      refuse(file, table.lines[i], "frame", printable(table.rows[i][0]), "a frame number");
    const auto T_world_imu = pose_of_rows(file, table.lines[i], row_numbers(file, table, i, 1));
    const std::int64_t t = times.at(*frame, file, table.lines[i]);
    if (order.accept(t, table.lines[i]))
      poses.push_back({t, T_world_imu * vehicle_from_imu().inverse()});
  }
  order.report(job.options, result);
  writer.write_truth(poses);
  result.poses = poses.size();
}

}  // namespace

ImportResult import_kitti360(const ImportJob& job) {
  const fs::path source = fs::absolute(job.source).lexically_normal();
  const fs::path sequence = source.filename().empty() ? source.parent_path() : source;
  const fs::path root = sequence.parent_path().parent_path();
  const auto calibration = first_existing({sequence / "calibration", root / "calibration"});
  if (!calibration)
    refuse(sequence / "calibration", 0, "", "no such folder", "KITTI-360's calibration");
  const Views views = read_views(sequence, *calibration);
  // One instant, one stamp: that of the first camera.
  const FrameTimes times(views.folders.front() / "timestamps.txt");
  ImportResult result;
  DriveWriterOptions writing;
  writing.overwrite = job.options.overwrite;
  writing.comment = "KITTI-360; vehicle frame on the ground below the GPS/IMU unit";
  DriveWriter writer(job.out, views.rig, std::nullopt, writing);
  for (std::size_t camera = 0; camera < views.images.size(); ++camera)
    for (const auto& [frame, file] : views.images[camera]) {
      report(job.progress, "import", result.images, 0);
      writer.copy_image(camera, times.at(frame, file, 0), file);
      ++result.images;
    }
  const auto pose_file = first_existing(
      {sequence / "poses.txt", root / "data_poses" / sequence.filename() / "poses.txt"});
  if (pose_file) import_kitti360_poses(job, *pose_file, times, writer, result);
  warn_of_frames_without_image(views, times, result);
  writer.finish();
  return result;
}

}  // namespace roadbook
