#pragma once

// Switches of deliberate faults. tests/mutation/run.py includes this header in the files that it
// changes, in a copy of the sources; the product never includes it.
//
// ROADBOOK_MUTANT=17 switches fault 17 on. ROADBOOK_MUTANT_TRACE=FILE switches none on, and each
// process appends the numbers of the switches that it asks to FILE, each number once. Child
// processes inherit both.

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdlib>
#include <string>

// A fault may cause warnings of the compiler. They are not a reason to refuse it.
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wfloat-conversion"
#pragma GCC diagnostic ignored "-Wint-in-bool-context"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#pragma GCC diagnostic ignored "-Wparentheses"
#pragma GCC diagnostic ignored "-Wreturn-type"
#pragma GCC diagnostic ignored "-Wsign-compare"
#pragma GCC diagnostic ignored "-Wtype-limits"

namespace mutation {

constexpr int kTraced = -1;

inline int chosen() {
  static const int number = [] {
    if (std::getenv("ROADBOOK_MUTANT_TRACE") != nullptr) return kTraced;
    const char* text = std::getenv("ROADBOOK_MUTANT");
    return text == nullptr ? 0 : std::atoi(text);
  }();
  return number;
}

inline void trace(int number) {
  static std::array<std::atomic<bool>, 4096> seen{};
  if (seen.at(static_cast<std::size_t>(number)).exchange(true)) return;
  const std::string line = std::to_string(number) + "\n";
  const int file =
      ::open(std::getenv("ROADBOOK_MUTANT_TRACE"), O_WRONLY | O_APPEND | O_CREAT | O_CLOEXEC, 0644);
  if (file < 0) return;
  if (::write(file, line.data(), line.size()) < 0) std::abort();
  ::close(file);
}

/// Whether the fault of this number is switched on; numbers start at 1.
inline bool on(int number) {
  const int now = chosen();
  if (now == kTraced) [[unlikely]]
    trace(number);
  return now == number;
}

}  // namespace mutation
