#include "workflows/occupancy/drive_scans.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/format.hpp"
#include "base/text.hpp"
#include "drive/csv.hpp"
#include "drive/sensor_yaml.hpp"

namespace roadbook {
namespace {

std::filesystem::path range_folder(const Drive& drive) {
  const auto level = drive.folder() / "mav0";
  return (std::filesystem::is_directory(level) ? level : drive.folder()) / "range0";
}

RangeModel model_of(const Drive& drive, const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder / "data.csv"))
    throw BadInput({Severity::kError, drive.folder().string(), 0, "range0", "no such stream",
                    "a drive with a range scanner (or --sensor cameras)"});
  const auto& model = drive.range_model();
  if (!model || model->azimuth_rad.empty())
    throw BadInput({Severity::kError, (folder / "sensor.yaml").string(), 0, "beam_azimuths", "none",
                    "the direction of each beam [rad], with max_range and sigma"});
  return *model;
}

// Adds the readings of one stamp to the scans.
class ScanBuilder {
 public:
  ScanBuilder(const RangeModel& model, const PoseAt& pose_at, DriveScans& out)
      : model_(model), pose_at_(pose_at), out_(out) {}

  void add(std::int64_t t_ns, std::uint32_t beam, double read_m) {
    if (t_ns != t_ns_) begin(t_ns);
    if (!T_map_sensor_) return;
    const double azimuth = model_.azimuth_rad[beam];
    const Eigen::Vector3d level =
        T_map_sensor_->linear() * Eigen::Vector3d(std::cos(azimuth), std::sin(azimuth), 0.0);
    const double flat = level.head<2>().norm();
    if (flat < 0.5) return;  // the beam points at the floor or the sky
    // No echo within the maximum range stays what it is.
    const double read = is_maximum(read_m, model_.max_m) ? model_.max_m : flat * read_m;
    out_.scans.back().beams.push_back({beam, (level.head<2>() / flat).cast<float>(), read});
  }

 private:
  void begin(std::int64_t t_ns) {
    t_ns_ = t_ns;
    T_map_sensor_.reset();
    const std::int64_t stamp = t_ns + offset_ns(model_.time_offset_s);
    const auto T = pose_at_(stamp);
    if (!T) {
      ++out_.without_pose;
      return;
    }
    T_map_sensor_ = *T * model_.T_vehicle_sensor;
    RangeScan scan;
    scan.t_ns = stamp;
    scan.origin = T_map_sensor_->translation().head<2>();
    out_.scans.push_back(std::move(scan));
  }

  const RangeModel& model_;
  const PoseAt& pose_at_;
  DriveScans& out_;
  std::int64_t t_ns_ = INT64_MIN;
  std::optional<Eigen::Isometry3d> T_map_sensor_;
};

}  // namespace

DriveScans read_drive_scans(const Drive& drive, const PoseAt& pose_at) {
  const auto folder = range_folder(drive);
  DriveScans out;
  out.model = model_of(drive, folder);
  ScanBuilder builder(out.model, pose_at, out);
  ProblemList problems;
  CsvReader csv(folder / "data.csv", CsvHeader::kRequired, problems);
  const auto t_column = csv.require("timestamp", "ns|");
  const auto beam_column = csv.require("beam", "|-");
  const auto range_column = csv.require("range", "m");
  const auto beams = static_cast<std::int64_t>(out.model.azimuth_rad.size());
  while (t_column && beam_column && range_column && csv.next()) {
    const auto t = csv.stamp(*t_column);
    const auto beam = parse_int(csv.fields()[*beam_column]);
    const auto read = csv.number(*range_column);
    if (!t || !read) continue;
    const bool known = beam && *beam >= 0 && *beam < beams;
    if (!known)
      problems.error(csv.file(), csv.line(), "beam", printable(csv.fields()[*beam_column]),
                     "0 to " + std::to_string(beams - 1) + " (beam_azimuths of sensor.yaml)");
    const bool in_range = *read >= 0.0 && *read <= out.model.max_m * (1.0 + 1e-6);
    if (!in_range)
      problems.error(csv.file(), csv.line(), "range", std::to_string(*read),
                     "0 to max_range of sensor.yaml, " + fixed(out.model.max_m, 3) + " m");
    if (known && in_range)
      builder.add(*t, static_cast<std::uint32_t>(*beam), std::min(*read, out.model.max_m));
  }
  if (problems.has_errors()) throw BadInput(problems.problems());
  return out;
}

}  // namespace roadbook
