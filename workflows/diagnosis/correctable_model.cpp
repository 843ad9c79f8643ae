#include "workflows/diagnosis/correctable_model.hpp"

#include <array>
#include <cmath>
#include <string>

namespace roadbook {
namespace {

struct GroundAndCameras {
  const char* ground;
  const char* cameras;
};
constexpr std::array kAlike{GroundAndCameras{"ground.height", "cam.height"},
                            GroundAndCameras{"ground.slope", "rig.pitch"}};

}  // namespace

EffectSizes correctable_model(const Diagnosis& d) {
  EffectSizes model = d.extended;
  for (const FoundCause& c : d.causes)
    for (const auto& [ground, cameras] : kAlike) {
      const auto instead = c.instead.find(cameras);
      if (!c.session.empty() || c.effect != ground || instead == c.instead.end() ||
          !model.contains(ground))
        continue;
      constexpr double kNothingLeft = 1e-12;
      model[cameras] += instead->second;
      model[ground] -= c.size;  // a size that was known before stays
      if (std::abs(model[ground]) < kNothingLeft) model.erase(ground);
    }
  return model;
}

}  // namespace roadbook
