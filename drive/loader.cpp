#include "drive/loader.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

#include "base/text.hpp"
#include "drive/camchain.hpp"
#include "drive/checks/camera_places.hpp"
#include "drive/checks/frozen_images.hpp"
#include "drive/checks/gyro_check.hpp"
#include "drive/checks/stamp_spans.hpp"
#include "drive/detections.hpp"
#include "drive/sensor_yaml.hpp"
#include "drive/tables.hpp"
#include "drive/vehicle_yaml.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// Cameras and such are slower than this; stamps in another unit look at least a thousand times
// faster.
constexpr double kMaxImageRate = 1000.0;

bool is_folder(const fs::path& path) {
  std::error_code error;
  return fs::is_directory(path, error);
}

// Folders PREFIX0, PREFIX1, ... in the order of their numbers.
std::vector<fs::path> numbered_folders(const fs::path& folder, const std::string& prefix) {
  std::vector<std::pair<std::int64_t, fs::path>> found;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    const std::string name = it->path().filename().string();
    if (!name.starts_with(prefix) || name.size() == prefix.size()) continue;
    const std::string digits = name.substr(prefix.size());
    const auto number = parse_int(digits);
    if (number && digits == std::to_string(*number) && is_folder(it->path()))
      found.emplace_back(*number, it->path());
  }
  std::sort(found.begin(), found.end());
  std::vector<fs::path> folders;
  for (auto& [number, path] : found) folders.push_back(std::move(path));
  return folders;
}

class Loader {
 public:
  Loader(DriveContent& content, const DriveOptions& options, ProblemList& problems)
      : content_(content), options_(options), problems_(problems) {}

  void run() {
    load_cameras();
    join_triggered_cameras();
    check_against_camchain();
    load_segmentations();
    load_wheels();
    load_vehicle_measures();
    load_other_streams();
    if (content_.streams.empty() && content_.rig.cameras.empty() && !problems_.has_errors())
      problems_.error(content_.folder.string(), 0, "", "no sensor folder",
                      "cam0, wheels0 or another stream");
    content_.frames = index_frames(content_.images, options_.stamp_tolerance_s);
    warn_of_ended_cameras(content_.images, content_.frames, problems_);
    warn_of_unpaired_cameras(content_.images, options_.stamp_tolerance_s, problems_);
    warn_of_frozen_images(
        content_.images, [&](auto first, auto last) { return trace_.way_m(first, last); },
        problems_);
    // The frame index holds the stamps now; assigning {} would keep the memory.
    for (ImageStream& stream : content_.images) std::vector<std::int64_t>().swap(stream.stamps_ns);
    check_spans(content_.sensors, content_.frames.stamps_ns, wheel_span_, truth_span_, problems_);
  }

 private:
  void remember(const fs::path& sensor_folder) {
    for (const char* const name : {"sensor.yaml", "data.csv", "looks.csv"})
      if (fs::exists(sensor_folder / name)) content_.tables.push_back(sensor_folder / name);
  }

  void load_cameras() {
    for (const auto& folder : numbered_folders(content_.sensors, "cam")) {
      const auto file = read_camera_yaml(folder / "sensor.yaml", folder.filename().string(),
                                         options_.max_image_megapixels, problems_);
      StampLimits limits;
      limits.max_rate_hz = kMaxImageRate;
      limits.declared_rate_hz = file ? file->info.rate_hz : 0.0;
      const Camera lens = file ? file->camera.camera : Camera{};
      content_.images.push_back(
          load_image_stream(folder, {lens.width, lens.height}, limits, options_, problems_));
      warn_of_grey_range(content_.images.back(), problems_);
      MountedCamera mounted = file ? file->camera : MountedCamera{};
      content_.images.back().shift(offset_ns(mounted.time_offset_s));
      mounted.name = folder.filename().string();
      content_.rig.cameras.push_back(std::move(mounted));
      content_.streams.push_back(content_.images.back().summary);
      remember(folder);
    }
    if (content_.rig.cameras.size() > FrameIndex::kMaxCameras)
      problems_.error(content_.folder.string(), 0, "cameras",
                      std::to_string(content_.rig.cameras.size()),
                      "at most " + std::to_string(FrameIndex::kMaxCameras));
  }

