#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "base/error.hpp"
#include "diagnosis/logs/plain_log.hpp"

namespace roadbook::test {

/// Fixture: a folder with the files of a plain log, described in "log.yaml".
class PlainLogFolder : public ::testing::Test {
 protected:
  PlainLogFolder()
      : folder_(std::filesystem::path(::testing::TempDir()) /
                ::testing::UnitTest::GetInstance()->current_test_info()->name()) {
    std::filesystem::create_directories(folder_);
  }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
  }
  [[nodiscard]] PlainLog read(const std::string& yaml) const {
    write("log.yaml", yaml);
    return read_plain_log(folder_ / "log.yaml");
  }
  /// All faults, one line each, paths without the folder; "accepted" if there are no faults.
  [[nodiscard]] std::string refusal(const std::string& yaml) const {
    std::string all;
    try {
      static_cast<void>(read(yaml));
      return "accepted";
    } catch (const BadInput& error) {
      for (Problem p : error.problems()) {
        p.file = std::filesystem::path(p.file).filename().string();
        all += to_line(p) + "\n";
      }
    }
    return all;
  }
  std::filesystem::path folder_;
};

}  // namespace roadbook::test
