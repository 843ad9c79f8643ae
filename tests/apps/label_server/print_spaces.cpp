#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "mapping/store/map_file.hpp"
#include "workflows/labels/label_place.hpp"
#include "workflows/people/truth_scene.hpp"

// print_spaces MAP SESSION DRIVE: the parking spaces of a simulated drive where the map has them,
// for car_park_labeller.mjs: middle x, y [m], heading [rad], length, width [m], share that the
// overhead image shows.
int main(int count, char** words) {
  using namespace roadbook;
  if (count != 4) return 1;
  const Map map = load_map(words[1]);
  const LabelPlace place = read_label_place(words[1]);
  for (const Outline& outline : read_truth_scene(map, std::atoi(words[2]), words[3], 10.0).spaces) {
    if (outline.size() < 4) continue;
    const Eigen::Vector2d first = outline[1] - outline[0];
    const Eigen::Vector2d second = outline[2] - outline[1];
    const Eigen::Vector2d& along = first.norm() >= second.norm() ? first : second;
    const Eigen::Vector2d middle = 0.25 * (outline[0] + outline[1] + outline[2] + outline[3]);
    const OrientedBox box{middle, std::atan2(along.y(), along.x()), along.norm(),
                          std::min(first.norm(), second.norm())};
    std::printf("%.4f %.4f %.6f %.4f %.4f %.2f\n", middle.x(), middle.y(), box.heading,
                box.length_m, box.width_m, seen_share(place.image, box));
  }
  return 0;
}
