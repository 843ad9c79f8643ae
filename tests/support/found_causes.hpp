#pragma once

#include <string>

#include "diagnosis/inference/findings.hpp"

namespace roadbook::test {

// Standard error of a size, from its 95 % interval.
inline double sigma_of(const FoundCause& c) { return (c.high - c.low) / (2.0 * 1.96); }

// The first effect of that name; null if it was not found.
inline const FoundCause* cause_named(const Diagnosis& d, const std::string& effect) {
  for (const FoundCause& c : d.causes)
    if (c.effect == effect) return &c;
  return nullptr;
}

// What several drives together were found to have, for the message of a failure.
inline std::string told(const Diagnosis& d) {
  std::string text;
  for (const FoundCause& c : d.causes)
    text += c.effect + (c.session.empty() ? "" : " in " + c.session) + " = " +
            std::to_string(c.size) + " (" + std::to_string(c.low) + " to " +
            std::to_string(c.high) + "); ";
  for (const UnknownCause& u : d.unknown) text += "unknown " + u.hook + " ~ " + u.depends_on + "; ";
  return text;
}

}  // namespace roadbook::test
