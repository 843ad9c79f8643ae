#include "drive/writer.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cstring>
#include <deque>
#include <string_view>
#include <utility>

#include "base/error.hpp"
#include "base/files/disk_space.hpp"
#include "base/files/folder_lock.hpp"
#include "drive/images/image_header.hpp"
#include "drive/images/png_grey.hpp"
#include "drive/loader.hpp"
#include "drive/output_file.hpp"
#include "drive/plausible.hpp"
#include "drive/sensor_yaml.hpp"
#include "drive/table_faults.hpp"
#include "drive/vehicle_yaml.hpp"
#include "sensors/calibration/calibration_fields.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

std::string number_list(std::initializer_list<double> values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ",") + decimal(value);
  return text;
}

// Names that a drive consists of: what `overwrite` may remove.
bool belongs_to_a_drive(const std::string& name) {
  for (const char* const prefix :
       {"cam", "segmentation", "wheels", "imu", "range", "friction", "detector"}) {
    if (!name.starts_with(prefix)) continue;
    const std::string rest = name.substr(std::strlen(prefix));
    if (!rest.empty() && rest.find_first_not_of("0123456789") == std::string::npos) return true;
  }
  return name == "state_groundtruth_estimate0" || name == "truth" || name == "mav0" ||
         name == "camchain.yaml" || name == kVehicleFile || name == kUnfinishedMark;
}

// Makes the folder, or empties it, and locks it: another writer would take the marked folder of
// this one for broken off.
std::unique_ptr<FolderLock> prepare_folder(const fs::path& folder, bool overwrite) {
  std::error_code error;
  std::unique_ptr<FolderLock> lock;
  if (fs::exists(folder, error)) {
    if (!fs::is_directory(folder, error))
      throw InvalidOption("output", folder.string() + ", which is a file", "a new folder");
    lock = std::make_unique<FolderLock>(folder);
    std::vector<fs::path> entries;
    for (const auto& entry : fs::directory_iterator(folder)) entries.push_back(entry.path());
    // What was broken off is of no use: the same command run again begins afresh.
    const bool unfinished = fs::exists(folder / kUnfinishedMark, error);
    if (!entries.empty() && !overwrite && !unfinished)
      throw InvalidOption("output", folder.string() + ", which is not empty",
                          "a new or empty folder, or leave to overwrite");
    for (const auto& entry : entries)
      if (!belongs_to_a_drive(entry.filename().string()))
        throw InvalidOption("output", entry.string() + ", which is no part of a drive",
                            "a folder that holds a drive only");
    for (const auto& entry : entries) fs::remove_all(entry, error);
  }
  make_folder(folder);
  return lock ? std::move(lock) : std::make_unique<FolderLock>(folder);
}

std::string extension_of(ImageFormat format) {
  return format == ImageFormat::kJpeg ? ".jpg" : ".png";
}

}  // namespace

struct DriveWriter::Impl {
  fs::path folder;
  std::unique_ptr<FolderLock> lock;
  Rig rig;
  DriveWriterOptions options;
  // A deque keeps its elements where they are: cameras are written concurrently.
  std::deque<OutputTable> cameras;
  std::vector<std::unique_ptr<OutputTable>> segmentations;
  std::unique_ptr<OutputTable> wheels;
  std::unique_ptr<OutputTable> imu;
  std::unique_ptr<OutputTable> friction;
  std::unique_ptr<OutputTable> range;
  bool has_wheels = false;
  bool has_steering = false;
  bool has_truth = false;

