#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <bit>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace roadbook {

// Numbers as bytes in a fixed little-endian layout (docs/reference/map_file.md). Matrices go row by
// row; a pose is its upper 3x4 block [R t], so that it is read back bit for bit.

static_assert(std::endian::native == std::endian::little, "map files are little-endian");

template <typename T>
void pack(std::string& bytes, T value) {
  static_assert(std::is_arithmetic_v<T>);
  char raw[sizeof(T)];
  std::memcpy(raw, &value, sizeof(T));
  bytes.append(raw, sizeof(T));
}

template <typename Derived>
[[nodiscard]] std::string pack_matrix(const Eigen::MatrixBase<Derived>& m) {
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(m.size()) * sizeof(typename Derived::Scalar));
  for (Eigen::Index r = 0; r < m.rows(); ++r)
    for (Eigen::Index c = 0; c < m.cols(); ++c) pack(bytes, m(r, c));
  return bytes;
}

[[nodiscard]] inline std::string pack_pose(const Eigen::Isometry3d& T) {
  return pack_matrix(T.matrix().topRows<3>());
}

/// Value at byte `offset`; the caller has checked the length.
template <typename T>
[[nodiscard]] T unpack(std::string_view bytes, std::size_t offset) {
  static_assert(std::is_arithmetic_v<T>);
  T value;
  std::memcpy(&value, bytes.data() + offset, sizeof(T));
  return value;
}

/// Fills `m` from `bytes`; false where the length is not that of the matrix.
template <typename Derived>
[[nodiscard]] bool unpack_matrix(std::string_view bytes, Eigen::MatrixBase<Derived>& m) {
  using Scalar = typename Derived::Scalar;
  if (bytes.size() != static_cast<std::size_t>(m.size()) * sizeof(Scalar)) return false;
  std::size_t offset = 0;
  for (Eigen::Index r = 0; r < m.rows(); ++r)
    for (Eigen::Index c = 0; c < m.cols(); ++c, offset += sizeof(Scalar))
      m(r, c) = unpack<Scalar>(bytes, offset);
  return true;
}

}  // namespace roadbook
