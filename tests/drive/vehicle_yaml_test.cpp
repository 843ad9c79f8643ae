#include "drive/vehicle_yaml.hpp"

#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

VehicleMeasures small_car() {
  VehicleMeasures v;
  v.length_m = 4.2;
  v.width_m = 1.76;
  v.height_m = 1.46;
  v.rear_overhang_m = 0.75;
  v.wheelbase_m = 2.58;
  v.track_width_m = 1.52;
  return v;
}

TEST(VehicleYaml, ReadsBackWhatWasWritten) {
  const TemporaryFolder folder;
  ProblemList problems;
  for (VehicleMeasures v : {small_car(), VehicleMeasures{}}) {
    v.height_m = 1.0 / 3.0;
    write_text(folder.path() / "vehicle.yaml", vehicle_yaml_text(v));
    EXPECT_EQ(read_vehicle_yaml(folder.path() / "vehicle.yaml", problems), v);
  }
  EXPECT_TRUE(problems.problems().empty());
}

TEST(VehicleYaml, AKeyWithoutValueIsNotKnown) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "vehicle.yaml";
  ProblemList problems;
  for (const char* const nothing : {"height: null", "height: ~", "height:", ""}) {
    write_text(file, std::string("length: 4\nwidth: 2\n") + nothing + "\n");
    const auto vehicle = read_vehicle_yaml(file, problems);
    ASSERT_TRUE(vehicle) << nothing;
    EXPECT_FALSE(vehicle->height_m) << nothing;
    EXPECT_DOUBLE_EQ(*vehicle->length_m, 4.0);
  }
  EXPECT_TRUE(problems.problems().empty());
}

struct WrongVehicle {
  const char* text;
  const char* line;  ///< with D for the drive's folder
};

class WrongVehicleTest : public ::testing::TestWithParam<WrongVehicle> {};

TEST_P(WrongVehicleTest, GivesOneLineThatSaysWhereAndWhat) {
  const TemporaryFolder folder;
  const auto drive = write_small_drive(folder.path() / "d");
  write_text(drive / "vehicle.yaml", GetParam().text);
  const DriveReport report = check_drive(drive);
  std::string lines = all_lines(report);
  for (auto at = lines.find(drive.string()); at != std::string::npos;
       at = lines.find(drive.string()))
    lines.replace(at, drive.string().size(), "D");
  EXPECT_NE(lines.find(GetParam().line), std::string::npos) << lines;
  EXPECT_FALSE(report.usable);
  EXPECT_THROW((void)Drive::open(drive), BadInput);
  EXPECT_THROW((void)load_vehicle(drive / "vehicle.yaml"), BadInput);
}

INSTANTIATE_TEST_SUITE_P(
    All,
    WrongVehicleTest,
    ::testing::Values(
        WrongVehicle{"length: 4.2\nwidht: 1.8\n",
                     "error: D/vehicle.yaml:2: widht: got an unknown key, want a known one (did "
                     "you mean width?)"},
        WrongVehicle{"length: 4.2\nwidth: 1.8\nlength: 4.3\n",
                     "error: D/vehicle.yaml:3: length: got the key a second time, want each key "
                     "once"},
        WrongVehicle{"width: 1.8\nlength: 4200\n",
                     "error: D/vehicle.yaml:2: length: got 4200, want a finite number in [0.1, 30"},
        WrongVehicle{"length: 4.2\nwidth: -1.8\n", "error: D/vehicle.yaml:2: width: got -1.8"},
        WrongVehicle{"length: .nan\nwidth: 1.8\n", "error: D/vehicle.yaml:1: length: got .nan"},
        WrongVehicle{"length: 4.2\nwidth: wide\n", "error: D/vehicle.yaml:2: width: got wide"},
        WrongVehicle{"length: 3.0\nwidth: 1.8\nrear_overhang: 0.8\nwheelbase: 2.6\n",
                     "error: D/vehicle.yaml:1: length: got 3.0, want at least rear_overhang + "
                     "wheelbase = 3.4"},
        WrongVehicle{"length: 4.2\nwidth: 1.5\ntrack_width: 1.6\n",
                     "error: D/vehicle.yaml:2: width: got 1.5, want at least track_width = 1.6"},
        WrongVehicle{"- 4.2\n- 1.8\n", "error: D/vehicle.yaml:1: got a list, want a mapping"},
        WrongVehicle{"length: [4.2\n", "error: D/vehicle.yaml:2: got invalid YAML"}));

TEST(VehicleYaml, IsPartOfADriveAndOfItsDigest) {
  const TemporaryFolder folder;
  const auto drive = write_small_drive(folder.path() / "d");
  EXPECT_FALSE(Drive::open(drive).vehicle());
  const std::string before = Drive::open(drive).digest();
  write_text(drive / "vehicle.yaml", vehicle_yaml_text(small_car()));
  const Drive with = Drive::open(drive);
  EXPECT_EQ(with.vehicle(), small_car());
  EXPECT_NE(with.digest(), before);
}

std::string warnings_of(const fs::path& drive) {
  const DriveReport report = check_drive(drive);
  EXPECT_TRUE(report.usable);
  return all_lines(report);
}

TEST(VehicleYaml, WarnsOfWhatIsHardlyRight) {
  const TemporaryFolder folder;
  const auto drive = write_small_drive(folder.path() / "d");
  write_text(drive / "vehicle.yaml", "height: 1.5\n");
  EXPECT_NE(warnings_of(drive).find("length, width: got measures that give no body"),
            std::string::npos);
  EXPECT_THROW((void)load_vehicle(drive / "vehicle.yaml"), BadInput);
  // The wheels of the small drive stand 1.5 m apart.
  write_text(drive / "vehicle.yaml", "length: 4.2\nwidth: 2.5\ntrack_width: 2.2\n");
  EXPECT_NE(warnings_of(drive).find("track_width: got 2.2, want"), std::string::npos)
      << warnings_of(drive);
  // The measures place the front of the car at the rear axle, so the cameras lie outside the car.
  write_text(drive / "vehicle.yaml", "length: 0.2\nwidth: 0.2\nrear_overhang: 0.2\n");
  EXPECT_NE(warnings_of(drive).find("T_BS: got cam0 at x "), std::string::npos)
      << warnings_of(drive);
}

TEST(VehicleYaml, MeasuresGivenForADriveAreComparedWithItsCamerasAndWheels) {
  const TemporaryFolder f;
  const fs::path drive = write_small_drive(f.path() / "d");
  VehicleMeasures car;
  car.length_m = 4.5;
  car.width_m = 1.8;
  car.rear_overhang_m = 0.9;
  car.wheelbase_m = 2.6;
  EXPECT_TRUE(doubts_of_given_vehicle("car.yaml", car, drive).empty());
  VehicleMeasures bus = car;
  bus.length_m = 11.0;
  bus.wheelbase_m = 6.0;
  const auto doubts = doubts_of_given_vehicle("bus.yaml", bus, drive);
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_EQ(to_line(doubts[0]),
            "warning: bus.yaml: wheelbase: got 6.0, want 2.6 within 10 % as in "
            "wheels0/sensor.yaml");
}

}  // namespace
}  // namespace roadbook::test
