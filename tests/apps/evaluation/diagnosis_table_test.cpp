#include "apps/evaluation/diagnosis_table.hpp"

#include <gtest/gtest.h>

#include "apps/evaluation/hidden_readings.hpp"
#include "diagnosis/streams/drive_streams.hpp"
#include "tests/apps/run_command.hpp"

namespace roadbook {
namespace {

StudiedDrive pair_of(const std::string& one, const std::string& other) {
  StudiedDrive drive;
  drive.effect = one;
  drive.beside[other] = 0.1;
  return drive;
}

TEST(DiagnosisTable, APairIsStrongByItsWeakerOneAndNoiseAlwaysButNotWhatIsNotKnown) {
  StudiedDrive drive = pair_of("friction0.slip_bias", "friction0.speed_bias");
  EXPECT_FALSE(is_strong_pair(drive));
  drive.oracle.weakest = 0.0;
  EXPECT_FALSE(is_strong_pair(drive));
  drive.oracle.weakest = 7.9;
  EXPECT_FALSE(is_strong_pair(drive));
  drive.oracle.weakest = 8.0;
  EXPECT_TRUE(is_strong_pair(drive));
  EXPECT_TRUE(is_strong_pair(pair_of("imu0.outliers", "friction0.spatial_bias")));
  EXPECT_FALSE(is_strong_pair(pair_of("imu0.outliers", "detector.range")));
}

TEST(DiagnosisTable, WhatNoOracleKnowsStaysEmpty) {
  StudiedDrive drive = pair_of("detector.range", "detector.foot_point");
  EXPECT_NE(drives_csv({drive}).find(",0,0,,0,nothing,"), std::string::npos) << drives_csv({drive});
  drive.oracle.weakest = 2.5;
  EXPECT_NE(drives_csv({drive}).find(",0,0,2.5,0,nothing,"), std::string::npos);
}

// Two biases are hidden at once. The oracle of readings computes how observable the weaker bias is
// in the presence of the stronger bias.
TEST(DiagnosisTable, TheOracleOfReadingsKnowsTheWeakerOfTwo) {
  const test::ScratchFolder folder;
  const EffectSizes small{{"friction0.slip_bias", 0.2}, {"friction0.speed_bias", 0.0005}};
  write_hidden_readings(folder.path() / "drive", 7, HiddenKind::kFriction, small);
  const Drive drive = Drive::open(folder.path() / "drive");
  const OracleAnswer answer = ask_oracle(drive_readings(drive, motion_streams(drive).poses), small);
  ASSERT_TRUE(answer.weakest);
  EXPECT_GT(*answer.weakest, 0.0);
  EXPECT_LT(*answer.weakest, 0.5 * answer.strength);
}

}  // namespace
}  // namespace roadbook
