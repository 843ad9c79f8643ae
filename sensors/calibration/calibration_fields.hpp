#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>
#include <vector>

#include "base/yaml.hpp"
#include "sensors/camera.hpp"

namespace roadbook {

// Fields that calibration files have in common: matrices, rigid motions, Kalibr's camera models.
// Each function adds its faults to those of the mapping.

/// Accepted widths and heights [px].
inline constexpr Range kImageSide{1, 1e6};

/// Shape and numbers (row by row) of a matrix: a list of rows, or a mapping with rows, cols and
/// data (EuRoC, OpenCV). Empty if the key is absent or wrong.
struct MatrixField {
  std::size_t rows = 0;
  std::size_t cols = 0;
  std::vector<double> numbers;
};
[[nodiscard]] MatrixField read_matrix(YamlMap& yaml, std::string_view key);

/// Reads a 4x4 rigid motion, right-handed and orthonormal to 1e-3. Otherwise returns false and adds
/// a fault; an absent key is no fault. The rotation is orthonormalised unless it is exact.
bool read_rigid_motion(YamlMap& yaml, std::string_view key, Eigen::Isometry3d& T);

/// Reads camera_model, distortion_model, intrinsics and `distortion_key` with Kalibr's names and
/// orders (ConfigReader.py); EuRoC's "radial-tangential" means "radtan".
void read_kalibr_lens(YamlMap& yaml, std::string_view distortion_key, Camera& camera);

/// Reads `resolution: [width, height]`, whole and positive; a larger image than `max_megapixels` is
/// a fault.
void read_resolution(YamlMap& yaml, double max_megapixels, Camera& camera);

/// Sets the focal lengths and the principal point among the parameters of the model. A focal length
/// that is not positive is a fault of `key`.
void set_focal_and_centre(YamlMap& yaml,
                          std::string_view key,
                          const double* fu_fv_cu_cv,
                          Camera& camera);

/// Index of the focal length among the parameters of a model.
[[nodiscard]] std::size_t first_focal_parameter(CameraModel model);

/// Shortest decimal number that reads back to `value`, always with a point or an exponent.
[[nodiscard]] std::string decimal(double value);

}  // namespace roadbook
