#include "drive/drive.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <set>
#include <utility>

#include "base/digest.hpp"
#include "drive/images/png_grey.hpp"
#include "drive/loader.hpp"
#include "drive/sensor_yaml.hpp"
#include "drive/tables.hpp"
#include "sensors/correction.hpp"
#include "sensors/imu_imperfections.hpp"

namespace roadbook {

namespace fs = std::filesystem;

struct Drive::Impl {
  DriveContent content;
  EffectSizes known;                           ///< the readings are corrected for these
  std::int64_t origin_ns = 0;                  ///< where clocks that drift agree
  std::optional<WheelModel> corrected_wheels;  ///< where `known` has anything
  std::optional<RangeModel> corrected_range;
  mutable ProblemList problems;
  mutable std::mutex mutex;
  mutable std::set<fs::path> reported;  ///< images whose damage has been counted

  cv::Mat decode(const fs::path& file, std::size_t camera, const GreyRange& greys) const {
    const Camera& lens = content.rig.cameras[camera].camera;
    std::string why;
    cv::Mat image = decode_image_file(file, {lens.width, lens.height}, why, greys);
    if (!image.empty()) return image;
    const std::scoped_lock lock(mutex);
    if (reported.insert(file).second) problems.warning(file.string(), 0, "", why, "an image");
    return {};
  }

  [[nodiscard]] std::int64_t late_images_ns() const {
    return offset_ns(effect_size(known, "cam", "latency"));
  }

