#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "semantics/oriented_box.hpp"
#include "semantics/overhead/ground_image.hpp"

namespace roadbook {

/// Real pictures of the ground in which somebody has marked what a detector should find.
struct AnnotatedCarPark {
  std::string name;   ///< of the car park, or of a day or part of it
  GroundImage image;  ///< its pictures, side by side, unseen ground between them
  std::vector<OrientedBox> spaces;
};

/// Around-view frames of a car with marking points in LabelMe XML (192 x 600): two lots a car park,
/// of the first and the second half of the drive, both sides of the car together; at most `frames`
/// evenly spaced ones of each side.
///
/// A marking point is where the line between two spaces meets the aisle; the frames end soon behind
/// it. What is to be found is the mouth of a space: as wide as two neighbouring points are apart,
/// 1.2 m into the space, 0.8 m out of it. The frames have no scale of their own: the median mouth
/// is taken to be 2.4 m wide. Pixels that are black in all frames are the own car: unseen.
[[nodiscard]] std::vector<AnnotatedCarPark> psv_annotations(const std::filesystem::path& folder,
                                                            int frames);

/// A car park that a camera on a roof sees, in PKLot's XML (`SEQUENCE/frames`, `bounding_boxes`):
/// one lot for each sequence and half of it (every picture split between the rows of spaces).
///
/// The outlines tell how the camera sees the ground (fit_ground_view); the pictures are rectified
/// to it, 0.05 m a pixel. What stands up, cars above all, is drawn out away from the camera, as
/// in any overhead image.
[[nodiscard]] std::vector<AnnotatedCarPark> pklot_annotations(const std::filesystem::path& folder);

/// Whichever of the two `folder` holds. Throws BadInput where it holds neither.
[[nodiscard]] std::vector<AnnotatedCarPark> read_annotated_car_parks(
    const std::filesystem::path& folder, bool quick);

/// A picture of the ground whose pixel (column, row) is at `corner`, and boxes on it, onto one
/// sheet with others: side by side in rows of `columns`, `gap_m` of unseen ground between.
[[nodiscard]] AnnotatedCarPark side_by_side(const std::vector<AnnotatedCarPark>& pictures,
                                            int columns,
                                            double gap_m);

}  // namespace roadbook
