#include "diagnosis/streams/stated_wheelbase.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "drive/writer.hpp"
#include "tests/support/expect_words.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

fs::path drive_with_wheels(bool steered) {
  const fs::path folder = fs::path(::testing::TempDir()) / "roadbook_stated_wheelbase";
  DriveWriterOptions options;
  options.overwrite = true;
  DriveWriter writer(folder, Rig{}, WheelModel{}, options);
  for (int k = 0; k < 10; ++k) {
    WheelReading reading;
    reading.t_ns = 1'600'000'000'000'000'000 + k * 20'000'000;
    reading.left_angle_rad = reading.right_angle_rad = 0.1 * k;
    if (steered) reading.steering_rad = 0.01;
    writer.write_wheels(reading);
  }
  writer.finish();
  return folder;
}

void leave_out_wheelbase(const fs::path& folder) {
  const fs::path file = folder / "wheels0" / "sensor.yaml";
  std::ifstream in(file);
  std::ostringstream kept;
  for (std::string line; std::getline(in, line);)
    if (!line.starts_with("wheelbase")) kept << line << "\n";
  in.close();
  std::ofstream(file) << kept.str();
}

TEST(StatedWheelbase, WhatDependsOnOneThatNobodyStatedIsSaid) {
  const fs::path folder = drive_with_wheels(true);
  EXPECT_FALSE(unstated_wheelbase(Drive::open(folder)));
  leave_out_wheelbase(folder);
  const auto said = unstated_wheelbase(Drive::open(folder));
  ASSERT_TRUE(said);
  test::expect_words(*said, "no wheelbase is stated: 2.6 m");
  test::expect_words(*said, "steering0.ratio");
}

TEST(StatedWheelbase, WithoutSteeringNothingDependsOnIt) {
  const fs::path folder = drive_with_wheels(false);
  leave_out_wheelbase(folder);
  EXPECT_FALSE(unstated_wheelbase(Drive::open(folder)));
}

}  // namespace
}  // namespace roadbook
