#include "semantics/people/person_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <string>
#include <tuple>

#include "base/error.hpp"
#include "base/require_option.hpp"
#include "base/se3.hpp"
#include "semantics/detector/hog_scan.hpp"

namespace roadbook {
namespace {

constexpr int kStride = PersonWindow::kCell;
constexpr std::size_t kPeoplePeaks = 12;  // windows kept for each hypothesis, before suppression

template <typename T>
void suppress(std::vector<T>& found, double max_overlap, std::size_t most) {
  std::stable_sort(found.begin(), found.end(),
                   [](const T& a, const T& b) { return a.score > b.score; });
  std::vector<T> kept;
  for (const T& f : found) {
    if (kept.size() == most) break;
    const bool apart = std::all_of(kept.begin(), kept.end(), [&](const T& k) {
      return intersection_over_union(f.box, k.box) <= max_overlap;
    });
    if (apart) kept.push_back(f);
  }
  found = std::move(kept);
}

}  // namespace

void PersonSearchOptions::check() const {
  require_option(min_range_m >= 0.3, "min_range_m", min_range_m, ">= 0.3");
  require_option(max_range_m > min_range_m && max_range_m <= 100.0, "max_range_m", max_range_m,
                 "above min_range_m, to 100");
  require_option(min_height_m > 0.3, "min_height_m", min_height_m, "> 0.3");
  require_option(max_height_m > min_height_m, "max_height_m", max_height_m, "above min_height_m");
  require_option(size_step > 1.01 && size_step < 2.0, "size_step", size_step, "1.01 to 2");
  require_option(hypotheses >= 1, "hypotheses", 0.0, ">= 1");
}

PersonSearch::PersonSearch(int index,
                           const PersonCamera& camera,
                           const PersonSearchOptions& options)
    : index_(index), camera_(camera), options_(options) {
  options_.check();
  const double least = options_.min_height_m / options_.max_range_m;
  const double greatest = options_.max_height_m / options_.min_range_m;
  for (double size = least * std::sqrt(options_.size_step); size < greatest;
       size *= options_.size_step)
    strips_.push_back(make_strip(size));
  sees_ground_ = std::any_of(strips_.begin(), strips_.end(), [](const Strip& strip) {
    return std::any_of(strip.usable.begin(), strip.usable.end(), [](auto u) { return u != 0; });
  });
}

double PersonSearch::least_foot_slope(double size) const {
  return -camera_.height_m() * size / options_.min_height_m - options_.tilt_rad;
}
double PersonSearch::greatest_foot_slope(double size) const {
  return -camera_.height_m() * size / options_.max_height_m + options_.tilt_rad;
}

PersonSearch::Strip PersonSearch::make_strip(double size) const {
  constexpr double kHalfView = 1.7;  // largest azimuth from the optical axis, to either side [rad]
  Strip strip;
  strip.size = size;
  CylinderPatch& patch = strip.patch;
  patch.scale = PersonWindow::kPerson / size;
  const double highest = greatest_foot_slope(size);
  const double lowest = least_foot_slope(size);
  patch.left = camera_.heading() + kHalfView;
  patch.top = highest + (PersonWindow::kPerson + PersonWindow::kMargin - 0.5) / patch.scale;
  const auto cells = [](double px) { return kStride * static_cast<int>(std::ceil(px / kStride)); };
  patch.size = {cells(2.0 * kHalfView * patch.scale),
                cells(PersonWindow::kHeight + (highest - lowest) * patch.scale)};
  strip.octave = camera_.octave_of(patch.scale);
  cv::convertMaps(camera_.pixel_map(patch), cv::Mat(), strip.map_a, strip.map_b, CV_16SC2);
  cv::Mat sum;
  cv::integral(camera_.seen(patch) / 255, sum, CV_32S);
  strip.windows = {(patch.size.width - PersonWindow::kWidth) / kStride + 1,
                   (patch.size.height - PersonWindow::kHeight) / kStride + 1};
  const double enough = options_.min_seen * PersonWindow::kWidth * PersonWindow::kHeight;
  for (int row = 0; row < strip.windows.height; ++row)
    for (int column = 0; column < strip.windows.width; ++column) {
      const cv::Point a(column * kStride, row * kStride);
      const cv::Point b = a + cv::Point(PersonWindow::kWidth, PersonWindow::kHeight);
      const int seen = sum.at<int>(b.y, b.x) - sum.at<int>(a.y, b.x) - sum.at<int>(b.y, a.x) +
                       sum.at<int>(a.y, a.x);
      const PersonBox box = box_at(strip, column, row);
      strip.usable.push_back(seen >= enough && camera_.sees(box.azimuth, box.foot_slope) ? 1 : 0);
    }
  return strip;
}

PersonBox PersonSearch::box_at(const Strip& strip, int column, int row) const {
  const double u = kStride * column + 0.5 * (PersonWindow::kWidth - 1);
  const double v = kStride * row + PersonWindow::kMargin + PersonWindow::kPerson - 0.5;
  return {index_, wrap_angle(strip.patch.left - u / strip.patch.scale),
          strip.patch.top - v / strip.patch.scale, strip.size};
}

bool PersonSearch::reaches(const PersonBox& box) const {
  if (strips_.empty()) return false;
  const double slack = 4.0 * box.size / PersonWindow::kPerson;
  return box.size > strips_.front().size / options_.size_step &&
         box.size < strips_.back().size * options_.size_step &&
         box.foot_slope > least_foot_slope(box.size) - slack &&
         box.foot_slope < greatest_foot_slope(box.size) + slack;
}

std::optional<PersonBox> PersonSearch::random_box(Random& random) const {
  if (!sees_ground_) return std::nullopt;
  for (;;) {
    const Strip& strip = strips_[random.below(strips_.size())];
    if (strip.usable.empty()) continue;
    const auto at = static_cast<int>(random.below(strip.usable.size()));
    if (strip.usable[static_cast<std::size_t>(at)] == 0) continue;
    return box_at(strip, at % strip.windows.width, at / strip.windows.width);
  }
}

// Climbs in azimuth, place of the feet and size with steps that halve.
PersonSearch::Scored PersonSearch::refined(const ImagePyramid& image,
                                           const GpClassifier& classifier,
                                           Scored start) const {
  const auto score = [&](const PersonBox& box) {
    return classifier.weights().dot(window_.feature(camera_, image, box)) + classifier.bias();
  };
  start.score = score(start.box);
  double step = 0.5 * kStride / PersonWindow::kPerson;  // of the size
  for (int round = 0; round < 3; ++round) {
    for (int axis = 0; axis < 3; ++axis)
      for (const double sign : {1.0, -1.0}) {
        PersonBox box = start.box;
        const double by = sign * step * box.size;
        if (axis == 0) box.azimuth = wrap_angle(box.azimuth + by);
        if (axis == 1) box.foot_slope += by;
        if (axis == 2) {
          box.size += by;
          box.foot_slope -= 0.5 * by;  // about the middle: head and feet move apart
        }
        if (!reaches(box)) continue;
        if (const double s = score(box); s > start.score) {
          start = {box, s};
          break;
        }
      }
    step *= 0.5;
  }
  return start;
}

std::vector<PersonHypothesis> PersonSearch::run(const ImagePyramid& image,
                                                const GpClassifier& classifier) const {
  ROADBOOK_ASSERT(classifier.feature_size() == PersonWindow::feature_size());
  const Eigen::MatrixXf weights = block_weights(classifier.weights());
  std::vector<Scored> found;
  for (const Strip& strip : strips_) {
    cv::Mat picture;
    cv::remap(image[static_cast<std::size_t>(strip.octave)], picture, strip.map_a, strip.map_b,
              cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar(0));
    cv::Size grid;
    const Eigen::MatrixXf blocks = window_.blocks_of(picture, grid);
    const WindowScores score =
        scan_windows(weights, classifier.bias(), PersonWindow::blocks(), blocks, grid);
    for (int row = 0; row < score.rows(); ++row)
      for (int column = 0; column < score.cols(); ++column)
        if (strip.usable[static_cast<std::size_t>(row * strip.windows.width + column)] != 0)
          found.push_back({box_at(strip, column, row), static_cast<double>(score(row, column))});
  }
  const auto peaks = std::min(found.size(), kPeoplePeaks * options_.hypotheses);
  std::partial_sort(found.begin(), found.begin() + static_cast<std::ptrdiff_t>(peaks), found.end(),
                    [](const Scored& a, const Scored& b) {
                      if (a.score != b.score) return a.score > b.score;
                      return std::tie(a.box.size, a.box.azimuth, a.box.foot_slope) <
                             std::tie(b.box.size, b.box.azimuth, b.box.foot_slope);
                    });
  found.resize(peaks);
  // Boxes that overlap a little may part when they are refined.
  suppress(found, std::max(0.4, options_.max_overlap), options_.hypotheses);
  for (Scored& f : found) f = refined(image, classifier, f);
  suppress(found, options_.max_overlap, options_.hypotheses);
  std::vector<PersonHypothesis> hypotheses;
  for (const Scored& f : found)
    hypotheses.push_back({f.box, classifier.predict(window_.feature(camera_, image, f.box))});
  return hypotheses;
}

}  // namespace roadbook
