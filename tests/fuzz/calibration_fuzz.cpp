#include "sensors/calibration/calibration_io.hpp"
#include "tests/fuzz/fuzz_support.hpp"

using namespace roadbook;

// The first byte chooses the format.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const fuzz::fs::path file =
      fuzz::work_folder() / (data[0] % 5 == 3 ? "calibration.json" : "calibration.yaml");
  fuzz::put(file, fuzz::text_of(data + 1, size - 1));
  return fuzz::try_parse([&] {
    switch (data[0] % 5) {
      case 0:
        (void)kalibr_camchain_text(read_kalibr_camchain(file).rig);
        break;
      case 1:
        (void)read_opencv_calibration(file);
        break;
      case 2:
        (void)read_camodocal_calibration(file);
        break;
      case 3:
        (void)read_basalt_calibration(file);
        break;
      default:
        (void)read_calibration(file);
    }
  });
}
