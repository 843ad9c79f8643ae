#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include "tests/apps/shared_drives.hpp"

namespace roadbook::test {

/// Gives the beginning of a drive of 20 s in the small car park, in images at half scale. It is the
/// first drive of the manual, which is rendered once for all tests of a build.
inline void give_beginning_of_round(double seconds, const std::filesystem::path& drive) {
  const auto made =
      simulate_drive("zurich --size small --image-scale 0.5 --max-duration-s 20", drive);
  ASSERT_EQ(made.status, 0) << made.err;
  std::int64_t end_ns = 0;
  for (const std::string sensor :
       {"cam0", "cam1", "cam2", "cam3", "wheels0", "imu0", "state_groundtruth_estimate0"}) {
    const auto table = drive / sensor / "data.csv";
    std::string kept;
    {
      std::ifstream in(table);
      for (std::string row; std::getline(in, row);) {
        if (row.front() != '#') {
          const std::int64_t t_ns = std::stoll(row);
          if (end_ns == 0) end_ns = t_ns + static_cast<std::int64_t>(1e9 * seconds);
          if (t_ns > end_ns) break;
        }
        kept += row + '\n';
      }
    }
    ASSERT_FALSE(kept.empty()) << table;
    std::ofstream(table) << kept;
  }
}

}  // namespace roadbook::test
