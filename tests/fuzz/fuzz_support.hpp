#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"

namespace roadbook::fuzz {

// What the fuzz targets share. A parser may refuse its input with roadbook's own exceptions; any
// other exception, a failed assertion, a leak or a run of more than the allowed time is a finding.

namespace fs = std::filesystem;

/// A folder in memory for the files of one process.
inline const fs::path& work_folder() {
  static const fs::path folder = [] {
    fs::path base = fs::is_directory("/dev/shm") ? "/dev/shm" : fs::temp_directory_path();
    base /= "roadbook_fuzz_" + std::to_string(::getpid());
    fs::create_directories(base);
    static fs::path remembered;
    remembered = base;
    std::atexit([] {
      std::error_code ignored;
      fs::remove_all(remembered, ignored);
    });
    return base;
  }();
  return folder;
}

inline void put(const fs::path& file, std::string_view bytes) {
  fs::create_directories(file.parent_path());
  std::FILE* const out = std::fopen(file.c_str(), "wb");
  if (out == nullptr) std::abort();
  std::fwrite(bytes.data(), 1, bytes.size(), out);
  std::fclose(out);
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// The parts of the input between lines of "====".
inline std::vector<std::string_view> parts_of(std::string_view text, std::size_t count) {
  constexpr std::string_view kBetween = "====\n";
  std::vector<std::string_view> parts;
  while (parts.size() + 1 < count) {
    const auto at = text.find(kBetween);
    parts.push_back(text.substr(0, at));
    text.remove_prefix(at == std::string_view::npos ? text.size() : at + kBetween.size());
  }
  parts.push_back(text);
  return parts;
}

/// Runs `parse`; what it refuses on purpose is no finding.
template <typename Parse>
int try_parse(const Parse& parse) {
  try {
    parse();
  } catch (const Error&) {
  }
  return 0;
}

}  // namespace roadbook::fuzz
