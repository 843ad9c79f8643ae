#include <array>

#include "sensors/effects.hpp"

namespace roadbook {
namespace {

constexpr std::array kReadingEffects{
    EffectInfo{"detector.range", "1/m", 0.2, -2.0, 2.0, "range",
               "log odds of finding somebody fall by this per metre from the camera"},
    EffectInfo{"detector.foot_point", "m", 0.2, -5.0, 5.0, "line of sight",
               "feet are placed this much farther from the camera"},
    EffectInfo{"friction0.slip_bias", "1", 0.1, -2.0, 2.0, "slip",
               "friction read, relative, in proportion to the share of it that is in use"},
    EffectInfo{"friction0.speed_bias", "s/m", 0.01, -0.1, 0.1, "speed",
               "friction read, per m/s of speed"},
    EffectInfo{"friction0.drying", "1/s", 1e-4, -0.01, 0.01, "time",
               "friction of wet ground grows by this each second of the drive"},
    EffectInfo{"friction0.temperature", "1/K", 0.005, -0.1, 0.1, "temperature",
               "friction read, per kelvin above 20 degrees Celsius"},
    EffectInfo{"friction0.extra_class", "1", 0.2, -1.0, 1.0, "place",
               "friction of a surface taken for another, less that of the other"},
    EffectInfo{"friction0.spatial_bias", "1", 0.05, 0.0, 1.0, "place",
               "standard deviation of a bias that changes from place to place"},
    EffectInfo{"range0.bias", "m", 0.3, -50.0, 50.0, "", "added to ranges to beacons"},
    EffectInfo{"range0.scale", "1", 0.02, -0.5, 1.0, "range", "ranges to beacons read, relative"},
    EffectInfo{"range0.short", "1", 0.1, 0.0, 1.0, "", "share of readings short of the target"},
    EffectInfo{"range0.maximum", "1", 0.1, 0.0, 1.0, "", "share of readings at the maximum"},
    EffectInfo{"range0.crosstalk", "1", 0.1, 0.0, 1.0, "",
               "share of readings of another sensor's pulse, anywhere up to the maximum"},
};

constexpr std::array kNoiseEffects{
    EffectInfo{"STREAM.outliers", "1", 0.05, 0.0, 1.0, "",
               "share of readings whose noise is ten times as large"},
    EffectInfo{
        "STREAM.variance(speed)", "s/m", 0.5, -5.0, 5.0, "speed",
        "logarithm of the noise's variance (of wheels: of their way's too), per m/s above 2 m/s"},
    EffectInfo{"STREAM.variance(turn)", "s/rad", 5.0, -50.0, 50.0, "turn rate",
               "logarithm of the noise's variance (the same), per rad/s above 0.2 rad/s"},
    EffectInfo{"STREAM.correlation", "1", 0.5, -0.999, 0.999, "time",
               "of the noise of neighbouring readings"},
};

}  // namespace

std::span<const EffectInfo> reading_effects() { return kReadingEffects; }
std::span<const EffectInfo> noise_effects() { return kNoiseEffects; }

}  // namespace roadbook
