#pragma once

#include <cstdint>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <string>

namespace roadbook::test {

// The seed is the date, or ROADBOOK_HIDDEN_SEED to repeat a failure. It is printed once a program.
inline std::uint64_t seed_of_today() {
  static const std::uint64_t seed = [] {
    const char* given = std::getenv("ROADBOOK_HIDDEN_SEED");
    const std::uint64_t today = static_cast<std::uint64_t>(std::time(nullptr) / 86400);
    const std::uint64_t drawn = given ? std::stoull(given) : today;
    std::cout << "ROADBOOK_HIDDEN_SEED=" << drawn << "\n";
    return drawn;
  }();
  return seed;
}

}  // namespace roadbook::test
