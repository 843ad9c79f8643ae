#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "drive/import.hpp"
#include "drive/writer.hpp"

namespace roadbook {

// What the importers share.

struct ImportJob {
  std::filesystem::path source;
  std::filesystem::path out;
  ImportOptions options;
  const Progress& progress;
};

ImportResult import_kitti(const ImportJob& job);
ImportResult import_kitti360(const ImportJob& job);
ImportResult import_euroc(const ImportJob& job);
ImportResult import_kaist(const ImportJob& job);
ImportResult import_comma2k19(const ImportJob& job);
ImportResult import_video(const ImportJob& job);

/// "12.345", "1.036e-01" seconds as nanoseconds, digit by digit: a double would lose the last ones.
/// Digits beyond the ninth decimal are rounded half up. Empty for anything else or negative.
[[nodiscard]] std::optional<std::int64_t> seconds_to_ns(std::string_view text);
/// "2013-05-28 08:46:02.904939008" (UTC) as nanoseconds since 1970.
[[nodiscard]] std::optional<std::int64_t> date_to_ns(std::string_view text);

/// One line of a source file that failed to make sense.
[[noreturn]] void refuse(const std::filesystem::path& file,
                         std::int64_t line,
                         const std::string& field,
                         const std::string& got,
                         const std::string& want);

/// A table of numbers without header rules: fields separated by `separator` (runs of blanks where
/// it is ' '); lines that begin with '#' are skipped, and the first line if it begins with a
/// letter.
struct TextTable {
  std::vector<std::vector<std::string>> rows;
  std::vector<std::int64_t> lines;
  std::vector<std::string> header;
};
/// Throws BadInput where the file is missing or a row has not `columns` fields (0: any number).
[[nodiscard]] TextTable read_text_table(const std::filesystem::path& file,
                                        char separator,
                                        std::size_t columns);
/// The row's fields from `first` on as finite numbers; throws BadInput with the line.
[[nodiscard]] std::vector<double> row_numbers(const std::filesystem::path& file,
                                              const TextTable& table,
                                              std::size_t row,
                                              std::size_t first = 0);

/// Twelve numbers, rows of a 3x4 matrix; throws BadInput where the rotation is none.
[[nodiscard]] Eigen::Isometry3d pose_of_rows(const std::filesystem::path& file,
                                             std::int64_t line,
                                             std::span<const double> numbers);

/// The first of the paths that exists; empty where none does.
[[nodiscard]] std::optional<std::filesystem::path> first_existing(
    std::initializer_list<std::filesystem::path> paths);

/// Files with one of the extensions (".png"), sorted by name.
[[nodiscard]] std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder,
                                                          std::span<const std::string> extensions);

/// Axes of a camera that looks ahead, in the vehicle frame.
[[nodiscard]] Eigen::Matrix3d forward_camera_axes();

/// Keeps stamps strictly ascending: says whether the row may be written, counts those that not.
class Ascending {
 public:
  bool accept(std::int64_t t_ns);
  /// Adds a warning where rows were left out.
  void report(const std::filesystem::path& file, ImportResult& result) const;

 private:
  std::int64_t last_ = -1;
  std::size_t dropped_ = 0;
};

}  // namespace roadbook
