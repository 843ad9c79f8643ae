#pragma once

#include <filesystem>
#include <string>

namespace roadbook::test {

/// Expects that diagnosis of a rendered drive without effects, through its map, finds only the
/// place's own bend.
void expect_nothing_but_the_hinge(const std::filesystem::path& drive,
                                  const std::filesystem::path& map);

/// Changes the calibration of `drive`: the focal length of camera 1 becomes 1 % too short.
void shorten_focal_length(const std::filesystem::path& drive);

/// Expects that diagnosis of a rendered drive through its map finds only `effect` with `size`, in
/// addition to the place's own bend.
void expect_cause(const std::filesystem::path& drive,
                  const std::filesystem::path& map,
                  const std::string& effect,
                  double size);

}  // namespace roadbook::test
