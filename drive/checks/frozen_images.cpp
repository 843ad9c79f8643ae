#include "drive/checks/frozen_images.hpp"

#include <algorithm>
#include <sstream>
#include <string>

namespace roadbook {
namespace {

// Whether another camera has images of the time that are not all the same.
bool others_change(const std::vector<ImageStream>& images,
                   std::size_t camera,
                   const RepeatedImages& run) {
  for (std::size_t other = 0; other < images.size(); ++other) {
    const auto& stamps = images[other].stamps_ns;
    const auto begin = std::lower_bound(stamps.begin(), stamps.end(), run.first_ns);
    const auto end = std::upper_bound(stamps.begin(), stamps.end(), run.last_ns);
    if (other == camera || end - begin < 2) continue;
    const bool frozen = std::any_of(
        images[other].repeats.begin(), images[other].repeats.end(), [&](const auto& repeat) {
          return repeat.first_ns <= run.last_ns && run.first_ns <= repeat.last_ns;
        });
    if (!frozen) return true;
  }
  return false;
}

}  // namespace

void warn_of_frozen_images(const std::vector<ImageStream>& images,
                           const WayOfWheels& way,
                           ProblemList& problems) {
  constexpr double kMoved_m = 0.5;
  for (std::size_t camera = 0; camera < images.size(); ++camera) {
    const ImageStream& stream = images[camera];
    for (const RepeatedImages& run : stream.repeats) {
      const double way_m = way(run.first_ns, run.last_ns);
      const bool frozen = way_m >= 0.0 ? way_m > kMoved_m
                                       : images.size() == 1 || others_change(images, camera, run);
      if (!frozen) continue;
      std::ostringstream got;
      got.precision(3);
      got << "the same bytes in " << run.count << " images, for "
          << 1e-9 * static_cast<double>(run.last_ns - run.first_ns) << " s";
      if (way_m >= 0.0) got << " in which the wheels roll " << way_m << " m";
      problems.warning((stream.folder.parent_path() / "data.csv").string(), run.first_line,
                       "images", got.str(), "images that change (a camera that hangs?)");
    }
  }
}

}  // namespace roadbook