  void join_triggered_cameras() {
    const std::vector<std::int64_t> after_ns =
        join_triggered_images(content_.images, options_.stamp_tolerance_s);
    for (std::size_t c = 0; c < after_ns.size(); ++c)
      content_.rig.cameras[c].exposed_after_s = 1e-9 * static_cast<double>(after_ns[c]);
  }

  // A file in the sensors' folder or, where the sensors are in mav0/, in its parent; the digest
  // covers the file.
  std::optional<fs::path> beside_sensors(const char* name) {
    for (const fs::path& file : {content_.sensors / name, content_.folder / name})
      if (fs::exists(file)) return content_.tables.emplace_back(file);
    return std::nullopt;
  }

  void check_against_camchain() {
    std::vector<fs::path> files = camchain_files(content_.sensors);
    if (files.empty()) files = camchain_files(content_.folder);
    // A sensor.yaml with faults would differ in everything.
    if (!problems_.has_errors()) check_camchains(files, content_.rig, problems_);
    content_.tables.insert(content_.tables.end(), files.begin(), files.end());
  }

  void load_segmentations() {
    for (const auto& folder : numbered_folders(content_.sensors, "segmentation")) {
      const fs::path yaml = folder / "sensor.yaml";
      const auto file = read_stream_yaml(yaml, problems_);
      if (!file) continue;
      const auto& cameras = content_.rig.cameras;
      const auto camera = std::find_if(cameras.begin(), cameras.end(),
                                       [&](const auto& c) { return c.name == file->camera; });
      if (camera == cameras.end()) {
        problems_.error(yaml.string(), 0, "camera", file->camera.empty() ? "nothing" : file->camera,
                        "the name of a camera of this drive");
        continue;
      }
      StampLimits limits;
      limits.max_rate_hz = kMaxImageRate;
      auto stream = load_image_stream(folder, {camera->camera.width, camera->camera.height}, limits,
                                      options_, problems_);
      content_.streams.push_back(stream.summary);
      const auto which = static_cast<std::size_t>(camera - cameras.begin());
      stream.shift(content_.images[which].shifted_ns);
      content_.segmentations[which] = std::move(stream);
      remember(folder);
    }
  }

  void load_wheels() {
    const fs::path folder = content_.sensors / "wheels0";
    if (!is_folder(folder)) return;
    const auto file = read_wheel_yaml(folder / "sensor.yaml", problems_);
    StampLimits limits;
    limits.declared_rate_hz = file ? file->info.rate_hz : 0.0;
    const WheelModel model = file ? file->wheels : WheelModel{};
    const auto offset_ns = static_cast<std::int64_t>(std::llround(model.time_offset_s * 1e9));
    content_.streams.push_back(read_wheel_table(folder / "data.csv", model, limits, problems_,
                                                [&](const WheelReading& row) {
                                                  wheel_span_.add(row.t_ns + offset_ns);
                                                  trace_.add(row.t_ns + offset_ns, row, model);
                                                }));
    content_.wheels = model;
    remember(folder);
  }

  void load_vehicle_measures() {
    // A sensor.yaml with faults may put a camera anywhere.
    const bool sound = !problems_.has_errors();
    if (const auto file = beside_sensors(kVehicleFile)) {
      content_.vehicle = read_vehicle_yaml(*file, problems_);
      if (content_.vehicle && sound)
        warn_of_vehicle(*file, content_.sensors, *content_.vehicle, content_.rig, content_.wheels,
                        problems_);
    }
    if (sound)
      warn_of_camera_places(content_.sensors, content_.rig, content_.wheels, content_.vehicle,
                            problems_);
  }

