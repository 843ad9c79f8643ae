#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace roadbook {

// Files of a folder in the order of the numbers in their names: as text, 10.png would come before
// 2.png.

/// Whether `a` comes before `b`: letters compare as text (capitals as small letters), runs of
/// digits as numbers of any length. Digits behind "digits." are decimals ("1.5" before "1.25" is
/// false). Names that differ only in leading zeros or capitals are equal.
[[nodiscard]] bool precedes_by_number(std::string_view a, std::string_view b);

/// The name with each run of digits as one '#', in small letters: "Frame_012" gives "frame_#".
[[nodiscard]] std::string name_pattern(std::string_view name);

/// Number of a frame in a file's name without extension: the last run of digits. Empty where the
/// name has no digits, or where the number exceeds 64 bits.
[[nodiscard]] std::optional<std::int64_t> frame_number(const std::filesystem::path& file);

/// Files with one of the extensions (".png"; capitals count as small letters) in the order of
/// their numbers.
[[nodiscard]] std::vector<std::filesystem::path> files_in(const std::filesystem::path& folder,
                                                          std::span<const std::string> extensions);

/// The PNG and JPEG files of a folder in the order of their numbers. Throws BadInput where the
/// order is not certain: two names with the same number (1.png and 01.png), or names of different
/// patterns (a1.png and b2.png).
[[nodiscard]] std::vector<std::filesystem::path> image_files(const std::filesystem::path& folder);

/// How many PNG and JPEG files a folder has.
[[nodiscard]] std::size_t count_images(const std::filesystem::path& folder);

}  // namespace roadbook
