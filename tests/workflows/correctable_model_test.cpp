#include "workflows/diagnosis/correctable_model.hpp"

#include <gtest/gtest.h>

#include "sensors/correction.hpp"

namespace roadbook {
namespace {

Diagnosis found(const std::string& effect, double size, const EffectSizes& instead) {
  Diagnosis d;
  FoundCause& c = d.causes.emplace_back();
  c.effect = effect;
  c.size = size;
  for (const auto& entry : instead) c.inseparable.push_back(entry.first);
  c.instead = instead;
  d.extended[effect] = size;
  return d;
}

TEST(CorrectableModel, HasTheCamerasWhereTheGroundLooksTheSame) {
  const Diagnosis height = found("ground.height", -0.04, {{"cam.height", 0.041}});
  EXPECT_EQ(correctable_model(height), (EffectSizes{{"cam.height", 0.041}}));
  const Diagnosis slope = found("ground.slope", 0.01, {{"rig.pitch", -0.011}});
  EXPECT_EQ(correctable_model(slope), (EffectSizes{{"rig.pitch", -0.011}}));
  EXPECT_TRUE(not_corrected(correctable_model(slope)).empty());
}

TEST(CorrectableModel, KeepsWhatWasKnownAndWhatOnlyTheGroundExplains) {
  Diagnosis known = found("ground.height", -0.04, {{"cam.height", 0.04}});
  known.extended["ground.height"] -= 0.01;
  const EffectSizes model = correctable_model(known);
  EXPECT_NEAR(model.at("ground.height"), -0.01, 1e-12);
  EXPECT_EQ(model.at("cam.height"), 0.04);
  const Diagnosis alone = found("ground.slope", 0.01, {});
  EXPECT_EQ(correctable_model(alone), alone.extended);
  const Diagnosis late = found("cam1.latency", 0.01, {{"cam.height", 0.04}});
  EXPECT_EQ(correctable_model(late), late.extended);
}

}  // namespace
}  // namespace roadbook
