// Measures time, memory and accuracy of the overhead image:
// build/.../bench/overhead_study DRIVE OUT [MAP]
//
// Without MAP, the study takes truth poses every 20 cm as keyframes and thus measures the overhead
// image alone. With MAP, it aligns the map's poses with the truth. For a simulated drive
// (truth/world.json), it measures the edges of the parking lines in the image.

#include <gdal_priv.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <optional>

#include "drive/drive.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/overhead/overhead.hpp"

namespace {

namespace fs = std::filesystem;
using namespace roadbook;

using PosesByStamp = std::map<std::int64_t, Eigen::Isometry3d>;

PosesByStamp truth_poses(const Drive& drive) {
  PosesByStamp poses;
  for (const TimedPose& pose : drive.truth()) poses[pose.t_ns] = pose.T_world_vehicle;
  return poses;
}

Map map_on_truth(const Drive& drive, const PosesByStamp& truth) {
  Map map;
  Session session;
  session.name = drive.name();
  session.rig = drive.rig();
  session.wheels = drive.wheel_model();
  map.sessions.push_back(session);
  map.map_frames.emplace_back();
  std::optional<Eigen::Vector3d> last;
  for (std::size_t frame = 0; frame < drive.frame_count(); ++frame) {
    const auto pose = truth.find(drive.frame_stamp_ns(frame));
    if (pose == truth.end()) continue;
    const Eigen::Vector3d place = pose->second.translation();
    if (last && (place - *last).norm() < 0.2) continue;
    last = place;
    Keyframe keyframe;
    keyframe.t_ns = pose->first;
    keyframe.drive_frame = static_cast<int>(frame);
    keyframe.T_frame_vehicle = pose->second;
    map.keyframes.push_back(keyframe);
  }
  return map;
}

Eigen::Isometry3d align(const Map& map, const PosesByStamp& truth) {
  std::vector<Eigen::Vector3d> from;
  std::vector<Eigen::Vector3d> to;
  for (std::size_t k = 0; k < map.keyframes.size(); ++k) {
    const auto pose = truth.find(map.keyframes[k].t_ns);
    if (pose == truth.end()) continue;
    from.push_back(pose->second.translation());
    to.push_back(map.T_map_vehicle(static_cast<int>(k)).translation());
  }
  Eigen::Matrix3Xd a(3, from.size());
  Eigen::Matrix3Xd b(3, to.size());
  for (std::size_t i = 0; i < from.size(); ++i) {
    a.col(static_cast<Eigen::Index>(i)) = from[i];
    b.col(static_cast<Eigen::Index>(i)) = to[i];
  }
  return Eigen::Isometry3d(Eigen::umeyama(a, b, false));
}

// The image with its place; `at` gives the grey at map xy, NaN where nothing was seen.
struct Picture {
  cv::Mat_<double> grey;
  OverheadSummary place;

  [[nodiscard]] double at(const Eigen::Vector2d& p) const {
    const double c = (p.x() - place.west_m) / place.resolution_m - 0.5;
    const double r = (place.north_m - p.y()) / place.resolution_m - 0.5;
    const int ic = static_cast<int>(std::floor(c));
    const int ir = static_cast<int>(std::floor(r));
    if (ic < 0 || ir < 0 || ic + 1 >= grey.cols || ir + 1 >= grey.rows) return std::nan("");
    const double a = c - ic;
    const double b = r - ir;
    const double four[] = {grey(ir, ic), grey(ir, ic + 1), grey(ir + 1, ic), grey(ir + 1, ic + 1)};
    if (std::ranges::find(four, 0.0) != std::end(four)) return std::nan("");
    return (four[0] * (1 - a) + four[1] * a) * (1 - b) + (four[2] * (1 - a) + four[3] * a) * b;
  }
};

Picture read_picture(const OverheadSummary& made) {
  GDALAllRegister();
  auto* dataset = static_cast<GDALDataset*>(GDALOpen(made.image.c_str(), GA_ReadOnly));
  Picture picture{cv::Mat_<double>(made.rows, made.columns), made};
  if (dataset->GetRasterBand(1)->RasterIO(GF_Read, 0, 0, made.columns, made.rows, picture.grey.data,
                                          made.columns, made.rows, GDT_Float64, 0, 0) != CE_None)
    std::exit(EXIT_FAILURE);
  GDALClose(dataset);
  return picture;
}

constexpr double kProfile_m = 0.40;  // to both sides of a line
constexpr double kStep_m = 0.005;
constexpr double kStretch_m = 0.5;  // of a line that is averaged to one profile: paint is worn

// Returns the mean grey across a section of a line; empty if the section was not seen.
std::vector<double> profile(const Picture& picture,
                            const Eigen::Vector2d& from,
                            const Eigen::Vector2d& along) {
  const Eigen::Vector2d left(-along.y(), along.x());
  std::vector<double> values;
  for (double e = -kProfile_m; e <= kProfile_m; e += kStep_m) {
    double sum = 0.0;
    int count = 0;
    for (double s = 0.0; s < kStretch_m; s += 0.02, ++count)
      sum += picture.at(from + s * along + e * left);
    if (std::isnan(sum)) return {};
    values.push_back(sum / count);
  }
  return values;
}

// Distances of the two edges from where they should be [m]; empty without contrast.
std::vector<double> edge_errors(const std::vector<double>& values, double width_m) {
  const auto offset = [](std::size_t i) { return -kProfile_m + static_cast<double>(i) * kStep_m; };
  std::vector<double> ground;
  double paint = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (std::abs(offset(i)) < 0.5 * width_m) paint = std::max(paint, values[i]);
    if (std::abs(offset(i)) > width_m + 0.1) ground.push_back(values[i]);
  }
  std::ranges::sort(ground);
  const double middle = ground[ground.size() / 2];
  const double noise = ground[ground.size() * 9 / 10] - ground[ground.size() / 10];
  if (paint - middle < std::max(15.0, 2.0 * noise)) return {};  // no line to measure
  const double level = 0.5 * (paint + middle);
  std::vector<double> errors;
  for (const int side : {-1, 1}) {
    // Outwards from the brightest place to the first crossing.
    auto i = static_cast<std::ptrdiff_t>(std::ranges::max_element(values) - values.begin());
    const auto last = static_cast<std::ptrdiff_t>(values.size()) - 1;
    while (i > 0 && i < last && values[static_cast<std::size_t>(i)] > level) i += side;
    const double inner = values[static_cast<std::size_t>(i - side)];
    const double outer = values[static_cast<std::size_t>(i)];
    const double edge = offset(static_cast<std::size_t>(i)) -
                        side * kStep_m * (level - outer) / std::max(1e-9, inner - outer);
    errors.push_back(std::abs(edge - side * 0.5 * width_m));
  }
  return errors;
}

