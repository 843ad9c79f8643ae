#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/random.hpp"
#include "mapping/occupancy/build_patches.hpp"

namespace roadbook::test {

/// A drive along x through a hall with walls at y = -2.05 and y = 3.05 and ends at x = -5 and 35.
struct HallDrive {
  std::vector<RangeScan> scans;
  std::vector<PatchAnchor> anchors;  ///< one for each scan
  std::vector<std::size_t> anchor_of;
};

inline constexpr double kHallMax_m = 12.0;

inline double hall_distance(const Eigen::Vector2d& o, const Eigen::Vector2d& along) {
  double r = kHallMax_m;
  if (along.y() > 1e-9) r = std::min(r, (3.05 - o.y()) / along.y());
  if (along.y() < -1e-9) r = std::min(r, (-2.05 - o.y()) / along.y());
  if (along.x() > 1e-9) r = std::min(r, (35.0 - o.x()) / along.x());
  if (along.x() < -1e-9) r = std::min(r, (-5.0 - o.x()) / along.x());
  return r;
}

/// `shares`: of readings that do not show the nearest surface.
inline HallDrive hall_drive(std::uint64_t seed,
                            const BeamMixture& shares = {},
                            double sigma_m = 0.03,
                            int count = 120) {
  Random random(seed, "hall");
  RangeModel model;
  model.max_m = kHallMax_m;
  model.sigma_m = sigma_m;
  HallDrive drive;
  for (int s = 0; s < count; ++s) {
    RangeScan scan;
    scan.t_ns = 100'000'000LL * s;
    scan.origin = {0.25 * s * 120.0 / count, 0.4 * std::sin(0.1 * s)};
    for (std::uint32_t b = 0; b < 72; ++b) {
      const double a = 0.0873 * b + 0.013 * s;
      const Eigen::Vector2d along(std::cos(a), std::sin(a));
      const double read = predict_range(model, shares, hall_distance(scan.origin, along),
                                        random.uniform(), random.uniform(), random.normal());
      scan.beams.push_back({b, along.cast<float>(), read});
    }
    drive.scans.push_back(scan);
    drive.anchors.push_back({"hall", scan.t_ns, {scan.origin.x(), scan.origin.y(), 0.05 * s}});
    drive.anchor_of.push_back(static_cast<std::size_t>(s));
  }
  return drive;
}

}  // namespace roadbook::test
