#include "drive/checks/camera_places.hpp"

#include <fstream>

#include "tests/drive/drive_fixture.hpp"

namespace roadbook::test {
namespace {

// A camera at `at` that looks along `azimuth` (0: ahead) and down by `down` [rad].
MountedCamera camera_at(const std::string& name, Eigen::Vector3d at, double azimuth, double down) {
  const Eigen::Quaterniond forward((Eigen::Matrix3d() << 0, 0, 1, -1, 0, 0, 0, -1, 0).finished());
  MountedCamera camera = small_rig().cameras[0];
  camera.name = name;
  camera.T_vehicle_camera = Eigen::Translation3d(at) *
                            Eigen::AngleAxisd(azimuth, Eigen::Vector3d::UnitZ()) *
                            Eigen::AngleAxisd(down, Eigen::Vector3d::UnitY()) * forward;
  return camera;
}

// Four cameras around a car, as for parking.
Rig parking_rig() {
  Rig rig;
  rig.cameras = {
      camera_at("cam0", {3.5, 0, 0.7}, 0.0, 0.3), camera_at("cam1", {1.7, 0.98, 1}, 1.57, 0.7),
      camera_at("cam2", {-0.8, 0, 0.9}, 3.14, 0.3), camera_at("cam3", {1.7, -0.98, 1}, -1.57, 0.7)};
  return rig;
}

VehicleMeasures car() {
  VehicleMeasures vehicle;
  vehicle.length_m = 4.5;
  vehicle.width_m = 1.8;
  vehicle.height_m = 1.5;
  vehicle.rear_overhang_m = 0.9;
  vehicle.wheelbase_m = 2.7;
  return vehicle;
}

std::string found(const Rig& rig, bool wheels, bool vehicle) {
  ProblemList problems;
  warn_of_camera_places("d", rig, wheels ? std::optional(WheelModel{}) : std::nullopt,
                        vehicle ? std::optional(car()) : std::nullopt, problems);
  std::string text;
  for (const auto& problem : problems.problems()) text += to_line(problem) + "\n";
  return text;
}

TEST(CameraPlaces, CamerasOfCarsAreLeftAlone) {
  EXPECT_EQ(found(parking_rig(), true, false), "");
  EXPECT_EQ(found(parking_rig(), false, true), "");
  Rig others;
  others.cameras = {camera_at("roof", {0.5, 0.3, 1.9}, 2.0, 0.0),
                    camera_at("behind the windscreen", {1.8, 0, 1.3}, 0.0, 0.05),
                    camera_at("behind the rear window", {-0.5, 0, 1.2}, 3.14, 0.05),
                    camera_at("mirror, backwards", {2.0, 1.0, 1.0}, 3.10, 0.0),
                    camera_at("straight down", {3.6, 0, 0.8}, 0.0, 1.5)};
  EXPECT_EQ(found(others, true, true), "");
}

TEST(CameraPlaces, InvertedPosesAreNamedAsSuch) {
  for (const bool wheels : {true, false}) {
    Rig rig = parking_rig();
    for (auto& camera : rig.cameras) camera.T_vehicle_camera = camera.T_vehicle_camera.inverse();
    const std::string text = found(rig, wheels, false);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4) << text;
    EXPECT_NE(text.find("d/cam0/sensor.yaml: T_BS: got cam0 at x "), std::string::npos) << text;
    EXPECT_NE(text.find("the inverse of T_BS is a likely pose"), std::string::npos) << text;
  }
}

TEST(CameraPlaces, ASingleUnlikelyCameraIsNamedWithTheReason) {
  const auto with = [&](std::size_t i, MountedCamera camera) {
    Rig rig = parking_rig();
    camera.name = "cam" + std::to_string(i);
    rig.cameras[i] = camera;
    return found(rig, true, true);
  };
  const auto expect = [](const std::string& text, const std::string& reason) {
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
    EXPECT_NE(text.find(reason), std::string::npos) << text;
    EXPECT_EQ(text.find("inverse"), std::string::npos) << text;
  };
  expect(with(1, camera_at("", {1.7, 0.98, -1}, 1.57, 0.7)), "1 m below the ground");
  EXPECT_EQ(with(2, camera_at("", {-8, 0, 0.9}, 3.14, 0.3)), "");  // warn_of_vehicle names it
  Rig far = parking_rig();
  far.cameras[2] = camera_at("cam2", {-8, 0, 0.9}, 3.14, 0.3);
  expect(found(far, true, false), "6.44 m outside the vehicle's body");
  expect(with(0, camera_at("", {3.5, 0, 0.7}, 3.14, 0.3)), "a view through the vehicle's own body");
  expect(with(3, camera_at("", {1.7, -0.98, 1}, 1.57, 0.7)),
         "a view through the vehicle's own body");
  expect(with(0, camera_at("", {3.5, 0, 0.7}, 0, -1.3)), "a view into the sky");
}

TEST(CameraPlaces, AFrameWithoutAVehicleIsNotJudged) {
  Rig drone;  // EuRoC's cameras in the frame of their IMU
  drone.cameras = {camera_at("cam0", {-0.02, -0.06, 0.01}, 0, 0),
                   camera_at("cam1", {-0.02, 0.04, -0.1}, 0, -1.5)};
  EXPECT_EQ(found(drone, false, false), "");
}

}  // namespace
}  // namespace roadbook::test