  void check_image(std::size_t camera, const cv::Mat& image) const {
    ROADBOOK_ASSERT(camera < rig.cameras.size());
    ROADBOOK_ASSERT(image.type() == CV_8UC1 && image.cols == rig.cameras[camera].camera.width &&
                    image.rows == rig.cameras[camera].camera.height);
  }
  static void write_png(const fs::path& path, const cv::Mat& image) {
    const auto bytes = encode_grey_png(image);
    write_file(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
  }
  // Folder, sensor.yaml and table of a stream that appears with its first row.
  std::unique_ptr<OutputTable> start(const std::string& name,
                                     const std::string& type,
                                     const std::string& camera,
                                     std::string_view header) const {
    make_folder(folder / name);
    StreamFile stream;
    stream.info.comment = options.comment;
    stream.camera = camera;
    write_file(folder / name / "sensor.yaml", stream_yaml_text(type, stream));
    return std::make_unique<OutputTable>(folder / name, header);
  }
};

DriveWriter::DriveWriter(fs::path folder,
                         const Rig& rig,
                         const std::optional<WheelModel>& wheels,
                         const DriveWriterOptions& options)
    : impl_(std::make_unique<Impl>()) {
  impl_->lock = prepare_folder(folder, options.overwrite);
  impl_->folder = std::move(folder);
  impl_->rig = rig;
  impl_->options = options;
  impl_->segmentations.resize(rig.cameras.size());
  write_file(impl_->folder / kUnfinishedMark, "");
  for (const auto& camera : rig.cameras) {
    const fs::path place = impl_->folder / camera.name;
    make_folder(place / "data");
    write_file(place / "sensor.yaml",
               camera_yaml_text(camera, {options.comment, options.camera_rate_hz}));
    impl_->cameras.emplace_back(place, "#timestamp [ns],filename");
  }
  if (!wheels) return;
  impl_->has_wheels = true;
  make_folder(impl_->folder / "wheels0");
  write_file(impl_->folder / "wheels0" / "sensor.yaml",
             wheel_yaml_text(*wheels, {options.comment, options.wheel_rate_hz}));
}

DriveWriter::~DriveWriter() = default;

const Rig& DriveWriter::rig() const { return impl_->rig; }

void DriveWriter::write_image(std::size_t camera, std::int64_t t_ns, const cv::Mat& grey) {
  impl_->check_image(camera, grey);
  const std::string name = std::to_string(t_ns) + ".png";
  Impl::write_png(impl_->folder / impl_->rig.cameras[camera].name / "data" / name, grey);
  impl_->cameras[camera].row(t_ns, name);
}

void DriveWriter::copy_image(std::size_t camera, std::int64_t t_ns, const fs::path& source) {
  ROADBOOK_ASSERT(camera < impl_->rig.cameras.size());
  const Camera& lens = impl_->rig.cameras[camera].camera;
  const ImageHeader header = inspect_image(source);
  const bool fits = header.width == lens.width && header.height == lens.height;
  if (header.state != ImageState::kGood || !fits)
    throw BadInput(
        {Severity::kError, source.string(), 0, "",
         header.state != ImageState::kGood
             ? to_text(header.state)
             : std::to_string(header.width) + "x" + std::to_string(header.height) + " pixels" +
                   in_brackets(size_cause(header.width, header.height, lens.width, lens.height)),
         "an image of " + std::to_string(lens.width) + "x" + std::to_string(lens.height)});
  const std::string name = std::to_string(t_ns) + extension_of(header.format);
  const fs::path target = impl_->folder / impl_->rig.cameras[camera].name / "data" / name;
  std::error_code error;
  if (!fs::copy_file(source, target, error))
    throw_storage_error(target, "copying", write_fault(target, error.value()));
  impl_->cameras[camera].row(t_ns, name);
}

void DriveWriter::write_segmentation(std::size_t camera,
                                     std::int64_t t_ns,
                                     const cv::Mat& classes) {
  impl_->check_image(camera, classes);
  const std::string stream = "segmentation" + std::to_string(camera);
  if (!impl_->segmentations[camera]) {
    impl_->segmentations[camera] = impl_->start(
        stream, "segmentation", impl_->rig.cameras[camera].name, "#timestamp [ns],filename");
    make_folder(impl_->folder / stream / "data");
  }
  const std::string name = std::to_string(t_ns) + ".png";
  Impl::write_png(impl_->folder / stream / "data" / name, classes);
  impl_->segmentations[camera]->row(t_ns, name);
}

void DriveWriter::write_wheels(const WheelReading& reading) {
  ROADBOOK_ASSERT(impl_->has_wheels);
  if (!impl_->wheels) {
    impl_->has_steering = reading.steering_rad.has_value();
    std::string header = "#timestamp [ns],rear_left_angle [rad],rear_right_angle [rad]";
    if (impl_->has_steering) header += ",steering_angle [rad]";
    impl_->wheels = std::make_unique<OutputTable>(impl_->folder / "wheels0", header);
  }
  std::string row = number_list({reading.left_angle_rad, reading.right_angle_rad});
  if (impl_->has_steering)
    row += "," + (reading.steering_rad ? decimal(*reading.steering_rad) : std::string());
  impl_->wheels->row(reading.t_ns, row);
}

void DriveWriter::write_imu(const ImuReading& reading) {
  if (!impl_->imu)
    impl_->imu =
        impl_->start("imu0", "imu", "",
                     "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
                     "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]");
  const auto& w = reading.angular_velocity_rad_s;
  const auto& a = reading.specific_force_m_s2;
  impl_->imu->row(reading.t_ns, number_list({w.x(), w.y(), w.z(), a.x(), a.y(), a.z()}));
}

void DriveWriter::write_friction(const FrictionReading& reading) {
  if (!impl_->friction) {
    std::string header = "#timestamp [ns],friction [-],sigma [-]";
    if (reading.surface) header += ",surface []";
    if (reading.temperature_c) header += ",temperature [degC]";
    impl_->friction = impl_->start("friction0", "friction", "", header);
  }
  std::string row = number_list({reading.friction, reading.sigma});
  if (reading.surface) row += "," + std::to_string(*reading.surface);
  if (reading.temperature_c) row += "," + decimal(*reading.temperature_c);
  impl_->friction->row(reading.t_ns, row);
}

void DriveWriter::write_vehicle(const VehicleMeasures& vehicle) {
  write_file(impl_->folder / kVehicleFile, vehicle_yaml_text(vehicle));
}

void DriveWriter::set_range_model(const RangeModel& model) {
  ROADBOOK_ASSERT(!impl_->range);
  make_folder(impl_->folder / "range0");
  write_file(impl_->folder / "range0" / "sensor.yaml",
             range_yaml_text(model, {impl_->options.comment, 0.0}));
  impl_->range =
      std::make_unique<OutputTable>(impl_->folder / "range0", "#timestamp [ns],beam,range [m]");
}

void DriveWriter::write_range(const RangeReading& reading) {
  ROADBOOK_ASSERT(impl_->range);
  impl_->range->row(reading.t_ns, std::to_string(reading.beam) + "," + decimal(reading.range_m),
                    StampOrder::kRepeats);
}

namespace {

void write_poses(const fs::path& place, const std::vector<TimedPose>& poses) {
  make_folder(place);
  OutputTable table(place,
                    "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],"
                    "q_RS_y [],q_RS_z []");
  for (const auto& pose : poses) {
    const Eigen::Vector3d p = pose.T_world_vehicle.translation();
    const Eigen::Quaterniond q(pose.T_world_vehicle.linear());
    table.row(pose.t_ns, number_list({p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z()}));
  }
  table.close();
}

}  // namespace

void DriveWriter::write_truth(const std::vector<TimedPose>& poses) {
  ROADBOOK_ASSERT(!impl_->has_truth && !poses.empty());
  impl_->has_truth = true;
  write_poses(impl_->folder / "state_groundtruth_estimate0", poses);
}

void DriveWriter::write_true_poses(const std::vector<TimedPose>& poses) {
  write_poses(impl_->folder / "truth" / "poses", poses);
}

void DriveWriter::finish() {
  for (auto& table : impl_->cameras) table.close();
  for (auto& table : impl_->segmentations)
    if (table) table->close();
  for (auto* const table :
       {impl_->wheels.get(), impl_->imu.get(), impl_->friction.get(), impl_->range.get()})
    if (table != nullptr) table->close();
  // One sync of the file system instead of one a file: a drive has ten thousands of images.
  const int fd = ::open(impl_->folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (fd < 0) throw_storage_error(impl_->folder, "opening");
  std::error_code error;
  const bool synced = ::syncfs(fd) == 0;
  const bool unmarked = fs::remove(impl_->folder / kUnfinishedMark, error);
  const bool folder_synced = ::fsync(fd) == 0;
  ::close(fd);
  if (!synced || !unmarked || !folder_synced) throw_storage_error(impl_->folder, "syncing");
}

}  // namespace roadbook
