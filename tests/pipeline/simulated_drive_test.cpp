#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <thread>

#include "sim/scenario/scenario.hpp"
#include "sim/simulate.hpp"
#include "tests/pipeline/labels_move.hpp"
#include "tests/pipeline/map_judge.hpp"
#include "tests/pipeline/rendered_causes.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

// Renders two laps of the small car park, with images at half scale. All further checks of a test
// use this drive.
fs::path small_zurich(const fs::path& folder, const SimulateOptions& simulation) {
  ScenarioOptions options;
  options.size = "small";
  options.image_scale = 0.5;
  simulate(load_scenario("zurich", options), folder / "drive", simulation);
  return folder / "drive";
}

// Covariances take a third of a build; the tests of the nominal map judge them.
MapOptions without_covariances() {
  MapOptions options;
  options.covariances = false;
  return options;
}

// A copy of the drive that shares the images.
fs::path linked_copy(const fs::path& drive, const fs::path& copy) {
  fs::create_directories(copy);
  for (const auto& sensor : fs::directory_iterator(drive)) {
    const auto target = copy / sensor.path().filename();
    if (!sensor.is_directory()) {
      fs::copy_file(sensor.path(), target);
      continue;
    }
    fs::create_directories(target);
    for (const auto& entry : fs::directory_iterator(sensor.path())) {
      if (entry.is_directory())
        fs::create_directory_symlink(entry.path(), target / entry.path().filename());
      else
        fs::copy_file(entry.path(), target / entry.path().filename());
    }
  }
  return copy;
}

