#include "sensors/camera_model.hpp"

namespace roadbook {

int parameter_count(CameraModel model) {
  switch (model) {
    case CameraModel::kOmni:
      return 9;
    case CameraModel::kDoubleSphere:
      return 6;
    default:
      return 8;
  }
}

std::string_view camera_model_name(CameraModel model) {
  switch (model) {
    case CameraModel::kPinholeRadtan:
      return "pinhole-radtan";
    case CameraModel::kKannalaBrandt:
      return "pinhole-equidistant";
    case CameraModel::kOmni:
      return "omni-radtan";
    case CameraModel::kDoubleSphere:
      return "ds-none";
  }
  return "";
}

}  // namespace roadbook
