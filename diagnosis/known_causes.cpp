#include "diagnosis/known_causes.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/extended_model.hpp"
#include "diagnosis/score_table.hpp"

namespace roadbook {
namespace {

constexpr double kSurelyBeyond = 0.01;

void note_beyond(FoundCause& cause) {
  cause.note += (cause.note.empty() ? "" : "; ") + std::string("beyond what the model knows");
}

// What is left of a cause beside its known size.
void become_difference(double known, double tests, FoundCause& cause) {
  const double sigma = std::max((cause.high - cause.low) / (2.0 * kSigmas95), 1e-300);
  cause.size -= known;
  cause.low -= known;
  cause.high -= known;
  const double z = cause.size / sigma;
  cause.p = std::min(1.0, tests * chi_squared_tail(z * z, 1));
  cause.evidence = 0.5 * z * z - std::log(tests);
  cause.gain = gain_of_large_samples(z);
  note_beyond(cause);
}

}  // namespace

void note_beyond_known(const EffectSizes& known, Diagnosis& found) {
  for (FoundCause& cause : found.causes)
    if (cause.noise && known.contains(cause.effect)) note_beyond(cause);
}

void take_off_known(const EffectSizes& known, Diagnosis& found) {
  const double tests = static_cast<double>(std::max<std::size_t>(1, found.looked_for.size()));
  std::erase_if(found.causes, [&](FoundCause& cause) {
    const auto size = known.find(cause.effect);
    // What is known without its place may be any of the places found.
    if (size == known.end() || cause.in_place) return false;
    become_difference(size->second, tests, cause);
    return cause.p >= kSurelyBeyond;
  });
  const auto is_judged = [&](const std::string& effect) {
    const auto& names = found.looked_for;
    return holds(names, effect) || found.extended.contains(effect);
  };
  const auto is_judged_of = [&](const char* stream) {
    return std::any_of(found.looked_for.begin(), found.looked_for.end(),
                       [&](const std::string& name) { return name.starts_with(stream); });
  };
  for (const auto& [effect, size] : known)
    if (is_judged(effect)) found.extended[effect] = size;
  for (const FoundCause& cause : found.causes)
    if (known.contains(cause.effect) && cause.session.empty() && !cause.in_place)
      found.extended[cause.effect] += cause.size;
  if (is_judged_of("friction0.")) note_without_place(known, "friction0.", found);
}

}  // namespace roadbook
