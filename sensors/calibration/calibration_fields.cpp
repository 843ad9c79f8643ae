#include "sensors/calibration/calibration_fields.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

#include "base/se3.hpp"

namespace roadbook {
namespace {

// Matrices are printed with six decimals at worst; 1e-3 is far above that and far below any
// real mistake (degrees for radians, a transposed row, a scale).
constexpr double kRotationTolerance = 1e-3;
constexpr int kLargestMatrix = 1000;

std::string shown(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

struct LensNames {
  CameraModel model;
  std::size_t intrinsics;
  std::size_t distortion;
};

std::optional<LensNames> lens_names(YamlMap& yaml) {
  std::string projection;
  std::string distortion = "none";
  if (!yaml.require("camera_model", projection)) return std::nullopt;
  const bool stated = yaml.require("distortion_model", distortion);
  if (distortion == "radial-tangential") distortion = "radtan";
  if (projection != "pinhole" && projection != "omni" && projection != "ds") {
    yaml.report("camera_model", projection, "pinhole, omni or ds");
    return std::nullopt;
  }
  if (!stated) return std::nullopt;
  if (distortion != "radtan" && distortion != "equidistant" && distortion != "none") {
    yaml.report("distortion_model", distortion, "radtan, equidistant or none");
    return std::nullopt;
  }
  const std::size_t coefficients = distortion == "none" ? 0 : 4;
  if (projection == "pinhole")
    return LensNames{
        distortion == "equidistant" ? CameraModel::kKannalaBrandt : CameraModel::kPinholeRadtan, 4,
        coefficients};
  if (projection == "omni" && distortion != "equidistant")
    return LensNames{CameraModel::kOmni, 5, coefficients};
  if (projection == "ds" && distortion == "none")
    return LensNames{CameraModel::kDoubleSphere, 6, 0};
  yaml.report("distortion_model", distortion,
              projection == "ds" ? "none with ds" : "radtan or none with omni");
  return std::nullopt;
}

MatrixField read_rows(YamlMap& yaml, std::string_view key) {
  MatrixField matrix;
  std::vector<std::vector<double>> rows;
  if (!yaml.read(key, rows)) return matrix;
  matrix.rows = rows.size();
  matrix.cols = rows.empty() ? 0 : rows.front().size();
  for (const auto& row : rows) {
    if (row.size() != matrix.cols) {
      yaml.report(key, "rows of different lengths", "a matrix");
      return {};
    }
    matrix.numbers.insert(matrix.numbers.end(), row.begin(), row.end());
  }
  return matrix;
}

}  // namespace

MatrixField read_matrix(YamlMap& yaml, std::string_view key) {
  if (!yaml.is_map(key)) return read_rows(yaml, key);
  auto inner = yaml.map(key);
  MatrixField matrix;
  for (const char* const name : {"rows", "cols", "dt"})
    inner->ignore(name);  // known, whatever follows
  if (!inner->require("data", matrix.numbers)) return {};
  // A matrix that does not state its shape is square.
  int rows = static_cast<int>(std::lround(std::sqrt(static_cast<double>(matrix.numbers.size()))));
  int cols = rows;
  inner->read("rows", rows, {1, kLargestMatrix});
  inner->read("cols", cols, {1, kLargestMatrix});
  matrix.rows = static_cast<std::size_t>(rows);
  matrix.cols = static_cast<std::size_t>(cols);
  if (matrix.numbers.size() == matrix.rows * matrix.cols) return matrix;
  inner->report("data", std::to_string(matrix.numbers.size()) + " numbers",
                std::to_string(rows * cols));
  return {};
}

bool read_rigid_motion(YamlMap& yaml, std::string_view key, Eigen::Isometry3d& T) {
  const MatrixField matrix = read_matrix(yaml, key);
  if (matrix.numbers.empty()) return false;
  if (matrix.rows != 4 || matrix.cols != 4) {
    yaml.report(key, std::to_string(matrix.rows) + "x" + std::to_string(matrix.cols) + " numbers",
                "4 rows of 4 numbers");
    return false;
  }
  const Eigen::Matrix4d m =
      Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(matrix.numbers.data());
  const Eigen::Matrix3d R = m.topLeftCorner<3, 3>();
  const double off = (R.transpose() * R - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(off <= kRotationTolerance)) {
    yaml.report(key, "a rotation off orthonormal by " + shown(off), "orthonormal axes");
    return false;
  }
  if (!(R.determinant() > 0.0)) {
    yaml.report(key, "a left-handed rotation (determinant " + shown(R.determinant()) + ")",
                "a right-handed one");
    return false;
  }
  if (!(m.row(3) - Eigen::RowVector4d(0, 0, 0, 1)).isZero(1e-9)) {
    yaml.report(key, "another last row", "0 0 0 1");
    return false;
  }
  // A matrix that is already a rotation to the last bits is kept bit for bit.
  T.linear() = off < 1e-14 ? R : nearest_rotation(R);
  T.translation() = m.topRightCorner<3, 1>();
  return true;
}

std::size_t first_focal_parameter(CameraModel model) {
  if (model == CameraModel::kOmni) return 1;
  return model == CameraModel::kDoubleSphere ? 2 : 0;
}

void set_focal_and_centre(YamlMap& yaml,
                          std::string_view key,
                          const double* fu_fv_cu_cv,
                          Camera& camera) {
  if (!(fu_fv_cu_cv[0] > 0.0) || !(fu_fv_cu_cv[1] > 0.0))
    yaml.report(key, "focal lengths " + shown(fu_fv_cu_cv[0]) + ", " + shown(fu_fv_cu_cv[1]),
                "positive ones");
  std::copy_n(
      fu_fv_cu_cv, 4,
      camera.parameters.begin() + static_cast<std::ptrdiff_t>(first_focal_parameter(camera.model)));
}

void read_kalibr_lens(YamlMap& yaml, std::string_view distortion_key, Camera& camera) {
  const auto names = lens_names(yaml);
  std::vector<double> intrinsics;
  std::vector<double> distortion;
  if (!names) {
    yaml.ignore("intrinsics");
    yaml.ignore(distortion_key);
    return;
  }
  camera.model = names->model;
  if (yaml.require("intrinsics", intrinsics) && intrinsics.size() != names->intrinsics) {
    yaml.report("intrinsics", std::to_string(intrinsics.size()) + " numbers",
                std::to_string(names->intrinsics));
    intrinsics.clear();
  }
  if (names->distortion == 0)
    yaml.ignore(distortion_key);
  else if (yaml.require(distortion_key, distortion) && distortion.size() != names->distortion)
    yaml.report(distortion_key, std::to_string(distortion.size()) + " numbers",
                std::to_string(names->distortion));
  if (intrinsics.empty() || distortion.size() != names->distortion) return;
  std::copy(intrinsics.begin(), intrinsics.end(), camera.parameters.begin());
  set_focal_and_centre(yaml, "intrinsics", intrinsics.data() + names->intrinsics - 4, camera);
  std::copy(distortion.begin(), distortion.end(),
            camera.parameters.begin() + static_cast<std::ptrdiff_t>(intrinsics.size()));
}

void read_resolution(YamlMap& yaml, double max_megapixels, Camera& camera) {
  std::vector<double> size;
  if (!yaml.require("resolution", size)) return;
  const auto whole = [](double v) { return v >= 1.0 && v <= 1e6 && v == std::floor(v); };
  if (size.size() != 2 || !whole(size[0]) || !whole(size[1])) {
    yaml.report("resolution", std::to_string(size.size()) + " numbers",
                "[width, height], whole and positive");
    return;
  }
  if (size[0] * size[1] > max_megapixels * 1e6) {
    yaml.report("resolution", shown(size[0]) + "x" + shown(size[1]),
                "at most " + shown(max_megapixels) + " megapixels");
    return;
  }
  camera.width = static_cast<int>(size[0]);
  camera.height = static_cast<int>(size[1]);
}

std::string decimal(double value) {
  std::array<char, 40> buffer{};
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  std::string text(buffer.data(), result.ptr);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

}  // namespace roadbook
