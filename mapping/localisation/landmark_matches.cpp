#include "mapping/localisation/landmark_matches.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "base/cell_grid.hpp"
#include "base/index.hpp"
#include "base/median.hpp"
#include "vo/triangulation.hpp"

namespace roadbook {
namespace {

constexpr double kLeastTwinParallax = 0.05;  // [rad]
constexpr double kCornerSigma = 0.5;         // [px]

// Along which rays a landmark is seen, and how wide a pixel is.
struct Rays {
  std::vector<Ray> rays;
  double pixel_rad = 0.0;
};
struct Sides {
  Rays now, then;
};

void add_ray(const Camera& camera,
             const Eigen::Isometry3d& T_map_camera,
             const Eigen::Vector2d& pixel,
             Rays& rays) {
  const auto bearing = camera.bearing(pixel);
  const auto beside = camera.bearing(pixel + Eigen::Vector2d(1.0, 0.0));
  if (!bearing || !beside) return;
  rays.pixel_rad = std::max(rays.pixel_rad, (*beside - *bearing).norm());
  rays.rays.push_back({T_map_camera.translation(), T_map_camera.linear() * *bearing});
}

std::vector<Sides> landmark_sides(const Map& map, int session) {
  std::vector<Sides> sides(map.landmarks.size());
  for (const Observation& o : map.observations) {
    const Keyframe& keyframe = map.keyframes[at(o.keyframe)];
    const MountedCamera& mounted = map.sessions[at(keyframe.session)].rig.cameras[at(o.camera)];
    Sides& s = sides[at(o.landmark)];
    add_ray(mounted.camera, map.T_map_vehicle(o.keyframe) * mounted.T_vehicle_camera,
            o.pixel.cast<double>(), keyframe.session == session ? s.now : s.then);
  }
  return sides;
}

struct Place {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();
  double sigma_m = 0.0;
};

std::optional<Place> twin_place(const Rays& seen) {
  const auto point = triangulate(seen.rays, kLeastTwinParallax);
  if (!point) return std::nullopt;
  const double range = (point->p_world - seen.rays.front().origin).norm();
  return Place{point->p_world, range * kCornerSigma * seen.pixel_rad / point->parallax_rad};
}

struct Lone {
  int landmark = 0;
  Place place;
};

LandmarkTwin twin_of(const Lone& then, const Lone& now) {
  return {then.place.p_map, now.place.p_map - then.place.p_map,
          std::hypot(then.place.sigma_m, now.place.sigma_m), then.landmark, now.landmark};
}

// Of each of `from` the nearest descriptor among those of `to` nearby; -1: none, or not clearly.
std::vector<int> nearest(const Map& map,
                         const std::vector<Lone>& from,
                         const std::vector<Lone>& to,
                         const LandmarkTwinOptions& options) {
  CellGrid<std::size_t> grid(options.radius_m);
  for (std::size_t i = 0; i < to.size(); ++i) grid.insert(to[i].place.p_map.head<2>(), i);
  std::vector<int> best(from.size(), -1);
  for (std::size_t i = 0; i < from.size(); ++i) {
    int least = 513;
    int second = 513;
    grid.visit_near(from[i].place.p_map.head<2>(), [&](std::size_t j) {
      if ((to[j].place.p_map - from[i].place.p_map).norm() > options.radius_m) return;
      const int d = hamming(map.landmarks[at(from[i].landmark)].descriptor,
                            map.landmarks[at(to[j].landmark)].descriptor);
      if (d < least) {
        second = least;
        least = d;
        best[i] = static_cast<int>(j);
      } else {
        second = std::min(second, d);
      }
    });
    if (least > options.max_hamming || least > options.max_ratio * second) best[i] = -1;
  }
  return best;
}

// Subtracts from each twin's shift the median shift of the twins around it.
void align(const LandmarkTwinOptions& options, std::vector<LandmarkTwin>& twins) {
  CellGrid<std::size_t> grid(options.align_m);
  for (std::size_t i = 0; i < twins.size(); ++i)
    if (twins[i].shift.norm() < options.static_m) grid.insert(twins[i].then.head<2>(), i);
  std::vector<LandmarkTwin> aligned;
  std::vector<double> values[3];
  for (const LandmarkTwin& twin : twins) {
    for (auto& v : values) v.clear();
    grid.visit_near(twin.then.head<2>(), [&](std::size_t j) {
      if ((twins[j].then - twin.then).norm() > options.align_m) return;
      for (int k = 0; k < 3; ++k) values[k].push_back(twins[j].shift[k]);
    });
    if (values[0].size() < options.fewest) continue;  // nothing says how the poses lie
    aligned.push_back(twin);
    for (int k = 0; k < 3; ++k) aligned.back().shift[k] -= median(values[k]);
  }
  twins = std::move(aligned);
}

}  // namespace

std::vector<LandmarkTwin> landmark_twins(const Map& map,
                                         int session,
                                         const LandmarkTwinOptions& options) {
  const std::vector<Sides> sides = landmark_sides(map, session);
  std::vector<LandmarkTwin> twins;
  std::vector<Lone> now;
  std::vector<Lone> then;
  for (std::size_t l = 0; l < sides.size(); ++l) {
    const auto here = twin_place(sides[l].now);
    const auto before = twin_place(sides[l].then);
    const int id = static_cast<int>(l);
    if (here && before)
      twins.push_back(twin_of({id, *before}, {id, *here}));
    else if (here && sides[l].then.rays.empty())
      now.push_back({id, *here});
    else if (before && sides[l].now.rays.empty())
      then.push_back({id, *before});
  }
  const std::vector<int> forth = nearest(map, now, then, options);
  const std::vector<int> back = nearest(map, then, now, options);
  for (std::size_t i = 0; i < now.size(); ++i)
    if (forth[i] >= 0 && back[at(forth[i])] == static_cast<int>(i))
      twins.push_back(twin_of(then[at(forth[i])], now[i]));
  if (options.aligned) return aligned_twins(std::move(twins), options);
  std::erase_if(twins, [&](const LandmarkTwin& t) { return t.sigma_m > options.max_sigma_m; });
  return twins;
}

std::vector<LandmarkTwin> aligned_twins(std::vector<LandmarkTwin> twins,
                                        const LandmarkTwinOptions& options) {
  std::erase_if(twins, [&](const LandmarkTwin& t) { return t.sigma_m > options.max_sigma_m; });
  align(options, twins);
  return twins;
}

}  // namespace roadbook
