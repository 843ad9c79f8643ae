#include <array>
#include <map>
#include <numbers>

#include "base/text.hpp"
#include "base/yaml.hpp"
#include "drive/csv.hpp"
#include "drive/import/import_support.hpp"
#include "drive/wheel_counter.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// "Encoder resolution: 4096" and so on, one a line.
WheelModel read_encoder_parameters(const fs::path& file) {
  LineReader reader(file);
  if (!reader.is_open()) refuse(file, 0, "", "no readable file", "EncoderParameter.txt");
  std::map<std::string, double> values;
  while (const auto text = reader.next()) {
    const auto colon = text->find(':');
    if (colon == std::string_view::npos) continue;
    const auto value = parse_double(text->substr(colon + 1));
    if (!value || !(*value > 0.0))
      refuse(file, reader.line(), printable(trim(text->substr(0, colon))),
             printable(text->substr(colon + 1)), "a positive number");
    values[std::string(trim(text->substr(0, colon)))] = *value;
  }
  const auto value = [&](const std::string& key) {
    const auto found = values.find(key);
    if (found == values.end()) refuse(file, 0, key, "no such line", "a positive number");
    return found->second;
  };
  WheelModel wheels;
  wheels.ticks_per_turn = value("Encoder resolution");
  wheels.radius_left_m = 0.5 * value("Encoder left wheel diameter");
  wheels.radius_right_m = 0.5 * value("Encoder right wheel diameter");
  wheels.track_width_m = value("Encoder wheel base");  // KAIST calls the track so
  return wheels;
}

// "R: nine numbers" and "T: three numbers" of Vehicle2Stereo.txt: vehicle <- left camera.
Eigen::Isometry3d read_stereo_mount(const fs::path& file) {
  const TextTable table = read_text_table(file, ' ', 0);
  Eigen::Matrix<double, 3, 4, Eigen::RowMajor> m = decltype(m)::Zero();
  std::int64_t line = 0;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::string& key = table.rows[i].front();
    if (key != "R:" && key != "T:") continue;
    line = table.lines[i];
    const auto v = row_numbers(file, table, i, 1);
    if (v.size() != (key == "R:" ? 9u : 3u))
      refuse(file, line, key, std::to_string(v.size()) + " numbers", key == "R:" ? "9" : "3");
    for (int k = 0; k < static_cast<int>(v.size()); ++k) {
      const double number = v[static_cast<std::size_t>(k)];
      if (key == "R:")
        m(k / 3, k % 3) = number;
      else
        m(k, 3) = number;
    }
  }
  return pose_of_rows(file, line, {m.data(), 12});
}

// left.yaml, right.yaml: OpenCV files as ROS writes them.
Camera read_camera(const fs::path& file, Eigen::Matrix<double, 3, 4>& projection) {
  YamlMap yaml = YamlMap::load(file);
  Camera camera;
  std::vector<double> K;
  std::vector<double> D;
  std::vector<double> P;
  yaml.require("image_width", camera.width, Range{1, 1e5});
  yaml.require("image_height", camera.height, Range{1, 1e5});
  const auto matrix = [&](const char* key, std::size_t count, std::vector<double>& values) {
    auto map = yaml.map(key);
    if (!map) return yaml.report(key, "nothing", "a matrix");
    map->ignore("rows");
    map->ignore("cols");
    map->ignore("dt");
    if (map->read_list("data", count, values)) return;
    values.assign(count, 0.0);
  };
  matrix("camera_matrix", 9, K);
  matrix("distortion_coefficients", 5, D);
  matrix("projection_matrix", 12, P);
  for (const auto& key : yaml.keys()) yaml.ignore(key);
  yaml.finish();
  if (D[4] != 0.0)
    refuse(file, yaml.line("distortion_coefficients"), "k3", std::to_string(D[4]), "0");
  camera.model = CameraModel::kPinholeRadtan;
  camera.parameters = {K[0], K[4], K[2], K[5], D[0], D[1], D[2], D[3]};
  projection = Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(P.data());
  return camera;
}

struct Stereo {
  Rig rig;
  std::vector<fs::path> folders;
};

Stereo read_stereo(const fs::path& source, const fs::path& calibration, double axle_height_m) {
  Stereo stereo;
  const Eigen::Isometry3d T_axle_left = read_stereo_mount(calibration / "Vehicle2Stereo.txt");
  int index = 0;
  for (const char* const side : {"left", "right"}) {
    const fs::path folder = source / "image" / (std::string("stereo_") + side);
    if (!fs::is_directory(folder)) continue;
    Eigen::Matrix<double, 3, 4> P;
    MountedCamera camera;
    camera.name = "cam" + std::to_string(index++);
    camera.camera = read_camera(calibration / (std::string(side) + ".yaml"), P);
    camera.T_vehicle_camera = Eigen::Translation3d(0, 0, axle_height_m) * T_axle_left *
                              Eigen::Translation3d(-P(0, 3) / P(0, 0), 0, 0);
    stereo.rig.cameras.push_back(camera);
    stereo.folders.push_back(folder);
  }
  return stereo;
}

