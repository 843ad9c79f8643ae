#include <array>

#include "sensors/effects.hpp"

namespace roadbook {
namespace {

constexpr std::array kReadingEffects{
    EffectInfo{"detector.range", "1/m", 0.2, -2.0, 2.0, "range",
               "decrease of the log odds of a detection per metre from the camera"},
    EffectInfo{"detector.foot_point", "m", 0.2, -5.0, 5.0, "line of sight",
               "detected foot point this much farther from the camera"},
    EffectInfo{
        "friction0.slip_bias", "1", 0.1, -2.0, 2.0, "slip",
        "error of the friction read, relative, when all friction is in use (less in proportion)"},
    EffectInfo{"friction0.speed_bias", "s/m", 0.01, -0.1, 0.1, "speed",
               "added to the friction read, per m/s of speed"},
    EffectInfo{"friction0.drying", "1/s", 1e-4, -0.01, 0.01, "time",
               "growth of the friction of wet ground, per second of the drive"},
    EffectInfo{"friction0.temperature", "1/K", 0.005, -0.1, 0.1, "temperature",
               "added to the friction read, per kelvin above 20 degrees Celsius"},
    EffectInfo{"friction0.extra_class", "1", 0.2, -1.0, 1.0, "place",
               "friction of a surface with a wrong class, minus the friction of that class"},
    EffectInfo{"friction0.spatial_bias", "1", 0.05, 0.0, 1.0, "place",
               "standard deviation of a bias that varies from place to place"},
    EffectInfo{"range0.bias", "m", 0.3, -50.0, 50.0, "", "added to the ranges to beacons"},
    EffectInfo{"range0.scale", "1", 0.02, -0.5, 1.0, "range",
               "scale error of the ranges to beacons, relative"},
    EffectInfo{"range0.short", "1", 0.1, 0.0, 1.0, "",
               "share of readings from something unknown before the target"},
    EffectInfo{"range0.maximum", "1", 0.1, 0.0, 1.0, "",
               "share of readings without an echo, read as the maximum range"},
    EffectInfo{"range0.crosstalk", "1", 0.1, 0.0, 1.0, "",
               "share of readings of another sensor's pulse, uniform up to the maximum range"},
};

constexpr std::array kNoiseEffects{
    EffectInfo{"STREAM.outliers", "1", 0.05, 0.0, 1.0, "",
               "share of readings with ten times the noise"},
    EffectInfo{
        "STREAM.variance(speed)", "s/m", 0.5, -5.0, 5.0, "speed",
        "log variance of the noise (wheels: and of the slip on the way), per m/s above 2 m/s"},
    EffectInfo{"STREAM.variance(turn)", "s/rad", 5.0, -50.0, 50.0, "turn rate",
               "log variance of the noise (the same), per rad/s above 0.2 rad/s"},
    EffectInfo{"STREAM.correlation", "1", 0.5, -0.999, 0.999, "time",
               "correlation of the noise of neighbouring readings"},
};

}  // namespace

std::span<const EffectInfo> reading_effects() { return kReadingEffects; }
std::span<const EffectInfo> noise_effects() { return kNoiseEffects; }

}  // namespace roadbook
