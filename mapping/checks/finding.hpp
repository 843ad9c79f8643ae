#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace roadbook {

/// Indices as text, the first five of them: "3, 7, 8, 9, 12 and 4 more".
[[nodiscard]] inline std::string first_of(const std::vector<int>& indices) {
  constexpr std::size_t kNamed = 5;
  std::string text;
  for (std::size_t i = 0; i < indices.size() && i < kNamed; ++i)
    text += (text.empty() ? "" : ", ") + std::to_string(indices[i]);
  if (indices.size() > kNamed) text += " and " + std::to_string(indices.size() - kNamed) + " more";
  return text;
}

/// A contradiction in a map.
[[nodiscard]] inline Problem finding(const std::string& where,
                                     const std::string& got,
                                     const std::string& want) {
  return {Severity::kError, "", 0, where, got, want};
}

}  // namespace roadbook
