#include "drive/csv.hpp"
#include "drive/image_header.hpp"
#include "drive/import_support.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

struct KittiCamera {
  fs::path folder;
  std::vector<fs::path> files;
};

// P = K [I | t] of a rectified camera; t is where camera 0 stands in this camera's frame.
MountedCamera read_projection(const fs::path& file,
                              const std::string& key,
                              const std::string& name,
                              const ImageHeader& image,
                              const Eigen::Isometry3d& T_vehicle_camera0) {
  const TextTable table = read_text_table(file, ' ', 0);
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (table.rows[row].front() != key + ":") continue;
    const auto p = row_numbers(file, table, row, 1);
    if (p.size() != 12) refuse(file, table.lines[row], key, std::to_string(p.size()), "12 numbers");
    if (!(p[0] > 0.0) || !(p[5] > 0.0))
      refuse(file, table.lines[row], key, "no focal lengths", "positive ones");
    MountedCamera camera;
    camera.name = name;
    camera.camera.model = CameraModel::kPinholeRadtan;
    camera.camera.parameters = {p[0], p[5], p[2], p[6]};
    camera.camera.width = static_cast<int>(image.width);
    camera.camera.height = static_cast<int>(image.height);
    const Eigen::Vector3d t((p[3] - p[2] * p[11]) / p[0], (p[7] - p[6] * p[11]) / p[5], p[11]);
    camera.T_vehicle_camera = T_vehicle_camera0 * Eigen::Translation3d(-t);
    return camera;
  }
  refuse(file, 0, key, "no such line", "the projection matrix of each camera");
}

std::vector<KittiCamera> find_cameras(const fs::path& source) {
  const std::vector<std::string> extensions = {".png", ".jpg"};
  std::vector<KittiCamera> cameras;
  for (int i = 0; i < 4; ++i) {
    const fs::path folder = source / ("image_" + std::to_string(i));
    auto files = files_in(folder, extensions);
    if (!files.empty()) cameras.push_back({folder, std::move(files)});
  }
  if (cameras.empty())
    refuse(source, 0, "", "no image_0/ with images", "a KITTI odometry sequence");
  return cameras;
}

std::vector<std::int64_t> read_times(const fs::path& file) {
  const TextTable table = read_text_table(file, ' ', 1);
  std::vector<std::int64_t> times;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto t = seconds_to_ns(table.rows[i][0]);
    if (!t || (!times.empty() && *t <= times.back()))
      refuse(file, table.lines[i], "time", printable(table.rows[i][0]), "ascending seconds");
    times.push_back(*t);
  }
  return times;
}

}  // namespace

ImportResult import_kitti(const ImportJob& job) {
  const auto found = find_cameras(job.source);
  const auto times = read_times(job.source / "times.txt");
  Eigen::Isometry3d T_vehicle_camera0 = Eigen::Isometry3d::Identity();
  T_vehicle_camera0.linear() = forward_camera_axes();
  T_vehicle_camera0.translation() << job.options.camera_forward_m, 0.0, job.options.camera_height_m;
  Rig rig;
  for (const auto& camera : found) {
    const ImageHeader image = inspect_image(camera.files.front());
    if (image.state != ImageState::kGood)
      refuse(camera.files.front(), 0, "", to_text(image.state), "an image");
    const std::string number = camera.folder.filename().string().substr(6);
    rig.cameras.push_back(read_projection(job.source / "calib.txt", "P" + number, "cam" + number,
                                          image, T_vehicle_camera0));
    if (camera.files.size() != times.size())
      refuse(camera.folder, 0, "images", std::to_string(camera.files.size()),
             std::to_string(times.size()) + " as times.txt has");
  }
  std::vector<TimedPose> poses;
  const auto name = fs::absolute(job.source).lexically_normal();
  const fs::path sequence = name.filename().empty() ? name.parent_path() : name;
  const auto pose_file =
      first_existing({job.source / "poses.txt", sequence.parent_path().parent_path() / "poses" /
                                                    (sequence.filename().string() + ".txt")});
  if (pose_file) {
    const TextTable table = read_text_table(*pose_file, ' ', 12);
    if (table.rows.size() != times.size())
      refuse(*pose_file, 0, "poses", std::to_string(table.rows.size()),
             std::to_string(times.size()) + " as times.txt has");
    for (std::size_t i = 0; i < times.size(); ++i) {
      // KITTI's world is the first camera; ours is the vehicle of that moment.
      const auto T_camera0_camera =
          pose_of_rows(*pose_file, table.lines[i], row_numbers(*pose_file, table, i));
      poses.push_back(
          {times[i], T_vehicle_camera0 * T_camera0_camera * T_vehicle_camera0.inverse()});
    }
  }
  ImportResult result;
  DriveWriterOptions writing;
  writing.overwrite = job.options.overwrite;
  writing.comment = "KITTI odometry; camera height and distance to the rear axle from the options";
  DriveWriter writer(job.out, rig, std::nullopt, writing);
  for (std::size_t i = 0; i < times.size(); ++i) {
    report(job.progress, "import", i, times.size());
    for (std::size_t camera = 0; camera < found.size(); ++camera, ++result.images)
      writer.copy_image(camera, times[i], found[camera].files[i]);
  }
  if (!poses.empty()) writer.write_truth(poses);
  result.poses = poses.size();
  writer.finish();
  return result;
}

}  // namespace roadbook