void print_edges(const fs::path& drive, const Picture& picture, const Eigen::Isometry3d& T) {
  std::ifstream file(drive / "truth" / "world.json");
  if (!file) return;
  const auto world = nlohmann::json::parse(file);
  std::vector<double> errors;
  int seen = 0;
  for (const auto& line : world["lines"]) {
    if (line["column"]) continue;
    const auto point = [&](const char* end) -> Eigen::Vector2d {
      return (T * Eigen::Vector3d(line[end][0], line[end][1], 0.0)).head<2>();
    };
    const Eigen::Vector2d front = point("front");
    const double length = (point("back") - front).norm();
    const Eigen::Vector2d along = (point("back") - front) / length;
    for (double s = 0.1; s + kStretch_m < length; s += kStretch_m) {
      const auto values = profile(picture, front + s * along, along);
      if (values.empty()) continue;
      ++seen;
      for (const double e : edge_errors(values, line["width"])) errors.push_back(e);
    }
  }
  if (errors.empty()) return;
  std::ranges::sort(errors);
  const auto quantile = [&](double q) {
    return 100.0 * errors[std::min(errors.size() - 1, static_cast<std::size_t>(
                                                          q * static_cast<double>(errors.size())))];
  };
  std::printf(
      "edges of parking lines: %zu on %d stretches seen; error [cm] median %.1f, 90 %% "
      "%.1f, 95 %% %.1f, largest %.1f\n",
      errors.size(), seen, quantile(0.5), quantile(0.9), quantile(0.95), quantile(1.0));
}

void study(const fs::path& folder, const fs::path& out, const std::optional<fs::path>& map_file) {
  const Drive drive = Drive::open(folder);
  const PosesByStamp truth = truth_poses(drive);
  const Map map = map_file ? load_map(*map_file) : map_on_truth(drive, truth);
  const OverheadSummary made = make_overhead(map, {&drive}, out);
  const double seconds = made.exposure_seconds + made.mosaic_seconds + made.write_seconds;
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  std::printf("%zu keyframes, %zu images, %d x %d px, %.0f m^2\n", made.views, made.images_used,
              made.columns, made.rows, made.covered_m2);
  std::printf("exposure %.2f s, mosaic %.2f s, writing %.2f s: %.1f ms a keyframe\n",
              made.exposure_seconds, made.mosaic_seconds, made.write_seconds,
              1e3 * seconds / static_cast<double>(made.views));
  const auto cpu_s = static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
                     1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
  std::printf("all of the program: %.1f s of CPU time, peak memory %ld MB\n", cpu_s,
              usage.ru_maxrss / 1024);
  if (!truth.empty())
    print_edges(folder, read_picture(made),
                map_file ? align(map, truth) : Eigen::Isometry3d::Identity());
}

}  // namespace

int main(int count, char** words) {
  if (count < 3 || count > 4) {
    std::fprintf(stderr, "usage: overhead_study DRIVE OUT [MAP]\n");
    return EXIT_FAILURE;
  }
  try {
    study(words[1], words[2], count > 3 ? std::optional<fs::path>(words[3]) : std::nullopt);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
  return EXIT_SUCCESS;
}
