#pragma once

#include <Eigen/Core>
#include <cstddef>

namespace roadbook {

/// Conversions between the index types of containers and of Eigen; `i` is not negative.
inline std::size_t at(int i) { return static_cast<std::size_t>(i); }
inline Eigen::Index index(std::size_t i) { return static_cast<Eigen::Index>(i); }

}  // namespace roadbook
