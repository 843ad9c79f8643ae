#include "drive/frame_index.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

namespace roadbook {
namespace {

// What the stamps of one instant may differ by [ns].
std::int64_t pairing_tolerance_ns(const std::vector<ImageStream>& images, double tolerance_s) {
  double most_ns = 1e9 * std::clamp(tolerance_s, 0.0, 1.0);
  for (const ImageStream& stream : images)
    if (stream.summary.rate_hz > 0.0) most_ns = std::min(most_ns, 0.5e9 / stream.summary.rate_hz);
  return static_cast<std::int64_t>(most_ns);
}

// Forms instants from images that come in the order of their stamps.
class InstantBuilder {
 public:
  InstantBuilder(FrameIndex& frames, std::size_t cameras, std::int64_t tolerance_ns)
      : frames_(frames), tolerance_ns_(tolerance_ns), own_ns_(cameras, 0) {
    frames_.offsets_ns.resize(cameras);
  }
  // The cameras whose bits are set have an image with this stamp.
  void add(std::int64_t t_ns, std::uint64_t cameras) {
    if (open_ != 0 && (t_ns - begin_ns_ > tolerance_ns_ || (cameras & open_) != 0)) close();
    if (open_ == 0) begin_ns_ = t_ns;
    open_ |= cameras;
    for (std::size_t camera = 0; camera < own_ns_.size(); ++camera)
      if ((cameras >> camera & 1u) != 0) own_ns_[camera] = t_ns;
  }
  void close() {
    if (open_ == 0) return;
    const std::size_t frame = frames_.stamps_ns.size();
    const std::int64_t t_ns = own_ns_[static_cast<std::size_t>(std::countr_zero(open_))];
    frames_.stamps_ns.push_back(t_ns);
    frames_.cameras.push_back(open_);
    for (std::size_t camera = 0; camera < own_ns_.size(); ++camera)
      if ((open_ >> camera & 1u) != 0 && own_ns_[camera] != t_ns)
        late_.push_back({frame, camera, static_cast<std::int32_t>(own_ns_[camera] - t_ns)});
    open_ = 0;
  }
  void finish() {
    close();
    for (const Late& late : late_) {
      auto& offsets = frames_.offsets_ns[late.camera];
      if (offsets.empty()) offsets.assign(frames_.stamps_ns.size(), 0);
      offsets[late.frame] = late.by_ns;
    }
    frames_.stamps_ns.shrink_to_fit();
    frames_.cameras.shrink_to_fit();
  }

