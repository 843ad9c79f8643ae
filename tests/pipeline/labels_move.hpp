#pragma once

#include <filesystem>

namespace roadbook::test {

// Tests labels on maps of a simulated drive against the truth of the drive. The labels are drawn as
// a user draws them: at the place that the overhead image shows. They thus have the error of the
// poses that made the image, and a drawing error.

/// A map of the first part of the drive is bent by a wrong wheel radius in the calibration, and
/// gets labels. The rest of the drive returns to the start and corrects the map. The errors of the
/// moved labels are at most 1.1 times the errors of labels drawn on the corrected map.
void expect_labels_of_a_bent_map_to_be_mended(const std::filesystem::path& drive,
                                              const std::filesystem::path& folder);

/// Coverage: the 95 % ellipses of 1000 labels drawn on the map contain 930 to 970 of the true
/// places.
void expect_ellipses_to_hold_their_truth(const std::filesystem::path& drive,
                                         const std::filesystem::path& map);

}  // namespace roadbook::test
