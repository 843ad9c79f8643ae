#include "workflows/labels/people_images.hpp"

#include <algorithm>
#include <limits>

#include "base/parallel.hpp"
#include "mapping/session_car.hpp"
#include "mapping/session_track.hpp"
#include "semantics/people/person_labels.hpp"

namespace roadbook {

std::optional<std::size_t> frame_at(const Drive& drive, std::int64_t t_ns) {
  std::size_t begin = 0;
  std::size_t end = drive.frame_count();
  while (begin < end) {
    const std::size_t middle = (begin + end) / 2;
    if (drive.frame_stamp_ns(middle) < t_ns)
      begin = middle + 1;
    else
      end = middle;
  }
  if (begin == drive.frame_count() || drive.frame_stamp_ns(begin) != t_ns) return std::nullopt;
  return begin;
}

PeopleImages::PeopleImages(const Map* map,
                           const std::vector<std::optional<Drive>>* drives,
                           const PersonLearnerOptions& options,
                           double every_s)
    : map_(map), drives_(drives), options_(options) {
  for (std::size_t s = 0; s < map->sessions.size(); ++s) {
    eyes_.push_back(std::make_unique<Eyes>());
    const auto& drive = (*drives)[s];
    if (!drive) continue;
    const SessionTrack track(*map, static_cast<int>(s));
    const auto cameras = static_cast<int>(map->sessions[s].rig.cameras.size());
    std::int64_t next = std::numeric_limits<std::int64_t>::min();
    for (std::size_t f = 0; f < drive->frame_count(); ++f) {
      const std::int64_t t = drive->frame_stamp_ns(f);
      if (t < next || !track.at(t)) continue;
      for (int c = 0; c < cameras; ++c)
        if (drive->has_image(f, static_cast<std::size_t>(c)))
          all_.push_back({static_cast<int>(s), t, c});
      next = t + static_cast<std::int64_t>(1e9 * every_s) - 1'000'000;
    }
  }
}

PeopleImages::~PeopleImages() = default;

std::optional<std::size_t> PeopleImages::frame_of(const LabelAnchor& image) const {
  if (image.session < 0 || image.session >= static_cast<int>(map_->sessions.size()))
    return std::nullopt;
  const auto s = static_cast<std::size_t>(image.session);
  const auto cameras = static_cast<int>(map_->sessions[s].rig.cameras.size());
  if (image.camera < 0 || image.camera >= cameras || !(*drives_)[s]) return std::nullopt;
  return frame_at(*(*drives_)[s], image.t_ns);
}

bool PeopleImages::has(const LabelAnchor& image) const { return frame_of(image).has_value(); }

std::optional<LabelAnchor> PeopleImages::neighbour(const LabelAnchor& image, int step) const {
  std::vector<LabelAnchor> mine;
  for (const LabelAnchor& other : all_)
    if (other.session == image.session && other.camera == image.camera) mine.push_back(other);
  auto at = std::lower_bound(
      mine.begin(), mine.end(), image.t_ns,
      [](const LabelAnchor& other, std::int64_t t_ns) { return other.t_ns < t_ns; });
  const auto index = (at - mine.begin()) + step;
  if (index < 0 || index >= static_cast<std::ptrdiff_t>(mine.size())) return std::nullopt;
  return mine[static_cast<std::size_t>(index)];
}

const PersonSearch& PeopleImages::search_of(const LabelAnchor& image) const {
  const auto s = static_cast<std::size_t>(image.session);
  Eyes& eyes = *eyes_[s];
  std::call_once(eyes.made, [&] {
    const auto masks =
        own_car_of(map_->sessions[s], *(*drives_)[s], {}, options_.num_threads).masks;
    const auto& cameras = map_->sessions[s].rig.cameras;
    std::vector<std::optional<PersonSearch>> made(cameras.size());
    parallel_for(cameras.size(), options_.num_threads, [&](std::size_t c) {
      const PersonCamera camera(cameras[c], c < masks.size() ? masks[c] : cv::Mat());
      made[c].emplace(static_cast<int>(c), camera, options_.search);
    });
    for (auto& search : made) eyes.searches.push_back(std::move(*search));
  });
  return eyes.searches[static_cast<std::size_t>(image.camera)];
}

ImagePyramid PeopleImages::read(const LabelAnchor& image) const {
  const auto frame = frame_of(image);
  const auto camera = static_cast<std::size_t>(image.camera);
  if (!frame) return {};
  const Drive& drive = *(*drives_)[static_cast<std::size_t>(image.session)];
  if (!drive.has_image(*frame, camera)) return {};
  const cv::Mat grey = drive.read_image(*frame, camera);
  return grey.empty() ? ImagePyramid() : image_pyramid(grey);
}

std::vector<PersonHypothesis> PeopleImages::search(const LabelAnchor& image,
                                                   const GpClassifier& classifier) const {
  const ImagePyramid pyramid = read(image);
  if (pyramid.empty()) return {};
  return search_of(image).run(pyramid, classifier);
}

std::string PeopleImages::picture(const LabelAnchor& image, const PersonBox& box) const {
  const auto one = pictures(image, {box});
  return one.empty() ? std::string() : one.front();
}

std::vector<std::string> PeopleImages::pictures(const LabelAnchor& image,
                                                const std::vector<PersonBox>& boxes) const {
  std::vector<std::string> pictures;
  const ImagePyramid pyramid = read(image);
  if (pyramid.empty()) return pictures;
  for (const PersonBox& box : boxes)
    pictures.push_back(window_picture(search_of(image).camera(), pyramid, box));
  return pictures;
}

std::vector<std::string> PeopleImages::random_pictures(const LabelAnchor& image,
                                                       const std::vector<PersonBox>& not_on,
                                                       std::size_t count) const {
  std::vector<std::string> pictures;
  const ImagePyramid pyramid = read(image);
  if (pyramid.empty()) return pictures;
  const PersonSearch& search = search_of(image);
  // The random numbers depend only on the image. An action that is sent again therefore draws the
  // same windows.
  Random random(options_.seed, "nobody in image of camera " + std::to_string(image.camera),
                static_cast<std::uint64_t>(image.t_ns));
  for (int tries = 0; pictures.size() < count && tries < 200; ++tries) {
    const auto box = search.random_box(random);
    if (!box) break;
    if (std::none_of(not_on.begin(), not_on.end(), [&](const PersonBox& other) {
          return intersection_over_union(*box, other) > options_.same_overlap;
        }))
      pictures.push_back(window_picture(search.camera(), pyramid, *box));
  }
  return pictures;
}

}  // namespace roadbook