std::string whole_text_of(const fs::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

// Changes the calibration of `copy`: the wheels become 1 % too large.
void enlarge_wheels(const fs::path& copy) {
  const auto file = copy / "wheels0" / "sensor.yaml";
  std::string text = whole_text_of(file);
  for (const std::string key : {"wheel_radius_left: ", "wheel_radius_right: "}) {
    const auto begin = text.find(key);
    ASSERT_NE(begin, std::string::npos);
    const auto end = text.find('\n', begin);
    const double radius = std::stod(text.substr(begin + key.size(), end - begin - key.size()));
    text.replace(begin, end - begin, key + std::to_string(1.01 * radius));
  }
  std::ofstream(file) << text;
}

// Changes `copy`: the calibration states focal lengths that are 4 % too short, and the stamps of
// the wheels are 0.2 s late.
void misstate_lenses_and_clock(const fs::path& copy) {
  for (const std::string camera : {"cam0", "cam1", "cam2", "cam3"}) {
    const auto file = copy / camera / "sensor.yaml";
    std::string text = whole_text_of(file);
    const auto begin = text.find("intrinsics: [") + 13;
    std::istringstream numbers(text.substr(begin, text.find(']', begin) - begin));
    double fu = 0.0;
    double fv = 0.0;
    char comma = 0;
    numbers >> fu >> comma >> fv;
    text.replace(begin, static_cast<std::size_t>(numbers.tellg()),
                 std::to_string(fu / 1.04) + ", " + std::to_string(fv / 1.04));
    std::ofstream(file) << text;
  }
  const auto file = copy / "wheels0" / "data.csv";
  std::istringstream rows(whole_text_of(file));
  std::string row;
  std::getline(rows, row);
  std::string late = row + '\n';
  while (std::getline(rows, row)) {
    const auto comma = row.find(',');
    late +=
        std::to_string(std::stoll(row.substr(0, comma)) + 200'000'000) + row.substr(comma) + '\n';
  }
  std::ofstream(file) << late;
}

// Removes the second half of the rows in the table of the camera.
void kill_camera(const fs::path& copy, const std::string& camera) {
  const auto file = copy / camera / "data.csv";
  const std::string text = whole_text_of(file);
  std::ofstream(file) << text.substr(0, text.find('\n', text.size() / 2) + 1);
}

double median_error_m(const fs::path& map_file, const Drive& truth) {
  return test::error_of(load_map(map_file), truth, false).median_m;
}

void expect_accurate(const fs::path& map_file, const Drive& truth, double factor) {
  const auto error = test::error_of(load_map(map_file), truth, false);
  EXPECT_LT(error.median_m, 0.05 * factor);
  EXPECT_LT(error.p95_m, 0.10 * factor);
}

// Checks the required accuracy on the nominal drive, and that the number of threads does not change
// the map.
void maps_well(const fs::path& folder, const fs::path& drive_folder) {
  const Drive drive = Drive::open(drive_folder);
  MapOptions options;
  options.num_threads = 2;
  const auto summary = build_map({drive_folder}, folder / "map.gpkg", options);
  EXPECT_EQ(summary.scale_source, ScaleSource::kWheels);
  expect_accurate(folder / "map.gpkg", drive, 1.0);
  const auto loops = test::judge_loops(load_map(folder / "map.gpkg"), drive);
  EXPECT_EQ(loops.wrong, 0);
  EXPECT_GT(loops.revisits, 50);
  EXPECT_GT(loops.recall(), 0.9);
  // One drive with one systematic error of its corners: a part of the six may lie outside.
  const auto coverage = test::coverage_of(load_map(folder / "map.gpkg"), drive);
  EXPECT_EQ(coverage.unknown, 0);
  EXPECT_GT(coverage.position, 0.9);
  EXPECT_GT(coverage.heading, 0.9);
  EXPECT_GT(coverage.six, 0.7);
  // Images at half scale have the same accuracy at half the distance. The requirement for images at
  // full scale is 5 cm within 10 m.
  const auto landmarks = test::landmark_errors(load_map(folder / "map.gpkg"), drive, 5.0);
  ASSERT_GT(landmarks.size(), 500U);
  EXPECT_LT(test::median_of(landmarks), 0.05);
  ::testing::Test::RecordProperty("landmark_median_mm",
                                  static_cast<int>(1000.0 * test::median_of(landmarks)));
  options.num_threads = 1;
  options.descriptors_mb = 0;  // as those of a large map, they leave the memory and come back
  const auto single = build_map({drive_folder}, folder / "single.gpkg", options);
  EXPECT_EQ(single.digest, summary.digest);
}

// Keeps the first rows of all tables of the copy, a share of the drive.
void shorten(const fs::path& copy, double share) {
  for (const auto& sensor : fs::directory_iterator(copy)) {
    const auto file = sensor.path() / "data.csv";
    if (!fs::exists(file)) continue;
    const std::string text = whole_text_of(file);
    const auto end = static_cast<std::size_t>(share * static_cast<double>(text.size()));
    std::ofstream(file) << text.substr(0, text.find('\n', end) + 1);
  }
}

// Leaves one camera of the copy, without wheels and inertial sensors.
void keep_alone(const fs::path& copy, const std::string& camera) {
  for (const std::string sensor : {"cam0", "cam1", "cam2", "cam3", "wheels0", "imu0"})
    if (sensor != camera) fs::remove_all(copy / sensor);
}

// A build that is killed leaves either no map or a complete map. The same build, run again, ends
// with the same content.
void survives_a_kill(const fs::path& folder, const fs::path& drive_folder) {
  const auto whole = folder / "whole.gpkg";
  const auto begin = std::chrono::steady_clock::now();
  const std::string digest = build_map({drive_folder}, whole, {}).digest;
  const auto taken = std::chrono::steady_clock::now() - begin;
  const auto map = folder / "killed.gpkg";
  for (const double share : {0.3, 0.8}) {
    const pid_t child = fork();
    if (child == 0) {
      build_map({drive_folder}, map, {});
      _exit(0);
    }
    std::this_thread::sleep_for(share * taken);
    kill(child, SIGKILL);
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status) || WIFEXITED(status));
    if (fs::exists(map)) {
      EXPECT_EQ(map_digest(map), digest);
    }
  }
  const auto summary = build_map({drive_folder}, map, {});
  EXPECT_EQ(summary.digest, digest);
}

// Simulation and diagnosis use the same definition of a slope.
TEST(SimulatedDrive, AGroundThatRisesBeforeTheCarIsNamedWithItsSlope) {
  const auto folder = test::fresh_folder("small_zurich_slope");
  SimulateOptions simulation;
  simulation.effects = {{"ground.slope", -0.012}};
  simulation.max_duration_s = 22.0;  // a round and the beginning of the next
  const auto drive = small_zurich(folder, simulation);
  build_map({drive}, folder / "map.gpkg", without_covariances());
  test::expect_cause(drive, folder / "map.gpkg", "ground.slope", -0.012);
}

TEST(SimulatedDrive, AModelOfALateCameraMendsTheMap) {
  const auto folder = test::fresh_folder("late_camera");
  SimulateOptions simulation;
  simulation.effects = {{"cam0.latency", 0.03}};
  const auto drive_folder = small_zurich(folder, simulation);
  const Drive drive = Drive::open(drive_folder);
  MapOptions options = without_covariances();
  build_map({drive_folder}, folder / "late.gpkg", options);
  options.model = simulation.effects;
  build_map({drive_folder}, folder / "told.gpkg", options);
  expect_accurate(folder / "told.gpkg", drive, 0.5);
  EXPECT_GT(median_error_m(folder / "late.gpkg", drive),
            2.0 * median_error_m(folder / "told.gpkg", drive));
}