void import_images(const ImportJob& job,
                   const Stereo& stereo,
                   DriveWriter& writer,
                   ImportResult& result) {
  for (std::size_t camera = 0; camera < stereo.folders.size(); ++camera) {
    const auto files = image_files(stereo.folders[camera]);
    for (std::size_t i = 0; i < files.size(); ++i, ++result.images) {
      report(job.progress, "import", i, files.size());
      const auto t = parse_int(files[i].stem().string());
      if (!t || *t < 0)
        refuse(files[i], 0, "name", printable(files[i].stem().string()), "nanoseconds");
      writer.copy_image(camera, *t, files[i]);
    }
  }
}

// Ticks of the rear wheels. A counter that begins again is continued as in wheels0.
void import_ticks(const ImportJob& job,
                  const fs::path& encoder,
                  const WheelModel& wheels,
                  DriveWriter& writer,
                  ImportResult& result) {
  const TextTable ticks = read_text_table(encoder, ',', 3);
  const double turn = 2.0 * std::numbers::pi / wheels.ticks_per_turn;
  const auto ranges = tick_ranges_rad(wheels.ticks_per_turn);
  std::array<WheelCounter, 2> counters{WheelCounter(wheels.radius_left_m, ranges),
                                       WheelCounter(wheels.radius_right_m, ranges)};
  std::array<CounterReport, 2> news;
  Ascending ascending(encoder);
  std::optional<std::int64_t> before_ns;
  for (std::size_t i = 0; i < ticks.rows.size(); ++i) {
    const std::int64_t line = ticks.lines[i];
    const auto t = parse_int(ticks.rows[i][0]);
    if (!t || *t < 0)
      refuse(encoder, line, "timestamp", printable(ticks.rows[i][0]), "nanoseconds");
    const auto v = row_numbers(encoder, ticks, i, 1);
    if (!ascending.accept(*t, line)) continue;
    const double dt_s = before_ns ? static_cast<double>(*t - *before_ns) * 1e-9 : 0.0;
    before_ns = t;
    std::array<double, 2> angle{};
    for (std::size_t side = 0; side < 2; ++side) {
      angle[side] = counters[side].add(v[side] * turn, dt_s);
      news[side].add(counters[side].event(), line);
    }
    writer.write_wheels({*t, angle[0], angle[1], std::nullopt});
    ++result.wheel_rows;
  }
  ascending.report(job.options, result);
  for (std::size_t side = 0; side < 2; ++side)
    if (auto problem = news[side].problem(encoder.string(), side == 0 ? "left" : "right"))
      result.warnings.push_back(*std::move(problem));
}

void import_kaist_poses(const ImportJob& job,
                        const fs::path& file,
                        double axle_height_m,
                        DriveWriter& writer,
                        ImportResult& result) {
  const TextTable table = read_text_table(file, ',', 13);
  std::vector<TimedPose> poses;
  Ascending order(file);
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const auto t = parse_int(table.rows[i][0]);
    if (!t || *t < 0)
      refuse(file, table.lines[i], "timestamp", printable(table.rows[i][0]), "nanoseconds");
    const auto T_world_axle = pose_of_rows(file, table.lines[i], row_numbers(file, table, i, 1));
    if (order.accept(*t, table.lines[i]))
      poses.push_back({*t, T_world_axle * Eigen::Translation3d(0, 0, -axle_height_m)});
  }
  order.report(job.options, result);
  writer.write_truth(poses);
  result.poses = poses.size();
}

}  // namespace

ImportResult import_kaist(const ImportJob& job) {
  const fs::path calibration = job.source / "calibration";
  const WheelModel wheels = read_encoder_parameters(calibration / "EncoderParameter.txt");
  // KAIST's vehicle frame lies in the rear axle, ours on the ground below it.
  const double axle_height_m = 0.5 * (wheels.radius_left_m + wheels.radius_right_m);
  Stereo stereo;
  if (fs::exists(calibration / "Vehicle2Stereo.txt"))
    stereo = read_stereo(job.source, calibration, axle_height_m);
  ImportResult result;
  DriveWriterOptions writing;
  writing.overwrite = job.options.overwrite;
  writing.comment = "KAIST Complex Urban; the axle taken one wheel radius over the ground";
  DriveWriter writer(job.out, stereo.rig, wheels, writing);
  import_images(job, stereo, writer, result);

  const auto encoder =
      first_existing({job.source / "sensor_data" / "encoder.csv", job.source / "encoder.csv"});
  if (!encoder)
    refuse(job.source / "sensor_data" / "encoder.csv", 0, "", "no readable file", "wheel ticks");
  import_ticks(job, *encoder, wheels, writer, result);
  if (const auto file = first_existing(
          {job.source / "global_pose.csv", job.source / "sensor_data" / "global_pose.csv"}))
    import_kaist_poses(job, *file, axle_height_m, writer, result);
  writer.finish();
  return result;
}

}  // namespace roadbook
