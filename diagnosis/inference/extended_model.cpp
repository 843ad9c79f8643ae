#include "diagnosis/inference/extended_model.hpp"

#include <algorithm>
#include <array>

namespace roadbook {
namespace {

constexpr const char* kNoPlaces =
    "not written with --write-model: a model stores no place for this effect";
constexpr const char* kOnePlace =
    "not written with --write-model: a model stores one place per effect";
constexpr std::array kWithoutPlace{"wheels0.wet_patch", "friction0.extra_class"};

// Noise that the simulation has: not that of reference poses, which are exact there, nor of views.
bool is_simulated(const FoundCause& noise) {
  if (noise.effect == "friction0.spatial_bias") return true;
  const auto dot = noise.effect.find('.');
  const std::string stream = noise.effect.substr(0, dot);
  if (stream.starts_with("cam") || stream == "poses") return false;
  const std::string kind = "STREAM" + noise.effect.substr(dot);
  const auto effects = noise_effects();
  return std::any_of(effects.begin(), effects.end(), [&](const EffectInfo& e) {
    return e.name == kind && noise.size >= e.lowest && noise.size <= e.highest;
  });
}

// Of the vehicle, in what sensors read or in their noise; not those of one drive of several.
bool is_of_model(const FoundCause& cause) {
  return cause.session.empty() && (!cause.noise || is_simulated(cause));
}

bool has_no_place(const std::string& effect) {
  return std::find(kWithoutPlace.begin(), kWithoutPlace.end(), effect) != kWithoutPlace.end();
}

// Of the places of one name the one that a model keeps: where the known one lies, else the one with
// the most evidence; nullptr: the effect was found in no place.
FoundCause* kept_place(Diagnosis& d, const std::string& effect) {
  FoundCause* kept = nullptr;
  for (FoundCause& c : d.causes) {
    if (c.effect != effect || !c.in_place || !is_of_model(c)) continue;
    const auto rank = [](const FoundCause& one) { return std::pair(one.at_known, one.evidence); };
    if (kept == nullptr || rank(c) > rank(*kept)) kept = &c;
  }
  return kept;
}

void leave_out(const char* why, FoundCause& cause) {
  if (cause.note.find(why) != std::string::npos) return;
  cause.note += (cause.note.empty() ? "" : "; ") + std::string(why);
}

}  // namespace

void extend_model(Diagnosis& d) {
  for (FoundCause& c : d.causes) {
    if (!is_of_model(c)) continue;
    if (has_no_place(c.effect))
      leave_out(kNoPlaces, c);
    else if (c.in_place && &c != kept_place(d, c.effect))
      leave_out(kOnePlace, c);
    else
      d.extended[c.effect] += c.size;
  }
}

void note_without_place(const EffectSizes& known, const std::string& stream, Diagnosis& d) {
  for (const auto& [effect, size] : known)
    if (effect.starts_with(stream) && has_no_place(effect) && size != 0.0)
      d.notes.push_back(effect +
                        " of the known model has no place: no reading was corrected for it");
}

void add_known(const EffectSizes& known, Diagnosis& d) {
  for (const auto& [effect, size] : known) {
    FoundCause* place = kept_place(d, effect);
    if (place != nullptr && !place->at_known) {
      if (!has_no_place(effect)) leave_out(kOnePlace, *place);
      d.extended[effect] = size;
    } else {
      d.extended[effect] += size;
    }
  }
  note_without_place(known, "wheels0.", d);
}

}  // namespace roadbook
