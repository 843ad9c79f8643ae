#include <algorithm>
#include <cmath>
#include <numbers>

#include "drive/csv.hpp"
#include "drive/import/import_support.hpp"
#include "drive/import/import_video.hpp"
#include "drive/import/npy.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// Toyota RAV4 (2017): the data state none of these.
constexpr double kWheelRadius = 0.36;  // 225/65 R17
constexpr double kTrack = 1.57;
constexpr double kWheelbase = 2.65;
constexpr double kSteeringRatio = 16.88;  // comma.ai's openpilot

// A signal: stamps and rows of numbers.
struct Signal {
  fs::path file;
  std::vector<std::int64_t> t_ns;
  std::vector<std::vector<double>> rows;
  std::vector<std::int64_t> lines;  // 0: a file without lines
};

Signal from_csv(const fs::path& file, std::size_t columns) {
  const TextTable table = read_text_table(file, ',', columns);
  Signal signal{file, {}, {}, {}};
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto t = seconds_to_ns(table.rows[i][0]);
    if (!t) refuse(file, table.lines[i], "t_s", printable(table.rows[i][0]), "seconds >= 0");
    signal.t_ns.push_back(*t);
    signal.lines.push_back(table.lines[i]);
    signal.rows.push_back(row_numbers(file, table, i, 1));
  }
  return signal;
}

Signal from_npy(const fs::path& times, const fs::path& values, std::size_t columns) {
  const NpyArray t = read_npy(times);
  const NpyArray v = read_npy(values);
  if (t.values.size() != v.rows() || (v.rows() > 0 && v.columns() != columns))
    refuse(values, 0, "shape", std::to_string(v.rows()) + " x " + std::to_string(v.columns()),
           std::to_string(t.values.size()) + " x " + std::to_string(columns));
  Signal signal{times, {}, {}, {}};
  for (std::size_t i = 0; i < t.values.size(); ++i) {
    if (!(t.values[i] >= 0.0) || !(t.values[i] < 9e9))
      refuse(times, 0, "t", "no seconds", "0..9e9");
    signal.t_ns.push_back(std::llround(t.values[i] * 1e9));
    signal.lines.push_back(0);
    const auto begin = v.values.begin() + static_cast<std::ptrdiff_t>(i * columns);
    signal.rows.emplace_back(begin, begin + static_cast<std::ptrdiff_t>(columns));
  }
  return signal;
}

// Linear between the neighbours; empty outside the signal.
std::optional<std::vector<double>> at(const Signal& signal, std::int64_t t_ns) {
  const auto after = std::lower_bound(signal.t_ns.begin(), signal.t_ns.end(), t_ns);
  if (after == signal.t_ns.end()) return std::nullopt;
  const auto i = static_cast<std::size_t>(after - signal.t_ns.begin());
  if (*after == t_ns) return signal.rows[i];
  if (i == 0) return std::nullopt;
  const double a = static_cast<double>(t_ns - signal.t_ns[i - 1]) /
                   static_cast<double>(signal.t_ns[i] - signal.t_ns[i - 1]);
  std::vector<double> row = signal.rows[i - 1];
  for (std::size_t k = 0; k < row.size(); ++k) row[k] += a * (signal.rows[i][k] - row[k]);
  return row;
}

// Rows that repeat a stamp or go back are left out, and counted; too many are refused.
void make_ascending(Signal& signal, const ImportOptions& options, ImportResult& result) {
  Ascending order(signal.file);
  Signal kept{signal.file, {}, {}, {}};
  for (std::size_t i = 0; i < signal.t_ns.size(); ++i) {
    if (!order.accept(signal.t_ns[i], signal.lines[i])) continue;
    kept.t_ns.push_back(signal.t_ns[i]);
    kept.lines.push_back(signal.lines[i]);
    kept.rows.push_back(std::move(signal.rows[i]));
  }
  order.report(options, result);
  signal = std::move(kept);
}

struct Recording {
  Signal wheels;    // front left, front right, rear left, rear right [m/s]
  Signal steering;  // steering wheel [deg], positive to the left
  Signal gyro;      // forward, right, down [rad/s]
  Signal accel;     // forward, right, down [m/s^2]
  std::vector<TimedPose> poses;
};

