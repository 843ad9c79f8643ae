#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

namespace roadbook {

/// A NumPy array of numbers, flattened row by row.
struct NpyArray {
  std::vector<std::size_t> shape;
  std::vector<double> values;
  [[nodiscard]] std::size_t rows() const { return shape.empty() ? 0 : shape.front(); }
  /// Numbers a row.
  [[nodiscard]] std::size_t columns() const { return rows() == 0 ? 0 : values.size() / rows(); }
};

/// Reads a .npy file (format 1 to 3, little-endian float32/float64/int32/int64, C order, at most
/// 1 GiB). Throws BadInput.
[[nodiscard]] NpyArray read_npy(const std::filesystem::path& file);

}  // namespace roadbook
