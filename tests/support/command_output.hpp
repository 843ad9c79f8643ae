#pragma once

#include <array>
#include <cstdio>
#include <string>

namespace roadbook::test {

/// What a shell command prints, errors included; `status` as pclose gives it.
inline std::string output_of(const std::string& command, int* status = nullptr) {
  std::string text;
  std::FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  std::array<char, 4096> buffer{};
  while (std::fgets(buffer.data(), buffer.size(), pipe) != nullptr) text += buffer.data();
  const int result = pclose(pipe);
  if (status != nullptr) *status = result;
  return text;
}

}  // namespace roadbook::test
