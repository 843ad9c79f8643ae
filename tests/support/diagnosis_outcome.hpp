#pragma once

#include <cstdint>
#include <cstdio>
#include <ctime>
#include <map>
#include <string>

#include "diagnosis/inference/findings.hpp"

namespace roadbook::test {

/// Processor time of this thread.
inline double thread_seconds() {
  std::timespec t{};
  ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// A line of a study: what was hidden, how strongly it shows, and all that was found.
inline std::string outcome_line(std::uint64_t seed,
                                const std::map<std::string, double>& hidden,
                                double strength,
                                const Diagnosis& found) {
  char text[200];
  std::string line = "seed " + std::to_string(seed) + ", hidden:";
  for (const auto& [name, size] : hidden) {
    std::snprintf(text, sizeof text, " %s %.4g", name.c_str(), size);
    line += text;
  }
  std::snprintf(text, sizeof text, " (strength %.1f); found:", strength);
  line += text;
  for (const FoundCause& c : found.causes) {
    std::snprintf(text, sizeof text, " %s %.4g [%.4g, %.4g] gain %.1f", c.effect.c_str(), c.size,
                  c.low, c.high, c.gain.total);
    line += text;
    for (const std::string& other : c.inseparable) line += " ~" + other;
    line += ";";
  }
  for (const UnknownCause& u : found.unknown) {
    std::snprintf(text, sizeof text, " unknown %s.%s ~ %s gain %.1f;", u.stream.c_str(),
                  u.hook.c_str(), u.depends_on.c_str(), u.gain.total);
    line += text;
  }
  for (const std::string& u : found.unexplained) line += " unexplained " + u + ";";
  return line;
}

}  // namespace roadbook::test
