#include "drive/detections.hpp"
#include "drive/tables.hpp"
#include "tests/fuzz/fuzz_support.hpp"

using namespace roadbook;

// The first byte chooses the table.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const fuzz::fs::path file = fuzz::work_folder() / "data.csv";
  fuzz::put(file, fuzz::text_of(data + 1, size - 1));
  ProblemList problems;
  return fuzz::try_parse([&] {
    switch (data[0] % 7) {
      case 0: {
        WheelModel model;
        model.ticks_per_turn = data[0] > 127 ? 1000.0 : 0.0;
        (void)read_wheel_table(file, model, {}, problems, [](const auto&) {});
        break;
      }
      case 1:
        (void)read_truth_table(file, problems, [](const auto&) {});
        break;
      case 2:
        (void)read_imu_table(file, {}, problems, [](const auto&) {});
        break;
      case 3:
        (void)read_friction_table(file, {}, problems, [](const auto&) {});
        break;
      case 4:
        (void)read_range_table(file, {}, problems, [](const auto&) {});
        break;
      case 5:
        (void)read_detections(file);
        break;
      default:
        (void)read_looks(file);
    }
    (void)problems.problems();
  });
}
