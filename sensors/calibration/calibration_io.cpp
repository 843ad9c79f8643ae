#include "sensors/calibration/calibration_io.hpp"

#include "base/error.hpp"
#include "base/yaml.hpp"

namespace roadbook {

Calibration read_calibration(const std::filesystem::path& file) {
  if (file.extension() == ".json") return read_basalt_calibration(file);
  const YamlMap yaml = YamlMap::load(file);
  if (yaml.has("cam0")) return read_kalibr_camchain(file);
  if (yaml.has("model_type")) return read_camodocal_calibration(file);
  if (yaml.has("camera_matrix")) return read_opencv_calibration(file);
  if (yaml.has("value0")) return read_basalt_calibration(file);
  throw BadInput(
      {Severity::kError, file.string(), 0, "", "none of the keys of a calibration",
       "cam0 (Kalibr), model_type (CamOdoCal), camera_matrix (OpenCV) or value0 (Basalt)"});
}

}  // namespace roadbook
