#include "drive/loader.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/text.hpp"
#include "drive/camchain.hpp"
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

// First and last stamp of a stream.
struct Span {
  std::int64_t first_ns = std::numeric_limits<std::int64_t>::max();
  std::int64_t last_ns = -1;

  void add(std::int64_t t_ns) {
    first_ns = std::min(first_ns, t_ns);
    last_ns = std::max(last_ns, t_ns);
  }
  [[nodiscard]] bool known() const { return first_ns <= last_ns; }
  [[nodiscard]] bool meets(const Span& other) const {
    return first_ns <= other.last_ns && other.first_ns <= last_ns;
  }
  /// But for what sensors take to start and stop.
  [[nodiscard]] bool covers(const Span& other) const {
    constexpr std::int64_t kSlackNs = 1'000'000'000;
    return first_ns - other.first_ns <= kSlackNs && other.last_ns - last_ns <= kSlackNs;
  }
};

std::string to_text(const Span& span) {
  return std::to_string(span.first_ns) + " to " + std::to_string(span.last_ns) + " ns";
}

class Loader {
 public:
  Loader(DriveContent& content, const DriveOptions& options, ProblemList& problems)
      : content_(content), options_(options), problems_(problems) {}

  void run() {
    load_cameras();
    check_against_camchain();
    load_segmentations();
    load_wheels();
    load_vehicle_measures();
    load_other_streams();
    if (content_.streams.empty() && content_.rig.cameras.empty() && !problems_.has_errors())
      problems_.error(content_.folder.string(), 0, "", "no sensor folder",
                      "cam0, wheels0 or another stream");
    content_.frames = index_frames(content_.images);
    warn_of_ended_cameras(content_.images, content_.frames, problems_);
    // The frame index holds the stamps now; assigning {} would keep the memory.
    for (ImageStream& stream : content_.images) std::vector<std::int64_t>().swap(stream.stamps_ns);
    check_spans();
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
      MountedCamera mounted = file ? file->camera : MountedCamera{};
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
      content_.segmentations[static_cast<std::size_t>(camera - cameras.begin())] =
          std::move(stream);
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
    content_.streams.push_back(
        read_wheel_table(folder / "data.csv", model, limits, problems_,
                         [&](const WheelReading& row) { wheel_span_.add(row.t_ns + offset_ns); }));
    content_.wheels = model;
    remember(folder);
  }

  void load_vehicle_measures() {
    const auto file = beside_sensors(kVehicleFile);
    if (!file) return;
    const bool sound = !problems_.has_errors();
    content_.vehicle = read_vehicle_yaml(*file, problems_);
    // A sensor.yaml with faults may put a camera anywhere.
    if (content_.vehicle && sound)
      warn_of_vehicle(*file, *content_.vehicle, content_.rig, content_.wheels, problems_);
  }

  // What the stream's sensor.yaml says, where it has one; empty where the drive has no such stream.
  template <typename Row>
  std::optional<StreamFile> load_stream(const std::string& name,
                                        StreamSummary (*read)(const fs::path&,
                                                              const StampLimits&,
                                                              ProblemList&,
                                                              const RowVisitor<Row>&)) {
    const fs::path folder = content_.sensors / name;
    if (!is_folder(folder)) return std::nullopt;
    StreamFile stated;
    if (fs::exists(folder / "sensor.yaml"))
      if (auto file = read_stream_yaml(folder / "sensor.yaml", problems_))
        stated = *std::move(file);
    StampLimits limits;
    limits.declared_rate_hz = stated.info.rate_hz;
    content_.streams.push_back(read(folder / "data.csv", limits, problems_, [](const Row&) {}));
    remember(folder);
    return stated;
  }

  void load_other_streams() {
    content_.imu = load_stream<ImuReading>("imu0", &read_imu_table);
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

  // Its table is read where it is used (detections.hpp); the digest covers it.
  void load_detector() {
    const fs::path yaml = content_.sensors / "detector0" / "sensor.yaml";
    remember(yaml.parent_path());
    const auto file = fs::exists(yaml) ? read_stream_yaml(yaml, problems_) : std::nullopt;
    if (file && (file->time_offset_s != 0.0 ||
                 !file->T_vehicle_sensor.isApprox(Eigen::Isometry3d::Identity())))
      problems_.error(yaml.string(), 0, "T_BS or time_offset", "a mounting or clock of its own",
                      "none: detections lie in a camera's images and carry their stamps");
  }

  // Wheels of another clock or unit would give wrong results without any message. Wheels that cover
  // the images in part, or a truth that does not overlap them, deserve a warning.
  void check_spans() {
    const auto& frames = content_.frames.stamps_ns;
    if (frames.empty() || problems_.has_errors()) return;
    const Span images{frames.front(), frames.back()};
    const std::string wheels = (content_.sensors / "wheels0" / "data.csv").string();
    const std::string want = "the time of the images, " + to_text(images);
    if (wheel_span_.known() && !wheel_span_.meets(images))
      problems_.error(wheels, 0, "timestamp", to_text(wheel_span_), want);
    else if (wheel_span_.known() && !wheel_span_.covers(images))
      problems_.warning(wheels, 0, "timestamp", to_text(wheel_span_), want);
    if (truth_span_.known() && !truth_span_.meets(images))
      problems_.warning((content_.sensors / "state_groundtruth_estimate0" / "data.csv").string(), 0,
                        "timestamp", to_text(truth_span_), want);
  }

  DriveContent& content_;
  const DriveOptions& options_;
  ProblemList& problems_;
  Span wheel_span_;
  Span truth_span_;
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
