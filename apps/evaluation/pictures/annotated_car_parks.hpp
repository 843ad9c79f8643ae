#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "semantics/oriented_box.hpp"
#include "semantics/overhead/ground_image.hpp"

namespace roadbook {

/// Real pictures of the ground with annotations of the objects that a detector shall find.
struct AnnotatedCarPark {
  std::string name;   ///< of the car park, or of a day or part of it
  GroundImage image;  ///< its pictures, side by side, with unseen ground between them
  std::vector<OrientedBox> spaces;
};

/// Reads around-view frames of a car with marking points in LabelMe XML (192 x 600). Each car park
/// gives two lots, from the first and the second half of the drive. A lot contains both sides of
/// the car. Each side has at most `frames` evenly spaced frames.
///
/// A marking point is the place where the line between two spaces meets the aisle. The frames end
/// shortly behind it. The detector shall find the mouth of a space: the region between two
/// neighbouring points, from 1.2 m inside the space to 0.8 m outside. The frames have no scale. The
/// function assumes that the median mouth is 2.4 m wide. Pixels that are black in all frames show
/// the own car and count as unseen.
[[nodiscard]] std::vector<AnnotatedCarPark> psv_annotations(const std::filesystem::path& folder,
                                                            int frames);

/// Reads a car park seen by a camera on a roof, in PKLot's XML (`SEQUENCE/frames`,
/// `bounding_boxes`). Each sequence gives two lots: each picture is divided between the rows of
/// spaces.
///
/// The outlines determine the view of the ground (fit_ground_view). The function rectifies the
/// pictures to the ground, 0.05 m per pixel. Upright objects such as cars appear stretched away
/// from the camera, as in any overhead image.
[[nodiscard]] std::vector<AnnotatedCarPark> pklot_annotations(const std::filesystem::path& folder);

/// Reads the kind of data that `folder` contains. Throws BadInput if it contains neither kind.
[[nodiscard]] std::vector<AnnotatedCarPark> read_annotated_car_parks(
    const std::filesystem::path& folder, bool quick);

/// Joins pictures of the ground to one picture, side by side in rows of `columns`, with `gap_m` of
/// unseen ground between them. The boxes move with their pictures. `corner` is the place of pixel
/// (column, row).
[[nodiscard]] AnnotatedCarPark side_by_side(const std::vector<AnnotatedCarPark>& pictures,
                                            int columns,
                                            double gap_m);

}  // namespace roadbook