 private:
  struct Late {
    std::size_t frame, camera;
    std::int32_t by_ns;
  };
  FrameIndex& frames_;
  std::int64_t tolerance_ns_;
  std::vector<std::int64_t> own_ns_;  ///< by camera: the stamp of its latest image
  std::vector<Late> late_;
  std::uint64_t open_ = 0;
  std::int64_t begin_ns_ = 0;
};

// How the images of a camera lie to those of another one, where neither lacks an image.
struct Stagger {
  std::size_t images = 0;
  std::vector<std::int64_t> apart_ns;  ///< of those beyond the tolerance; positive: later
};

Stagger stagger_of(const std::vector<std::int64_t>& of,
                   const std::vector<std::int64_t>& to,
                   std::int64_t tolerance_ns,
                   double farthest_ns) {
  Stagger stagger;
  std::size_t near = 0;
  for (const std::int64_t t : of) {
    while (near + 1 < to.size() && std::abs(to[near + 1] - t) <= std::abs(to[near] - t)) ++near;
    const std::int64_t apart = t - to[near];
    if (std::abs(static_cast<double>(apart)) > farthest_ns) continue;
    ++stagger.images;
    if (std::abs(apart) > tolerance_ns) stagger.apart_ns.push_back(apart);
  }
  return stagger;
}

std::string milliseconds(double ns) {
  std::ostringstream text;
  text.precision(4);
  text << 1e-6 * ns << " ms";
  return text.str();
}

}  // namespace

FrameIndex index_frames(const std::vector<ImageStream>& images, double tolerance_s) {
  FrameIndex frames;
  const std::size_t count = std::min(images.size(), FrameIndex::kMaxCameras);
  InstantBuilder instants(frames, count, pairing_tolerance_ns(images, tolerance_s));
  std::vector<std::size_t> next(count, 0);
  for (;;) {
    std::int64_t t_ns = std::numeric_limits<std::int64_t>::max();
    std::uint64_t cameras = 0;
    for (std::size_t camera = 0; camera < count; ++camera) {
      const auto& stamps = images[camera].stamps_ns;
      if (next[camera] == stamps.size() || stamps[next[camera]] > t_ns) continue;
      if (stamps[next[camera]] < t_ns) cameras = 0;
      t_ns = stamps[next[camera]];
      cameras |= std::uint64_t{1} << camera;
    }
    if (cameras == 0) break;
    for (std::size_t camera = 0; camera < count; ++camera) next[camera] += cameras >> camera & 1u;
    instants.add(t_ns, cameras);
  }
  instants.finish();
  return frames;
}

std::vector<std::int64_t> join_triggered_images(std::vector<ImageStream>& images,
                                                double tolerance_s) {
  std::vector<std::int64_t> after_ns(images.size(), 0);
  for (std::size_t c = 1; c < images.size(); ++c)
    after_ns[c] = images[c].shifted_ns - images.front().shifted_ns;
  if (std::all_of(after_ns.begin(), after_ns.end(), [](std::int64_t t) { return t == 0; }))
    return after_ns;
  const auto shift_all = [&](std::int64_t sign) {
    for (std::size_t c = 0; c < images.size(); ++c) images[c].shift(sign * after_ns[c]);
  };
  constexpr std::size_t kPercent = 90;  // at the ends a pairing may lose an image
  const std::size_t instants = index_frames(images, tolerance_s).stamps_ns.size();
  shift_all(-1);
  if (100 * index_frames(images, tolerance_s).stamps_ns.size() < kPercent * instants)
    return after_ns;
  shift_all(1);
  return std::vector<std::int64_t>(images.size(), 0);
}

void warn_of_unpaired_cameras(const std::vector<ImageStream>& images,
                              double tolerance_s,
                              ProblemList& problems) {
  constexpr std::size_t kFewest = 3;
  const auto first = std::find_if(images.begin(), images.end(),
                                  [](const auto& stream) { return !stream.stamps_ns.empty(); });
  if (first == images.end()) return;
  const std::int64_t tolerance_ns = pairing_tolerance_ns(images, tolerance_s);
  for (auto other = first + 1; other != images.end(); ++other) {
    if (other->stamps_ns.empty() || !(first->summary.rate_hz > 0.0)) continue;
    // Of a slower camera each image has its partner.
    const bool fewer = other->stamps_ns.size() <= first->stamps_ns.size();
    const double rate_hz = std::max(first->summary.rate_hz, other->summary.rate_hz);
    Stagger stagger =
        stagger_of((fewer ? other : first)->stamps_ns, (fewer ? first : other)->stamps_ns,
                   tolerance_ns, 0.51e9 / rate_hz);
    auto& apart = stagger.apart_ns;
    if (apart.size() < kFewest || 10 * apart.size() < stagger.images) continue;
    std::nth_element(apart.begin(), apart.begin() + static_cast<std::ptrdiff_t>(apart.size() / 2),
                     apart.end());
    const std::int64_t median = apart[apart.size() / 2];
    const bool later = (median > 0) == fewer;
    const auto name = [](const ImageStream& stream) {
      return stream.folder.parent_path().filename().string();
    };
    problems.warning(
        (other->folder.parent_path() / "data.csv").string(), 0, "timestamp",
        std::to_string(apart.size()) + " of " + std::to_string(stagger.images) + " images about " +
            milliseconds(std::abs(static_cast<double>(median))) + (later ? " after" : " before") +
            " those of " + name(*first) + ", which makes them other instants",
        "the images of one instant within " + milliseconds(static_cast<double>(tolerance_ns)));
  }
}

void warn_of_ended_cameras(const std::vector<ImageStream>& images,
                           const FrameIndex& frames,
                           ProblemList& problems) {
  constexpr double kIntervals = 10.0;
  if (frames.stamps_ns.empty()) return;
  const std::int64_t end = frames.stamps_ns.back();
  for (const ImageStream& stream : images) {
    if (stream.stamps_ns.empty() || !(stream.summary.rate_hz > 0.0)) continue;
    const std::int64_t last = stream.stamps_ns.back();
    if (static_cast<double>(end - last) > kIntervals * 1e9 / stream.summary.rate_hz)
      problems.warning((stream.folder.parent_path() / "data.csv").string(), 0, "images",
                       "the last at " + std::to_string(last) + " ns",
                       "images until " + std::to_string(end) + " ns as other cameras have");
  }
}

}  // namespace roadbook
