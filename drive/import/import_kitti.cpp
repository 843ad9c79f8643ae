#include "base/text.hpp"
#include "drive/csv.hpp"
#include "drive/images/image_header.hpp"
#include "drive/import/import_support.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

struct KittiCamera {
  fs::path folder;
  std::vector<fs::path> files;
};

// P = K [I | t] of a rectified camera; t is the position of camera 0 in this camera's frame.
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
  std::vector<KittiCamera> cameras;
  for (int i = 0; i < 4; ++i) {
    const fs::path folder = source / ("image_" + std::to_string(i));
    auto files = image_files(folder);
    if (!files.empty()) cameras.push_back({folder, std::move(files)});
  }
  if (cameras.empty())
    refuse(source, 0, "", "no image_0/ with images", "a KITTI odometry sequence");
  return cameras;
}

struct KittiTimes {
  fs::path file;
  FrameLines lines;
  std::vector<std::optional<std::int64_t>> t_ns;  // by frame; empty: a blank line
};

KittiTimes read_times(const fs::path& file) {
  KittiTimes times{file, read_frame_lines(file), {}};
  times.t_ns = frame_stamps(file, times.lines, &seconds_to_ns, "seconds");
  return times;
}

// The image files by frame; empty paths where a frame lacks its image. The numbers in the names are
// frame numbers where they begin at 0 and have a line each. Otherwise the images count in their
// order, which is certain only where there are as many images as stamps.
std::vector<fs::path> images_by_frame(const KittiCamera& camera,
                                      const KittiTimes& times,
                                      ImportResult& result) {
  const std::size_t frames = times.t_ns.size();
  const std::size_t stamps = times.lines.filled();
  const std::string images = std::to_string(camera.files.size());
  const auto first = frame_number(camera.files.front());
  const auto last = frame_number(camera.files.back());
  if (camera.files.size() == stamps && stamps == frames) {
    if (first && last && *last - *first != static_cast<std::int64_t>(stamps) - 1)
      result.warnings.push_back({Severity::kWarning, camera.folder.string(), 0, "images",
                                 "numbers " + std::to_string(*first) + " to " +
                                     std::to_string(*last) + " of " + images +
                                     " images; taken in their order",
                                 "a number for each line of times.txt"});
    return camera.files;
  }
  if (first != 0 || !last || *last >= static_cast<std::int64_t>(frames))
    refuse(
        camera.folder, 0, "images", images,
        std::to_string(stamps) + " as times.txt has" +
            (frames > stamps ? " (and " + std::to_string(frames - stamps) + " blank lines)" : ""));
  std::vector<fs::path> by_frame(frames);
  for (const auto& file : camera.files) {
    const auto number = frame_number(file);
    // Names with two runs of digits ("2_1.png" after "1_9.png") are not in the order of the frames.
    if (!number || *number >= static_cast<std::int64_t>(frames))
      refuse(file, 0, "name", printable(file.stem().string()),
             "a frame number from 0 to " + std::to_string(frames - 1));
    const auto frame = static_cast<std::size_t>(*number);
    if (!times.t_ns[frame])
      refuse(times.file, times.lines.lines[frame], "time", "a blank line",
             "the time of " + file.filename().string());
    if (!by_frame[frame].empty())
      refuse(file, 0, "name", "frame " + std::to_string(frame) + " again",
             "one image for each frame (" + by_frame[frame].filename().string() + " has it)");
    by_frame[frame] = file;
  }
  if (camera.files.size() != stamps)
    result.warnings.push_back({Severity::kWarning, camera.folder.string(), 0, "images",
                               images + " for " + std::to_string(stamps) +
                                   " stamps; frames without an image are left out",
                               "an image for each line of times.txt"});
  return by_frame;
}

std::optional<fs::path> find_poses(const fs::path& source) {
  const auto name = fs::absolute(source).lexically_normal();
  const fs::path sequence = name.filename().empty() ? name.parent_path() : name;
  return first_existing({source / "poses.txt", sequence.parent_path().parent_path() / "poses" /
                                                   (sequence.filename().string() + ".txt")});
}

// KITTI's world is the first camera; ours is the vehicle of that moment.
std::vector<TimedPose> read_kitti_poses(const fs::path& file,
                                        const KittiTimes& times,
                                        const Eigen::Isometry3d& T_vehicle_camera0,
                                        const ImportOptions& options,
                                        ImportResult& result) {
  const FrameLines rows = read_frame_lines(file);
  if (rows.text.size() != times.t_ns.size())
    refuse(file, 0, "poses", std::to_string(rows.text.size()),
           std::to_string(times.t_ns.size()) + " as times.txt has lines");
  std::vector<TimedPose> poses;
  LeftOut left(file, "poses", "have a blank line here or in times.txt", "a pose for each time");
  for (std::size_t i = 0; i < rows.text.size(); ++i) {
    if (rows.text[i].empty() && !times.t_ns[i]) continue;
    if (rows.text[i].empty() || !times.t_ns[i]) {
      left.leave(rows.lines[i]);
      continue;
    }
    const auto T_camera0_camera =
        pose_of_rows(file, rows.lines[i], line_numbers(file, rows.lines[i], rows.text[i]));
    poses.push_back(
        {*times.t_ns[i], T_vehicle_camera0 * T_camera0_camera * T_vehicle_camera0.inverse()});
    left.take();
  }
  left.report(options, result);
  return poses;
}

}  // namespace

ImportResult import_kitti(const ImportJob& job) {
  const auto found = find_cameras(job.source);
  const KittiTimes times = read_times(job.source / "times.txt");
  Eigen::Isometry3d T_vehicle_camera0 = Eigen::Isometry3d::Identity();
  T_vehicle_camera0.linear() = forward_camera_axes();
  T_vehicle_camera0.translation() << job.options.camera_forward_m, 0.0, job.options.camera_height_m;
  ImportResult result;
  Rig rig;
  std::vector<std::vector<fs::path>> images;
  for (const auto& camera : found) {
    const ImageHeader image = inspect_image(camera.files.front());
    if (image.state != ImageState::kGood)
      refuse(camera.files.front(), 0, "", to_text(image.state), "an image");
    const std::string number = camera.folder.filename().string().substr(6);
    rig.cameras.push_back(read_projection(job.source / "calib.txt", "P" + number, "cam" + number,
                                          image, T_vehicle_camera0));
    images.push_back(images_by_frame(camera, times, result));
  }
  std::vector<TimedPose> poses;
  if (const auto file = find_poses(job.source))
    poses = read_kitti_poses(*file, times, T_vehicle_camera0, job.options, result);
  DriveWriterOptions writing;
  writing.overwrite = job.options.overwrite;
  writing.comment = "KITTI odometry; camera height and distance to the rear axle from the options";
  DriveWriter writer(job.out, rig, std::nullopt, writing);
  for (std::size_t i = 0; i < times.t_ns.size(); ++i) {
    report(job.progress, "import", i, times.t_ns.size());
    for (std::size_t camera = 0; camera < found.size(); ++camera) {
      if (images[camera][i].empty()) continue;
      writer.copy_image(camera, *times.t_ns[i], images[camera][i]);
      ++result.images;
    }
  }
  if (!poses.empty()) writer.write_truth(poses);
  result.poses = poses.size();
  writer.finish();
  return result;
}

}  // namespace roadbook
