#include "apps/evaluation/pictures/annotated_car_parks.hpp"

#include <algorithm>

#include "base/error.hpp"

namespace roadbook {

AnnotatedCarPark side_by_side(const std::vector<AnnotatedCarPark>& pictures,
                              int columns,
                              double gap_m) {
  AnnotatedCarPark sheet;
  const double pixel_m = pictures.front().image.resolution_m;
  cv::Size cell(0, 0);
  for (const AnnotatedCarPark& p : pictures)
    cell = {std::max(cell.width, p.image.grey.cols), std::max(cell.height, p.image.grey.rows)};
  const auto gap = static_cast<int>(gap_m / pixel_m);
  cell += cv::Size(gap, gap);
  const auto count = static_cast<int>(pictures.size());
  const int rows = (count + columns - 1) / columns;
  GroundImage& image = sheet.image;
  image.grey = cv::Mat::zeros(rows * cell.height, std::min(columns, count) * cell.width, CV_8U);
  image.seen = cv::Mat::zeros(image.grey.size(), CV_8U);
  image.resolution_m = pixel_m;
  for (int i = 0; i < count; ++i) {
    const AnnotatedCarPark& p = pictures[static_cast<std::size_t>(i)];
    const cv::Rect place(cv::Point(i % columns * cell.width, i / columns * cell.height),
                         p.image.grey.size());
    p.image.grey.copyTo(image.grey(place));
    p.image.seen.copyTo(image.seen(place));
    const Eigen::Vector2d shift =
        pixel_m * Eigen::Vector2d(place.x, -place.y) + image.corner - p.image.corner;
    for (OrientedBox box : p.spaces) {
      box.centre += shift;
      sheet.spaces.push_back(box);
    }
  }
  return sheet;
}

std::vector<AnnotatedCarPark> read_annotated_car_parks(const std::filesystem::path& folder,
                                                       bool quick) {
  if (!std::filesystem::is_directory(folder))
    throw BadInput(Problem{Severity::kError, folder.string(), 0, "", "no folder",
                           "one with annotated pictures"});
  constexpr int kFrames = 30;
  std::vector<AnnotatedCarPark> lots = pklot_annotations(folder);
  if (lots.empty()) lots = psv_annotations(folder, quick ? kFrames / 3 : kFrames);
  if (lots.size() < 2)
    throw BadInput(Problem{Severity::kError, folder.string(), 0, "",
                           std::to_string(lots.size()) + " annotated car parks",
                           "two or more: PKLot's folders (SEQUENCE/frames, bounding_boxes) or "
                           "around-view frames with marking points (NAME_L, NAME_L_xml)"});
  return lots;
}

}  // namespace roadbook
