#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace roadbook {

// The text files of a recorded drive, changed as text. A study that damages drives must not use the
// drive reader and the drive writer, because it judges them.

/// The cells of a `data.csv`, as text.
class RecordedTable {
 public:
  /// Throws BadInput if the file cannot be read or has no header.
  explicit RecordedTable(std::filesystem::path file);

  [[nodiscard]] std::size_t rows() const { return cells_.size(); }
  /// Index of the first column whose name begins with `name`. Throws BadInput without one.
  [[nodiscard]] std::size_t column(std::string_view name) const;
  [[nodiscard]] std::string& cell(std::size_t row, std::size_t column);
  [[nodiscard]] const std::string& cell(std::size_t row, std::size_t column) const;
  /// A cell as a number. Throws BadInput if it is not one.
  [[nodiscard]] double number(std::size_t row, std::size_t column) const;
  void set(std::size_t row, std::size_t column, double value);
  /// The stamp of a row: nanoseconds.
  [[nodiscard]] std::int64_t stamp_ns(std::size_t row) const;
  /// Adds a number of nanoseconds to the stamps of all rows.
  void shift_stamps(std::int64_t ns);
  /// Replaces the file. Other names of the same file (hard links) keep the old content.
  void write() const;

 private:
  std::filesystem::path file_;
  std::string header_;
  std::vector<std::string> names_;
  std::vector<std::vector<std::string>> cells_;
};

/// Replaces the value of `key` in a `sensor.yaml`, which has one key a line. Throws BadInput if the
/// file has no such key.
void set_value(const std::filesystem::path& sensor_yaml,
               const std::string& key,
               const std::string& value);
/// The value of `key` in a `sensor.yaml`, as text. For a matrix, `key` is "data". Throws BadInput.
[[nodiscard]] std::string value_of(const std::filesystem::path& sensor_yaml,
                                   const std::string& key);

/// The numbers of a list "[1, 2, 3]", and the list of numbers. Throws BadInput.
[[nodiscard]] std::vector<double> numbers_of(const std::string& list);
[[nodiscard]] std::string list_of(const std::vector<double>& numbers);

}  // namespace roadbook
