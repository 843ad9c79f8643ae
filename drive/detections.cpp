#include "drive/detections.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "base/error.hpp"
#include "base/text_file.hpp"
#include "drive/csv.hpp"

namespace roadbook {
namespace {

// A value within its range, else a fault of the row.
bool in_range(CsvReader& csv,
              ProblemList& problems,
              const char* field,
              double value,
              double low,
              double high,
              const char* want) {
  if (value >= low && value <= high) return true;
  problems.error(csv.file(), csv.line(), field, std::to_string(value), want);
  return false;
}

// Columns of a detections table that may be absent.
struct OptionalColumns {
  explicit OptionalColumns(const CsvReader& csv)
      : sigma(csv.find("sigma")),
        probability(csv.find("probability")),
        eye_x(csv.find("eye_x")),
        eye_y(csv.find("eye_y")),
        xx(csv.find("xx")),
        xy(csv.find("xy")),
        yy(csv.find("yy")) {}
  std::optional<std::size_t> sigma, probability, eye_x, eye_y, xx, xy, yy;

  // False where a field is bad, which is reported.
  bool read(CsvReader& csv, Detection& row) const {
    bool good = true;
    const auto fill = [&](const std::optional<std::size_t>& column, double& value) {
      if (!column) return;
      const auto read = csv.number(*column);
      good = good && read.has_value();
      if (read) value = *read;
    };
    std::array<double, 2> eye{};
    fill(sigma, row.sigma_m);
    fill(probability, row.probability);
    fill(eye_x, eye[0]);
    fill(eye_y, eye[1]);
    if (eye_x && eye_y) row.eye_m = eye;
    if (xx && xy && yy) {
      fill(xx, row.covariance[0]);
      fill(xy, row.covariance[1]);
      fill(yy, row.covariance[2]);
    }
    return good;
  }
};

bool is_covariance(const std::array<double, 3>& c) {
  return c[0] >= 0.0 && c[2] >= 0.0 && c[0] * c[2] >= c[1] * c[1];
}

}  // namespace

Eigen::Matrix2d covariance_of(const Detection& detection) {
  const auto& [xx, xy, yy] = detection.covariance;
  Eigen::Matrix2d C;
  C << xx, xy, xy, yy;
  if (C.trace() > 0.0) return C;
  return detection.sigma_m * detection.sigma_m * Eigen::Matrix2d::Identity();
}

std::vector<Detection> read_detections(const std::filesystem::path& file) {
  ProblemList problems;
  std::vector<Detection> detections;
  CsvReader csv(file, CsvHeader::kRequired, problems);
  if (csv.good()) {
    const auto t_column = csv.require("timestamp", "ns|");
    const auto x_column = csv.require("x", "m|");
    const auto y_column = csv.require("y", "m|");
    const OptionalColumns further(csv);
    while (t_column && x_column && y_column && csv.next()) {
      const auto t = csv.stamp(*t_column);
      const auto x = csv.number(*x_column);
      const auto y = csv.number(*y_column);
      Detection row;
      if (!further.read(csv, row) || !t || !x || !y) continue;
      row.t_ns = *t;
      row.x_m = *x;
      row.y_m = *y;
      const bool good =
          in_range(csv, problems, "x", *x, -1000.0, 1000.0, "within 1000 m of the vehicle") &&
          in_range(csv, problems, "y", *y, -1000.0, 1000.0, "within 1000 m of the vehicle") &&
          in_range(csv, problems, "sigma", row.sigma_m, 0.0, 100.0, "0 to 100 m") &&
          in_range(csv, problems, "probability", row.probability, 0.0, 1.0, "0 to 1");
      if (good && !is_covariance(row.covariance))
        problems.error(csv.file(), csv.line(), "xx, xy, yy", "no covariance",
                       "a symmetric matrix that is not negative");
      else if (good)
        detections.push_back(row);
    }
  }
  if (problems.has_errors()) throw BadInput(problems.problems());
  return detections;
}

std::vector<Look> read_looks(const std::filesystem::path& file) {
  constexpr double kFarthest = 25.5;  // [m] that 0.1 m steps hold
  ProblemList problems;
  std::vector<Look> looks;
  CsvReader csv(file, CsvHeader::kRequired, problems);
  if (csv.good()) {
    const auto t_column = csv.require("timestamp", "ns|");
    std::vector<std::size_t> reach;
    for (std::size_t k = 0;; ++k) {
      const auto column = csv.find("reach_" + std::to_string(k));
      if (!column) break;
      reach.push_back(*column);
    }
    while (t_column && csv.next()) {
      const auto t = csv.stamp(*t_column);
      if (!t) continue;
      Look look{*t, {}};
      for (const std::size_t column : reach) {
        const auto value = csv.number(column);
        if (!value || !in_range(csv, problems, "reach", *value, 0.0, 1000.0, "0 to 1000 m")) break;
        look.reach_dm.push_back(
            static_cast<std::uint8_t>(std::lround(10.0 * std::min(*value, kFarthest))));
      }
      if (look.reach_dm.size() == reach.size()) looks.push_back(std::move(look));
    }
    // Cut within its head, or before the first row: not the same as a detector without the table.
    if (looks.empty() && !problems.has_errors())
      problems.error(csv.file(), csv.line(), "timestamp", "no rows", "a row for each look");
  }
  if (problems.has_errors()) throw BadInput(problems.problems());
  std::stable_sort(looks.begin(), looks.end(),
                   [](const Look& a, const Look& b) { return a.t_ns < b.t_ns; });
  return looks;
}

void write_detections(const std::filesystem::path& folder,
                      std::span<const Detection> detections,
                      std::span<const Look> looks) {
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed)
    throw StorageError("error: " + folder.string() + ": folder: got " + failed.message() +
                       ", want one to write to");
  const bool eyes = std::all_of(detections.begin(), detections.end(),
                                [](const Detection& d) { return d.eye_m.has_value(); });
  std::string text = "#timestamp [ns],x [m],y [m],sigma [m],probability [-]";
  text += eyes ? ",eye_x [m],eye_y [m]" : "";
  text += ",xx [m^2],xy [m^2],yy [m^2]\n";
  char line[200];
  for (const Detection& d : detections) {
    std::snprintf(line, sizeof line, "%lld,%.4f,%.4f,%.4f,%.4f", static_cast<long long>(d.t_ns),
                  d.x_m, d.y_m, d.sigma_m, d.probability);
    text += line;
    if (eyes) {
      std::snprintf(line, sizeof line, ",%.3f,%.3f", (*d.eye_m)[0], (*d.eye_m)[1]);
      text += line;
    }
    std::snprintf(line, sizeof line, ",%.6f,%.6f,%.6f\n", d.covariance[0], d.covariance[1],
                  d.covariance[2]);
    text += line;
  }
  write_text(folder / "data.csv", text);
  if (looks.empty()) return;
  const std::size_t sectors = looks.front().reach_dm.size();
  text = "#timestamp [ns]";
  for (std::size_t k = 0; k < sectors; ++k) text += ",reach_" + std::to_string(k) + " [m]";
  text += "\n";
  for (const Look& look : looks) {
    text += std::to_string(look.t_ns);
    for (const std::uint8_t reach : look.reach_dm) {
      std::snprintf(line, sizeof line, ",%d.%d", reach / 10, reach % 10);
      text += line;
    }
    text += "\n";
  }
  write_text(folder / "looks.csv", text);
}

std::filesystem::path detector_folder(const std::filesystem::path& drive) {
  const auto deeper = drive / "mav0";
  std::error_code ignored;
  return (std::filesystem::is_directory(deeper, ignored) ? deeper : drive) / "detector0";
}

}  // namespace roadbook
