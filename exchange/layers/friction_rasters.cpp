#include "exchange/layers/friction_rasters.hpp"

#include <cmath>

#include "exchange/layers/value_raster.hpp"

namespace roadbook {
namespace {

// Calls visit(p, place) over all strips, closely enough to meet every cell of that size.
template <typename Visit>
void for_ground(const FrictionMap& friction, double cell_m, const Visit& visit) {
  for (const LaneStrips::Strip& strip : friction.strips.strips())
    for (double s = 0.0; s < strip.length_m(); s += 0.5 * cell_m)
      for (double e = -strip.half_width_m; e <= strip.half_width_m; e += 0.5 * cell_m)
        if (const auto p = strip.frame.position(s, e)) visit(*p, PathPlace{strip.begin_m + s, e});
}

void write_one(MapUpdate& update,
               const FrictionMap& friction,
               std::size_t property,
               double cell_m,
               const ValueRaster& empty) {
  const PropertyPrior& about = friction.map.prior().properties[property];
  const bool is_friction = property == 0;
  const std::string name = is_friction ? "friction" : about.name;
  const std::string unit = about.unit == "-" ? "" : " [" + about.unit + "]";
  ValueRaster mean = empty;
  ValueRaster sigma = empty;
  // Where two tubes overlap, the lane whose middle is nearer counts.
  std::vector<float> offset(mean.values.size(), INFINITY);
  for_ground(friction, cell_m, [&](const Eigen::Vector2d& p, const PathPlace& place) {
    const std::size_t cell = mean.index_of(p);
    const auto aside = static_cast<float>(std::abs(place.e_m));
    if (!(aside < offset[cell])) return;
    const auto moments = friction.map.moments(property, place);
    if (!moments) return;
    offset[cell] = aside;
    mean.values[cell] = static_cast<float>(moments->mean);
    sigma.values[cell] = static_cast<float>(std::sqrt(moments->variance));
  });
  write_value_raster(update, name + "_mean", name + " of the ground, mean" + unit, mean);
  write_value_raster(update, name + "_sigma", name + " of the ground, standard deviation" + unit,
                     sigma);
  if (is_friction)
    write_colour_raster(update, "friction_colours", "friction: dark at 1, yellow at 0.2", mean, 1.0,
                        0.2);
  else
    write_colour_raster(update, name + "_colours", name + ": dark at least, yellow at most", mean,
                        about.min, about.max);
}

}  // namespace

void write_property_rasters(MapUpdate& update, const FrictionMap& friction) {
  const double cell_m = 0.5 * friction.spacing_m;
  Eigen::Vector2d low = Eigen::Vector2d::Constant(INFINITY);
  Eigen::Vector2d high = -low;
  for_ground(friction, cell_m, [&](const Eigen::Vector2d& p, const PathPlace&) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  });
  if (!(low.x() <= high.x())) return;
  const ValueRaster empty = ValueRaster::over(low, high, cell_m);
  for (std::size_t i = 0; i < friction.map.prior().properties.size(); ++i)
    write_one(update, friction, i, cell_m, empty);
}

}  // namespace roadbook
