#include "drive/sensor_yaml.hpp"
#include "drive/vehicle_yaml.hpp"
#include "tests/fuzz/fuzz_support.hpp"

using namespace roadbook;

// The first byte chooses the sensor.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const fuzz::fs::path file = fuzz::work_folder() / "sensor.yaml";
  fuzz::put(file, fuzz::text_of(data + 1, size - 1));
  ProblemList problems;
  switch (data[0] % 4) {
    case 0:
      (void)read_camera_yaml(file, "cam0", 64.0, problems);
      break;
    case 1:
      (void)read_wheel_yaml(file, problems);
      break;
    case 2:
      (void)read_stream_yaml(file, problems);
      break;
    default:
      (void)read_vehicle_yaml(file, problems);
  }
  (void)problems.problems();
  return 0;
}
