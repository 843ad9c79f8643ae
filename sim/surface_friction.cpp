#include <cmath>

#include "sim/streams/friction_stream.hpp"
#include "sim/streams/sensor_streams.hpp"

namespace roadbook {

SurfaceClass ground_kind(const World& world, double x, double y) {
  const Canvas& kind = world.paint.kind;
  const Eigen::Vector2d texel = kind.texel({x, y});
  const int i = static_cast<int>(std::lround(texel.x()));
  const int j = static_cast<int>(std::lround(texel.y()));
  if (i < 0 || j < 0 || i >= kind.image.cols || j >= kind.image.rows) return SurfaceClass::kRoad;
  return static_cast<SurfaceClass>(kind.image.at<std::uint8_t>(j, i));
}

double friction_of(SurfaceClass kind) {
  switch (kind) {
    case SurfaceClass::kGravel:
      return 0.55;
    case SurfaceClass::kWater:
      return 0.40;
    case SurfaceClass::kMarking:
    case SurfaceClass::kCrossing:
      return 0.75;
    default:
      return 0.90;
  }
}

}  // namespace roadbook
