#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "diagnosis/logs/plain_log.hpp"
#include "tests/support/source_tree.hpp"

namespace roadbook::test {

/// Reads a log description of the documentation with the local path of the recordings. `more` holds
/// further lines of the description, such as a window. They replace lines with the same key.
inline PlainLog example_log(const std::string& name,
                            const std::filesystem::path& data,
                            const std::string& more = {}) {
  std::ifstream file(source_tree() / "docs" / "examples" / "logs" / name);
  const std::string key = more.substr(0, more.find(':') + 1);
  const auto copy = std::filesystem::path(::testing::TempDir()) / name;
  std::ofstream out(copy);
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("folder:")) line = "folder: " + std::filesystem::absolute(data).string();
    if (key.empty() || !line.starts_with(key)) out << line << '\n';
  }
  out << more << '\n';
  out.close();
  return read_plain_log(copy);
}

}  // namespace roadbook::test