// Device poses: ENU, yaw anticlockwise from east, pitch up, roll to the right.
std::vector<TimedPose> csv_poses(const fs::path& file,
                                 const ImportOptions& options,
                                 ImportResult& result) {
  Signal signal = from_csv(file, 13);
  make_ascending(signal, options, result);
  std::vector<TimedPose> poses;
  for (std::size_t i = 0; i < signal.t_ns.size(); ++i) {
    const auto& v = signal.rows[i];
    TimedPose pose;
    pose.t_ns = signal.t_ns[i];
    pose.T_world_vehicle.linear() = (Eigen::AngleAxisd(v[6], Eigen::Vector3d::UnitZ()) *
                                     Eigen::AngleAxisd(-v[7], Eigen::Vector3d::UnitY()) *
                                     Eigen::AngleAxisd(v[8], Eigen::Vector3d::UnitX()))
                                        .toRotationMatrix();
    pose.T_world_vehicle.translation() << v[0], v[1], v[2];
    poses.push_back(pose);
  }
  return poses;
}

// Positions and orientations (ECEF <- device: forward, right, down) of the video's frames.
std::vector<TimedPose> npy_poses(const fs::path& folder) {
  const Signal p = from_npy(folder / "frame_times", folder / "frame_positions", 3);
  const Signal q = from_npy(folder / "frame_times", folder / "frame_orientations", 4);
  const Eigen::Quaterniond flip(Eigen::AngleAxisd(std::numbers::pi, Eigen::Vector3d::UnitX()));
  std::vector<TimedPose> poses;
  for (std::size_t i = 0; i < p.t_ns.size(); ++i) {
    const Eigen::Quaterniond device(q.rows[i][0], q.rows[i][1], q.rows[i][2], q.rows[i][3]);
    if (!(std::abs(device.norm() - 1.0) < 1e-2))
      refuse(folder / "frame_orientations", 0, "quaternion", "another length", "1");
    if (i > 0 && p.t_ns[i] <= p.t_ns[i - 1])
      refuse(p.file, 0, "t", "frame " + std::to_string(i) + " not after the one before",
             "ascending stamps");
    TimedPose pose;
    pose.t_ns = p.t_ns[i];
    pose.T_world_vehicle.linear() = (device.normalized() * flip).toRotationMatrix();
    pose.T_world_vehicle.translation() << p.rows[i][0], p.rows[i][1], p.rows[i][2];
    poses.push_back(pose);
  }
  return poses;
}

Recording read_csv_layout(const ImportJob& job, ImportResult& result) {
  const fs::path& source = job.source;
  Recording recording;
  recording.wheels = from_csv(source / "wheel_speed.csv", 5);
  if (fs::exists(source / "steering.csv"))
    recording.steering = from_csv(source / "steering.csv", 2);
  if (fs::exists(source / "gyro.csv") && fs::exists(source / "accel.csv")) {
    recording.gyro = from_csv(source / "gyro.csv", 4);
    recording.accel = from_csv(source / "accel.csv", 4);
  }
  if (fs::exists(source / "reference_pose.csv"))
    recording.poses = csv_poses(source / "reference_pose.csv", job.options, result);
  return recording;
}

Recording read_npy_layout(const fs::path& source) {
  const fs::path log = source / "processed_log";
  const auto read = [&](const fs::path& folder, std::size_t columns) {
    if (!fs::exists(folder / "t")) return Signal{};
    return from_npy(folder / "t", folder / "value", columns);
  };
  Recording recording;
  recording.wheels = read(log / "CAN" / "wheel_speed", 4);
  recording.steering = read(log / "CAN" / "steering_angle", 1);
  recording.gyro = read(log / "IMU" / "gyro", 3);
  recording.accel = read(log / "IMU" / "accelerometer", 3);
  if (fs::exists(source / "global_pose" / "frame_times"))
    recording.poses = npy_poses(source / "global_pose");
  return recording;
}

