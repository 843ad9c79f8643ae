#pragma once

#include <string_view>

namespace roadbook {

/// How a camera maps rays to pixels, and the order of its parameters.
enum class CameraModel {
  kPinholeRadtan,  ///< fu fv cu cv, k1 k2 p1 p2 (OpenCV's first four)
  kKannalaBrandt,  ///< fu fv cu cv, k1 k2 k3 k4: r = theta (1 + k1 theta^2 + ...), Kalibr
                   ///< "equidistant"
  kOmni,           ///< xi, fu fv cu cv, k1 k2 p1 p2: Mei 2007, CamOdoCal "MEI"
  kDoubleSphere,   ///< xi alpha, fu fv cu cv: Usenko et al. 2018
};

/// Number of parameters of a model.
[[nodiscard]] int parameter_count(CameraModel model);
/// Kalibr's name: "pinhole-radtan", "pinhole-equidistant", "omni-radtan", "ds-none".
[[nodiscard]] std::string_view camera_model_name(CameraModel model);

}  // namespace roadbook