TEST(SimulatedDrive, SmallZurichMapsWellAndSurvivesBadWheelsNoWheelsAndADeadCamera) {
  const auto folder = test::fresh_folder("small_zurich");
  SimulateOptions simulation;
  simulation.range_images = true;  // the judge of landmarks and loops reads them
  const auto drive_folder = small_zurich(folder, simulation);
  const Drive drive = Drive::open(drive_folder);
  {
    SCOPED_TRACE("nominal");
    maps_well(folder, drive_folder);
    test::expect_nothing_but_the_hinge(drive_folder, folder / "map.gpkg");
    test::expect_ellipses_to_hold_their_truth(drive_folder, folder / "map.gpkg");
  }
  {
    SCOPED_TRACE("labels of a map that is bent, and mended");
    test::expect_labels_of_a_bent_map_to_be_mended(drive_folder, folder);
  }
  {
    SCOPED_TRACE("a focal length stated 1 % too short");
    const auto copy = linked_copy(drive_folder, folder / "short_focal");
    test::shorten_focal_length(copy);
    build_map({copy}, folder / "short_focal.gpkg", without_covariances());
    test::expect_cause(copy, folder / "short_focal.gpkg", "cam1.focal", 0.01);
  }
  {
    SCOPED_TRACE("killed");
    const auto copy = linked_copy(drive_folder, folder / "short");
    shorten(copy, 0.25);
    survives_a_kill(folder, copy);
  }
  // A round and the beginning of the next.
  const auto round = linked_copy(drive_folder, folder / "round");
  shorten(round, 0.7);
  {
    SCOPED_TRACE("wheels 1 % too large");
    const auto copy = linked_copy(round, folder / "large_wheels");
    enlarge_wheels(copy);
    build_map({copy}, folder / "large_wheels.gpkg", without_covariances());
    expect_accurate(folder / "large_wheels.gpkg", drive, 1.0);
    const Map map = load_map(folder / "large_wheels.gpkg");
    EXPECT_NEAR(map.sessions.front().wheel_scale, 1.0 / 1.01, 0.006);
    const double driven_m = test::driven_truth_m(map, drive);
    EXPECT_NEAR(map.keyframes.back().travelled_m, driven_m, 0.005 * driven_m);
  }
  {
    SCOPED_TRACE("a model of what is wrong");
    const auto copy = linked_copy(drive_folder, folder / "misstated");
    misstate_lenses_and_clock(copy);
    MapOptions options = without_covariances();
    build_map({copy}, folder / "misled.gpkg", options);
    const double misled_m = median_error_m(folder / "misled.gpkg", drive);
    options.model = {{"cam.focal", 0.04}, {"wheels0.latency", 0.2}};
    build_map({copy}, folder / "told.gpkg", options);
    expect_accurate(folder / "told.gpkg", drive, 1.0);
    EXPECT_GT(misled_m, 5.0 * median_error_m(folder / "told.gpkg", drive));
  }
  {
    SCOPED_TRACE("vision alone");
    MapOptions options = without_covariances();
    options.tracking.use_wheels = false;
    const auto summary = build_map({round}, folder / "vision.gpkg", options);
    EXPECT_EQ(summary.scale_source, ScaleSource::kCameraHeight);
    EXPECT_EQ(summary.components, 1U);
    expect_accurate(folder / "vision.gpkg", drive, 1.0);
    const Map map = load_map(folder / "vision.gpkg");
    const double driven_m = test::driven_truth_m(map, drive);
    EXPECT_NEAR(map.keyframes.back().travelled_m, driven_m, 0.01 * driven_m);
  }
  // The front camera sees little that is near in the tight turns.
  for (const std::string camera : {"cam0", "cam1"}) {
    SCOPED_TRACE(camera + " alone");
    const auto copy = linked_copy(round, folder / (camera + "_alone"));
    keep_alone(copy, camera);
    const auto summary = build_map({copy}, folder / "alone.gpkg", without_covariances());
    EXPECT_EQ(summary.scale_source, ScaleSource::kCameraHeight);
    EXPECT_EQ(summary.components, 1U);
    EXPECT_GT(summary.loops_accepted, 20U);
    expect_accurate(folder / "alone.gpkg", drive, 2.0);
    std::filesystem::remove(folder / "alone.gpkg");
  }
  {
    SCOPED_TRACE("a camera dies half way");
    const auto copy = linked_copy(round, folder / "dead_camera");
    kill_camera(copy, "cam0");
    const auto summary = build_map({copy}, folder / "dead_camera.gpkg", without_covariances());
    EXPECT_FALSE(summary.warnings.empty());
    expect_accurate(folder / "dead_camera.gpkg", drive, 1.0);
  }
}

}  // namespace
}  // namespace roadbook
