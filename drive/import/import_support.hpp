#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/progress.hpp"
#include "drive/images/image_files.hpp"
#include "drive/import/import_options.hpp"
#include "drive/writer.hpp"

namespace roadbook {

// Types and functions that all importers share.

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

/// The numbers of one line, blanks between them; throws BadInput with the line.
[[nodiscard]] std::vector<double> line_numbers(const std::filesystem::path& file,
                                               std::int64_t line,
                                               std::string_view text);

/// Twelve numbers, rows of a 3x4 matrix; throws BadInput where the left 3x3 part is not a rotation.
[[nodiscard]] Eigen::Isometry3d pose_of_rows(const std::filesystem::path& file,
                                             std::int64_t line,
                                             std::span<const double> numbers);

/// The first of the paths that exists; empty where none does.
[[nodiscard]] std::optional<std::filesystem::path> first_existing(
    std::initializer_list<std::filesystem::path> paths);

/// Axes of a camera that looks ahead, in the vehicle frame.
[[nodiscard]] Eigen::Matrix3d forward_camera_axes();

/// Rows (images, poses) of one source file: how many were taken over, how many had to be left out.
class LeftOut {
 public:
  /// For messages: `what` ("rows", "images"), `why` ("repeat or go back in time") and `want`.
  LeftOut(std::filesystem::path file, std::string what, std::string why, std::string want)
      : file_(std::move(file)),
        what_(std::move(what)),
        why_(std::move(why)),
        want_(std::move(want)) {}
  void take() { ++taken_; }
  void take(std::size_t count) { taken_ += count; }
  /// `line`: of the source file; 0 where it has no lines.
  void leave(std::int64_t line);
  /// Adds a warning with the share that was left out. Throws BadInput instead where it is more
  /// than one row and more than `options.max_left_out` of all.
  void report(const ImportOptions& options, ImportResult& result) const;

 private:
  std::filesystem::path file_;
  std::string what_, why_, want_;
  std::size_t taken_ = 0;
  std::size_t left_ = 0;
  std::int64_t first_line_ = 0;
  std::size_t first_row_ = 0;
};

/// Keeps stamps strictly ascending: says whether the row may be written, counts those that not.
class Ascending {
 public:
  explicit Ascending(const std::filesystem::path& file);
  bool accept(std::int64_t t_ns, std::int64_t line);
  /// As LeftOut::report.
  void report(const ImportOptions& options, ImportResult& result) const {
    rows_.report(options, result);
  }

 private:
  LeftOut rows_;
  std::int64_t last_ = -1;
};

/// One line a frame: line number = frame number, so that a blank line is a frame without a value.
struct FrameLines {
  std::vector<std::string> text;    ///< by frame; empty: a blank line
  std::vector<std::int64_t> lines;  ///< of the file
  /// How many frames have a value.
  [[nodiscard]] std::size_t filled() const;
};
/// Reads such a file; `#` lines do not count, nor do blank lines at its end. Throws BadInput where
/// it cannot be read or no line has a value.
[[nodiscard]] FrameLines read_frame_lines(const std::filesystem::path& file);

/// Stamps by frame, each later than those before; empty where the line is blank. `parse` reads one
/// line's text. Throws BadInput with the line; `want` names the expected text.
[[nodiscard]] std::vector<std::optional<std::int64_t>> frame_stamps(
    const std::filesystem::path& file,
    const FrameLines& frames,
    std::optional<std::int64_t> (*parse)(std::string_view),
    const std::string& want);

}  // namespace roadbook
