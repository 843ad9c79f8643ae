#pragma once

#include <filesystem>

namespace roadbook::test {

// Labels on maps that the program makes of a simulated drive, judged by the drive's truth. They are
// drawn as a person does: where the picture of the ground shows a place, which is as far off as the
// poses that it is made of, and with a hand's error.

/// A map of the drive's beginning, bent by a wheel that is not what its calibration says, gets
/// labels; the rest of the drive comes back to where it was and mends the map. The labels that went
/// along lie at most 1.1 times as far off as ones that are drawn on the mended map.
void expect_labels_of_a_bent_map_to_be_mended(const std::filesystem::path& drive,
                                              const std::filesystem::path& folder);

/// The 95 % ellipses of 1000 labels drawn on the map hold 930 to 970 of their true places.
void expect_ellipses_to_hold_their_truth(const std::filesystem::path& drive,
                                         const std::filesystem::path& map);

}  // namespace roadbook::test