  // Rows were checked when the drive was opened; a fault now means that the file has changed.
  template <typename Row, typename Read>
  void stream(const char* name, const Read& read) const {
    ProblemList found;
    read(content.sensors / name / "data.csv", found);
    if (found.has_errors()) throw BadInput(found.problems());
  }
};

Drive::Drive(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Drive::Drive(Drive&&) noexcept = default;
Drive& Drive::operator=(Drive&&) noexcept = default;
Drive::~Drive() = default;

Drive Drive::open(const fs::path& folder, const DriveOptions& options) {
  auto impl = std::make_unique<Impl>();
  impl->content = load_drive(folder, options, impl->problems);
  if (impl->problems.has_errors()) throw BadInput(impl->problems.problems());
  return Drive(std::move(impl));
}

const fs::path& Drive::folder() const { return impl_->content.folder; }

std::string Drive::name() const {
  fs::path path = fs::absolute(folder()).lexically_normal();
  if (path.filename().empty()) path = path.parent_path();
  return path.filename().string();
}

const Rig& Drive::rig() const { return impl_->content.rig; }

std::vector<Problem> Drive::warnings() const { return impl_->problems.problems(); }

const std::vector<StreamSummary>& Drive::streams() const { return impl_->content.streams; }

std::size_t Drive::frame_count() const { return impl_->content.frames.stamps_ns.size(); }

std::int64_t Drive::frame_stamp_ns(std::size_t frame) const {
  return impl_->content.frames.stamps_ns.at(frame);
}

std::int64_t Drive::image_stamp_ns(std::size_t frame, std::size_t camera) const {
  return impl_->content.frames.image_stamp_ns(frame, camera);
}

std::int64_t Drive::written_stamp_ns(std::size_t frame, std::size_t camera) const {
  return image_stamp_ns(frame, camera) - impl_->content.images.at(camera).shifted_ns;
}

bool Drive::has_image(std::size_t frame, std::size_t camera) const {
  return (impl_->content.frames.cameras.at(frame) >> camera & 1u) != 0;
}

fs::path Drive::image_path(std::size_t frame, std::size_t camera) const {
  const ImageStream& stream = impl_->content.images.at(camera);
  return stream.folder / stream.names.at(image_stamp_ns(frame, camera));
}

std::optional<std::filesystem::path> Drive::mask_path(std::size_t camera) const {
  auto file = impl_->content.sensors / rig().cameras.at(camera).name / "mask.png";
  return std::filesystem::exists(file) ? std::optional(std::move(file)) : std::nullopt;
}

cv::Mat Drive::read_image(std::size_t frame, std::size_t camera) const {
  if (!has_image(frame, camera)) return {};
  return impl_->decode(image_path(frame, camera), camera,
                       impl_->content.images.at(camera).greys.value_or(GreyRange{}));
}

cv::Mat Drive::read_image_half(std::size_t frame, std::size_t camera) const {
  return half_size(read_image(frame, camera));
}

cv::Mat Drive::read_segmentation(std::size_t frame, std::size_t camera) const {
  const auto found = impl_->content.segmentations.find(camera);
  if (found == impl_->content.segmentations.end()) return {};
  const ImageStream& stream = found->second;
  const std::int64_t t_ns = image_stamp_ns(frame, camera);
  if (!std::binary_search(stream.stamps_ns.begin(), stream.stamps_ns.end(), t_ns)) return {};
  constexpr GreyRange kClasses{0, 256};  // an index stays what it is
  return impl_->decode(stream.folder / stream.names.at(t_ns), camera, kClasses);
}

void Drive::correct(const EffectSizes& sizes) {
  check_effects(sizes);
  for (const auto& name : not_corrected(sizes))
    impl_->problems.warning(impl_->content.folder.string(), 0, "model",
                            name + ", which is not corrected for",
                            name.starts_with("ground.")
                                ? "an effect of cameras or wheels: the shape of the ground is no "
                                  "fault of a sensor, a map measures it itself"
                                : "an effect of cameras or wheels");
  impl_->known = sizes;
  const auto poses = frame_count() > 0 ? std::vector<TimedPose>{} : truth();
  if (frame_count() > 0)
    impl_->origin_ns = frame_stamp_ns(0);
  else if (!poses.empty())
    impl_->origin_ns = poses.front().t_ns;
  else  // nothing against which a clock could drift
    impl_->known.erase("clock.drift");
  impl_->content.rig = roadbook::corrected_rig(impl_->content.rig, sizes);
  if (const auto& wheels = impl_->content.wheels)
    impl_->corrected_wheels = roadbook::corrected_wheels(*wheels, sizes);
  if (const auto& range = impl_->content.range)
    impl_->corrected_range = roadbook::corrected_range(*range, sizes);
}

const std::optional<VehicleMeasures>& Drive::vehicle() const { return impl_->content.vehicle; }

const std::optional<WheelModel>& Drive::wheel_model() const {
  return impl_->corrected_wheels ? impl_->corrected_wheels : impl_->content.wheels;
}

void Drive::for_each_wheel_reading(const std::function<void(const WheelReading&)>& visit) const {
  const auto& nominal = impl_->content.wheels;
  if (!nominal) return;
  std::vector<WheelReading> kept;
  const bool correct = impl_->corrected_wheels.has_value();
  impl_->stream<WheelReading>("wheels0", [&](const fs::path& file, ProblemList& problems) {
    (void)read_wheel_table(file, *nominal, {}, problems, [&](const WheelReading& reading) {
      if (correct)
        kept.push_back(reading);
      else
        visit(reading);
    });
  });
  if (!correct) return;
  for (const auto& reading :
       corrected_readings(*nominal, impl_->known, impl_->origin_ns, std::move(kept)))
    visit(reading);
}

std::vector<WheelReading> Drive::wheel_readings() const {
  std::vector<WheelReading> readings;
  for_each_wheel_reading([&](const WheelReading& reading) { readings.push_back(reading); });
  return readings;
}

const std::optional<RangeModel>& Drive::range_model() const {
  return impl_->corrected_range ? impl_->corrected_range : impl_->content.range;
}

void Drive::for_each_imu_reading(const std::function<void(const ImuReading&)>& visit) const {
  const auto& imu = impl_->content.imu;
  if (!imu) return;
  const Eigen::Matrix3d R = imu->T_vehicle_sensor.linear();
  const std::int64_t added_ns = offset_ns(imu->time_offset_s);
  impl_->stream<ImuReading>("imu0", [&](const fs::path& file, ProblemList& problems) {
    const auto off = imu_imperfections(impl_->known);
    const Eigen::Matrix3d tilt = tilt_rotation(off.tilt_roll, off.tilt_pitch);
    const std::int64_t shift_ns = added_ns + impl_->late_images_ns() - offset_ns(off.latency);
    (void)read_imu_table(file, {}, problems, [&](ImuReading reading) {
      reading.t_ns = corrected_stamp(impl_->known, impl_->origin_ns, reading.t_ns) + shift_ns;
      reading.angular_velocity_rad_s = R * reading.angular_velocity_rad_s;
      reading.specific_force_m_s2 = R * reading.specific_force_m_s2;
      reading.angular_velocity_rad_s.z() -= off.gyro_bias;
      reading.angular_velocity_rad_s =
          tilt * reading.angular_velocity_rad_s / (1.0 + off.gyro_scale);
      reading.specific_force_m_s2 = tilt * reading.specific_force_m_s2;
      visit(reading);
    });
  });
}

void Drive::for_each_friction_reading(
    const std::function<void(const FrictionReading&)>& visit) const {
  const auto& friction = impl_->content.friction;
  if (!friction) return;
  const std::int64_t added_ns = offset_ns(friction->time_offset_s) + impl_->late_images_ns();
  impl_->stream<FrictionReading>("friction0", [&](const fs::path& file, ProblemList& problems) {
    (void)read_friction_table(file, {}, problems, [&](FrictionReading reading) {
      reading.t_ns += added_ns;
      visit(reading);
    });
  });
}

void Drive::for_each_range_reading(const std::function<void(const RangeReading&)>& visit) const {
  if (!impl_->content.has_range) return;
  impl_->stream<RangeReading>("range0", [&](const fs::path& file, ProblemList& problems) {
    (void)read_range_table(file, {}, problems, visit);
  });
}

std::vector<TimedPose> Drive::truth() const {
  std::vector<TimedPose> poses;
  if (!impl_->content.has_truth) return poses;
  const StreamFile& stated = impl_->content.truth;
  const Eigen::Isometry3d T_sensor_vehicle = stated.T_vehicle_sensor.inverse();
  const std::int64_t added_ns = offset_ns(stated.time_offset_s);
  impl_->stream<TimedPose>("state_groundtruth_estimate0",
                           [&](const fs::path& file, ProblemList& problems) {
                             (void)read_truth_table(file, problems, [&](TimedPose pose) {
                               pose.t_ns += added_ns;
                               pose.T_world_vehicle = pose.T_world_vehicle * T_sensor_vehicle;
                               poses.push_back(pose);
                             });
                           });
  return poses;
}

std::string Drive::digest() const {
  Sha256 digest;
  for (const auto& table : impl_->content.tables)
    digest.update(table.lexically_relative(impl_->content.sensors).string()).update_file(table);
  for (const auto& stream : impl_->content.images) digest.update(stream.digest);
  for (const auto& [camera, stream] : impl_->content.segmentations) digest.update(stream.digest);
  // Earlier programs counted the images of such cameras as other instants.
  for (std::size_t c = 0; c < impl_->content.images.size(); ++c)
    if (impl_->content.images[c].shifted_ns != offset_ns(rig().cameras[c].time_offset_s))
      digest.update("an instant with the first camera");
  return digest.hex();
}

}  // namespace roadbook
