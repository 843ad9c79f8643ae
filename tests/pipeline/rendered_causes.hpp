#pragma once

#include <filesystem>
#include <string>

namespace roadbook::test {

/// Expects of a rendered drive without effects that diagnosis through its map finds the bend that
/// the place was built with and nothing else.
void expect_nothing_but_the_hinge(const std::filesystem::path& drive,
                                  const std::filesystem::path& map);

/// States in the calibration of `drive` that camera 1 has a focal length 1 % shorter than it has.
void shorten_focal_length(const std::filesystem::path& drive);

/// Expects that diagnosis of a rendered drive through its map finds only `effect` with `size`, in
/// addition to the place's own bend.
void expect_cause(const std::filesystem::path& drive,
                  const std::filesystem::path& map,
                  const std::string& effect,
                  double size);

}  // namespace roadbook::test