  // What the stream's sensor.yaml says, where it has one; empty where the drive has no such stream.
  template <typename Row>
  std::optional<StreamFile> load_stream(
      const std::string& name,
      StreamSummary (*read)(
          const fs::path&, const StampLimits&, ProblemList&, const RowVisitor<Row>&),
      const std::function<void(const StreamFile&, const Row&)>& visit = nullptr) {
    const fs::path folder = content_.sensors / name;
    if (!is_folder(folder)) return std::nullopt;
    StreamFile stated;
    if (fs::exists(folder / "sensor.yaml"))
      if (auto file = read_stream_yaml(folder / "sensor.yaml", problems_))
        stated = *std::move(file);
    StampLimits limits;
    limits.declared_rate_hz = stated.info.rate_hz;
    content_.streams.push_back(read(folder / "data.csv", limits, problems_, [&](const Row& row) {
      if (visit) visit(stated, row);
    }));
    remember(folder);
    return stated;
  }

  void load_other_streams() {
    GyroCheck gyro(trace_);
    content_.imu = load_stream<ImuReading>(
        "imu0", &read_imu_table, [&](const StreamFile& imu, const ImuReading& row) {
          gyro.add(row.t_ns + offset_ns(imu.time_offset_s),
                   imu.T_vehicle_sensor.linear().row(2).dot(row.angular_velocity_rad_s));
        });
    gyro.report((content_.sensors / "imu0" / "data.csv").string(), problems_);
    if (const auto range = load_stream<RangeReading>("range0", &read_range_table)) {
      content_.has_range = true;
      content_.range = range->range;
    }
    content_.friction = load_stream<FrictionReading>("friction0", &read_friction_table);
    load_detector();
    const fs::path truth = content_.sensors / "state_groundtruth_estimate0";
    content_.has_truth = is_folder(truth);
    if (!content_.has_truth) return;
    if (fs::exists(truth / "sensor.yaml"))
      if (auto file = read_stream_yaml(truth / "sensor.yaml", problems_))
        content_.truth = *std::move(file);
    const std::int64_t added_ns = offset_ns(content_.truth.time_offset_s);
    content_.streams.push_back(
        read_truth_table(truth / "data.csv", problems_,
                         [&](const TimedPose& row) { truth_span_.add(row.t_ns + added_ns); }));
    remember(truth);
  }

  // The rows of detections may have any order of time.
  template <typename Read>
  void load_detector_table(const fs::path& file, const std::string& name, const Read& read) {
    if (!fs::exists(file)) return;
    try {
      std::vector<std::int64_t> stamps;
      for (const auto& row : read(file)) stamps.push_back(row.t_ns);
      content_.streams.push_back(summary_in_any_order(name, std::move(stamps)));
    } catch (const BadInput& bad) {
      problems_.add_all(bad.problems());
    }
  }

  void load_detector() {
    const fs::path folder = content_.sensors / "detector0";
    const fs::path yaml = folder / "sensor.yaml";
    remember(folder);
    load_detector_table(folder / "data.csv", "detector0", &read_detections);
    load_detector_table(folder / "looks.csv", "detector0 looks", &read_looks);
    const auto file = fs::exists(yaml) ? read_stream_yaml(yaml, problems_) : std::nullopt;
    if (file && (file->time_offset_s != 0.0 ||
                 !file->T_vehicle_sensor.isApprox(Eigen::Isometry3d::Identity())))
      problems_.error(yaml.string(), 0, "T_BS or time_offset", "a mounting or clock of its own",
                      "none: detections lie in a camera's images and carry their stamps");
  }

  DriveContent& content_;
  const DriveOptions& options_;
  ProblemList& problems_;
  StampSpan wheel_span_;
  StampSpan truth_span_;
  WheelTrace trace_;
};

}  // namespace

DriveContent load_drive(const fs::path& folder,
                        const DriveOptions& options,
                        ProblemList& problems) {
  DriveContent content;
  content.folder = folder;
  content.sensors = is_folder(folder / "mav0") ? folder / "mav0" : folder;
  if (!is_folder(folder)) {
    problems.error(folder.string(), 0, "", "no such folder", "a recorded drive");
    return content;
  }
  if (fs::exists(folder / kUnfinishedMark))
    problems.error((folder / kUnfinishedMark).string(), 0, "",
                   "a drive whose writing was broken off", "a finished one");
  Loader(content, options, problems).run();
  return content;
}

}  // namespace roadbook
