#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include "tests/support/source_tree.hpp"

namespace roadbook::test {

/// Returns a recording of the real data: $ROADBOOK_DATA/NAME, or NAME in `shared/data` next to the
/// source tree; empty if it does not exist.
inline std::optional<std::filesystem::path> real_data(const std::string& name) {
  namespace fs = std::filesystem;
  const char* const given = std::getenv("ROADBOOK_DATA");
  const fs::path root =
      given != nullptr ? fs::path(given) : source_tree().parent_path() / "shared" / "data";
  std::error_code error;
  if (!fs::exists(root / name, error)) return std::nullopt;
  return root / name;
}

}  // namespace roadbook::test

/// Declares `path_variable` as the path of a real recording, or reports the test as skipped.
#define ROADBOOK_REQUIRE_DATA(path_variable, name)                               \
  const auto path_variable##_found = ::roadbook::test::real_data(name);          \
  if (!path_variable##_found) GTEST_SKIP() << "real data not found: " << (name); \
  const std::filesystem::path path_variable = *path_variable##_found
