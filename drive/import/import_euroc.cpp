#include "drive/drive.hpp"
#include "drive/import/import_support.hpp"
#include "drive/output_file.hpp"
#include "drive/problem_list.hpp"
#include "drive/tables.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// Streams whose files are native already are taken over as they are, T_BS and noise included.
void copy_stream(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::copy(from, to, fs::copy_options::recursive, error);
  if (error) throw_storage_error(to, "copying", error.message());
}

void copy_masks(const Drive& drive, const fs::path& out) {
  for (std::size_t camera = 0; camera < drive.rig().cameras.size(); ++camera)
    if (const auto mask = drive.mask_path(camera))
      copy_stream(*mask, out / drive.rig().cameras[camera].name / mask->filename());
}

std::size_t row_count(const Drive& drive, const std::string& stream) {
  for (const auto& summary : drive.streams())
    if (summary.name == stream) return summary.rows;
  return 0;
}

// Images that the tables name and that are missing or damaged.
void count_missing_images(const Drive& drive, const ImportOptions& options, ImportResult& result) {
  for (std::size_t camera = 0; camera < drive.rig().cameras.size(); ++camera) {
    const std::string& name = drive.rig().cameras[camera].name;
    LeftOut images(drive.folder() / name, "images", "are missing or damaged",
                   "the images that data.csv names");
    std::size_t good = 0;
    for (std::size_t frame = 0; frame < drive.frame_count(); ++frame)
      good += drive.has_image(frame, camera) ? 1 : 0;
    images.take(good);
    for (std::size_t i = good; i < row_count(drive, name); ++i) images.leave(0);
    images.report(options, result);
  }
}

// EuRoC's state estimate, TUM-VI's motion capture: the same columns.
std::vector<TimedPose> read_poses(const Drive& drive, const fs::path& sensors) {
  auto poses = drive.truth();
  const fs::path mocap = sensors / "mocap0" / "data.csv";
  if (!poses.empty() || !fs::exists(mocap)) return poses;
  ProblemList problems;
  (void)read_truth_table(mocap, problems, [&](const TimedPose& p) { poses.push_back(p); });
  if (problems.has_errors()) throw BadInput(problems.problems());
  return poses;
}

}  // namespace

ImportResult import_euroc(const ImportJob& job) {
  const Drive drive = Drive::open(job.source);
  const fs::path sensors = fs::is_directory(job.source / "mav0") ? job.source / "mav0" : job.source;
  ImportResult result;
  count_missing_images(drive, job.options, result);
  DriveWriterOptions writing;
  writing.overwrite = job.options.overwrite;
  writing.comment = "EuRoC layout; the body frame of the source stands for the vehicle";
  DriveWriter writer(job.out, drive.rig(), drive.wheel_model(), writing);
  for (std::size_t frame = 0; frame < drive.frame_count(); ++frame) {
    report(job.progress, "import", frame, drive.frame_count());
    for (std::size_t camera = 0; camera < drive.rig().cameras.size(); ++camera) {
      if (!drive.has_image(frame, camera)) continue;
      writer.copy_image(camera, drive.written_stamp_ns(frame, camera),
                        drive.image_path(frame, camera));
      ++result.images;
    }
  }
  drive.for_each_wheel_reading([&](const WheelReading& reading) {
    writer.write_wheels(reading);
    ++result.wheel_rows;
  });
  for (const char* const stream : {"imu0", "range0", "friction0"})
    if (fs::is_directory(sensors / stream)) copy_stream(sensors / stream, job.out / stream);
  copy_masks(drive, job.out);
  if (drive.vehicle()) writer.write_vehicle(*drive.vehicle());
  result.imu_rows = row_count(drive, "imu0");
  const auto poses = read_poses(drive, sensors);
  if (!poses.empty()) writer.write_truth(poses);
  result.poses = poses.size();
  const auto warnings = drive.warnings();
  result.warnings.insert(result.warnings.end(), warnings.begin(), warnings.end());
  writer.finish();
  return result;
}

}  // namespace roadbook
