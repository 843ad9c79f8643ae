#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tests/support/source_tree.hpp"

namespace roadbook::test {

/// A file of golden values (computed with 40 digits by another program;
/// tests/golden/spm/README.md); empty where it is not there.
inline std::optional<nlohmann::json> golden(const std::string& name) {
  std::ifstream in(source_tree() / "tests" / "golden" / "spm" / (name + ".json"));
  if (!in) return std::nullopt;
  return nlohmann::json::parse(in);
}

/// Checks |got - want| <= rel |want| + abs, the tolerance that the README of the golden values
/// gives.
inline void expect_close(double got, double want, double rel, double abs = 1e-13) {
  EXPECT_NEAR(got, want, rel * std::abs(want) + abs);
}

}  // namespace roadbook::test

/// Declares `variable` as the parsed golden file; without it the test fails.
#define ROADBOOK_REQUIRE_GOLDEN(variable, name)                         \
  const auto variable##_found = ::roadbook::test::golden(name);         \
  ASSERT_TRUE(variable##_found) << "golden values not found: " << name; \
  const nlohmann::json& variable = *variable##_found
