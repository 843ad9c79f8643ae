#include "diagnosis/views/wheel_variations.hpp"

#include <array>
#include <string>
#include <string_view>

#include "diagnosis/views/view_basis.hpp"

namespace roadbook {
namespace {

struct Varied {
  std::string_view name;
  std::string_view column;
  std::string_view itself =
      "speed squared";  ///< covariate that turns the column into the effect itself
};
// Late images are equivalent to early wheels.
constexpr std::array<Varied, 10> kVaried{{{"wheels0.radius", "radius"},
                                          {"wheels0.left_radius", "radius"},
                                          {"wheels0.right_radius", "radius"},
                                          {"wheels0.radius_speed", "radius", "speed"},
                                          {"wheels0.slip_acceleration", "radius", "acceleration"},
                                          {"wheels0.eccentricity", "radius"},
                                          {"wheels0.radius_difference", "track_width"},
                                          {"wheels0.track_width", "track_width"},
                                          {"wheels0.latency", "latency"},
                                          {"cam.latency", "latency"}}};

}  // namespace

std::vector<Candidate> wheel_variations(const Candidate& name) {
  std::vector<Candidate> terms;
  for (const Varied& varied : kVaried)
    for (std::size_t v = 0; v < kWheelVariations.size() && name.name == varied.name; ++v) {
      const WheelVariation& variation = kWheelVariations[v];
      if (variation.column != varied.column || variation.covariate == varied.itself) continue;
      Candidate term;
      term.kind = CandidateKind::kGrammar;
      term.hook = "wheels0." + std::string(variation.column);
      term.covariate = variation.covariate;
      term.name = name.name + " ~ " + term.covariate;
      term.unit = name.unit;
      term.effect = v;
      term.tau = name.tau;
      term.has_mean = false;
      terms.push_back(term);
    }
  return terms;
}

}  // namespace roadbook
