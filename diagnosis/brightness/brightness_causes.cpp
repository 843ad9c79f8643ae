#include "diagnosis/brightness/brightness_causes.hpp"

#include <set>

#include "sensors/effects.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kEnds = 3;  // instants excluded at either end: too few samples to decide
constexpr std::size_t kMostSteps = 60;  // for one camera

BrightnessCause cause_of(BrightnessKind kind, const std::string& owner, int camera) {
  const char* effect = kind == BrightnessKind::kVignetting ? ".vignetting"
                       : kind == BrightnessKind::kExposure ? ".exposure"
                                                           : ".exposure_step";
  BrightnessCause cause;
  cause.name = owner + effect;
  cause.kind = kind;
  cause.camera = camera;
  for (const EffectInfo& info : camera_effects())
    if (info.name == std::string("cam") + effect) {
      cause.unit = info.unit;
      cause.tau = info.plausible;
    }
  return cause;
}

// Times between neighbouring instants with images.
std::vector<double> step_times(const std::vector<BrightnessSample>& samples) {
  std::set<double> instants;
  for (const BrightnessSample& s : samples) instants.insert(s.t_s);
  const std::vector<double> t(instants.begin(), instants.end());
  std::vector<double> times;
  for (std::size_t i = kEnds; i + kEnds < t.size(); i += 1 + t.size() / kMostSteps)
    times.push_back(0.5 * (t[i - 1] + t[i]));
  return times;
}

}  // namespace

std::vector<BrightnessCause> brightness_causes(const std::vector<std::string>& cameras,
                                               const std::vector<BrightnessSample>& samples) {
  const std::vector<double> times = step_times(samples);
  std::vector<BrightnessCause> causes;
  for (const BrightnessKind kind :
       {BrightnessKind::kVignetting, BrightnessKind::kExposure, BrightnessKind::kStep})
    for (int c = -1; c < static_cast<int>(cameras.size()); ++c) {
      if (c < 0 && cameras.size() == 1) continue;
      const std::string owner = c < 0 ? "cam" : cameras[static_cast<std::size_t>(c)];
      for (std::size_t i = 0; i < (kind == BrightnessKind::kStep ? times.size() : 1); ++i) {
        causes.push_back(cause_of(kind, owner, c));
        if (kind == BrightnessKind::kStep) causes.back().from_s = times[i];
      }
    }
  return causes;
}

}  // namespace roadbook