void write_wheels(const Recording& recording,
                  const ImportOptions& options,
                  DriveWriter& writer,
                  ImportResult& result) {
  double left = 0.0;
  double right = 0.0;
  const auto& [file, t, rows, lines] = recording.wheels;
  const bool steered = !recording.steering.t_ns.empty();
  LeftOut early(file, "rows", "lie before the first steering angle", "steering from the start on");
  for (std::size_t i = 0; i < t.size(); ++i) {
    if (i > 0) {
      const double half_s = 0.5e-9 * static_cast<double>(t[i] - t[i - 1]);
      left += half_s * (rows[i - 1][2] + rows[i][2]) / kWheelRadius;
      right += half_s * (rows[i - 1][3] + rows[i][3]) / kWheelRadius;
    }
    WheelReading reading{t[i], left, right, std::nullopt};
    if (const auto angle = steered ? at(recording.steering, t[i]) : std::nullopt)
      reading.steering_rad = (*angle)[0] * std::numbers::pi / 180.0 / kSteeringRatio;
    // The first row decides whether the drive has steering at all: begin where it is known.
    if (steered && !reading.steering_rad && result.wheel_rows == 0) {
      early.leave(lines[i]);
      continue;
    }
    early.take();
    writer.write_wheels(reading);
    ++result.wheel_rows;
  }
  early.report(options, result);
}

void write_imu(const Recording& recording,
               const ImportOptions& options,
               DriveWriter& writer,
               ImportResult& result) {
  const std::size_t rates = recording.gyro.t_ns.size();
  if (rates > 0 && recording.accel.t_ns.empty()) {
    result.warnings.push_back({Severity::kWarning, recording.gyro.file.string(), 0, "gyro",
                               std::to_string(rates) + " rows without an accelerometer; left out",
                               "turn rates and accelerations"});
    return;
  }
  LeftOut apart(recording.gyro.file, "rows", "lie outside the accelerometer's time",
                "turn rates and accelerations of the same time");
  for (std::size_t i = 0; i < recording.gyro.t_ns.size(); ++i) {
    const std::int64_t t = recording.gyro.t_ns[i];
    const auto f = at(recording.accel, t);
    if (!f) {
      apart.leave(recording.gyro.lines[i]);
      continue;
    }
    apart.take();
    const auto& w = recording.gyro.rows[i];
    // Forward, right, down becomes forward, left, up.
    writer.write_imu({t, {w[0], -w[1], -w[2]}, {(*f)[0], -(*f)[1], -(*f)[2]}});
    ++result.imu_rows;
  }
  apart.report(options, result);
}

}  // namespace

ImportResult import_comma2k19(const ImportJob& job) {
  ImportResult result;
  const bool npy = fs::is_directory(job.source / "processed_log");
  Recording recording = npy ? read_npy_layout(job.source) : read_csv_layout(job, result);
  for (Signal* const signal :
       {&recording.wheels, &recording.steering, &recording.gyro, &recording.accel})
    make_ascending(*signal, job.options, result);
  WheelModel wheels;
  wheels.radius_left_m = wheels.radius_right_m = kWheelRadius;
  wheels.track_width_m = kTrack;
  wheels.wheelbase_m = kWheelbase;
  wheels.steering_ratio = kSteeringRatio;
  DriveWriterOptions writing;
  writing.overwrite = job.options.overwrite;
  writing.comment =
      "comma2k19; wheel speeds integrated; sizes are those of a Toyota RAV4; poses are the "
      "device's";
  const bool video = fs::exists(job.source / "video.hevc") && !recording.poses.empty();
  Rig rig;
  if (video) rig.cameras.push_back(comma_camera());
  std::optional<WheelModel> model;
  if (!recording.wheels.t_ns.empty()) model = wheels;
  DriveWriter writer(job.out, rig, model, writing);
  write_wheels(recording, job.options, writer, result);
  write_imu(recording, job.options, writer, result);
  if (video) {
    FrameStamps stamps;
    for (const auto& pose : recording.poses) stamps.push_back(pose.t_ns);
    result.images = import_video_frames(job.source / "video.hevc", stamps, writer, job.progress);
  }
  if (!recording.poses.empty()) writer.write_truth(recording.poses);
  result.poses = recording.poses.size();
  writer.finish();
  return result;
}

}  // namespace roadbook
