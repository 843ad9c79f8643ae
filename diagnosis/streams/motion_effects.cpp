#include "diagnosis/streams/motion_effects.hpp"

#include <algorithm>
#include <array>

#include "base/error.hpp"

namespace roadbook {
namespace {

#define SIZE_OF(member) [](MotionEffects& e) -> double& { return e.member; }

// Steering is logged in wheels0: both share a clock.
constexpr std::array kMotionEffects{
    MotionEffect{"wheels0.left_radius", SIZE_OF(wheels.left_radius), kWheels},
    MotionEffect{"wheels0.right_radius", SIZE_OF(wheels.right_radius), kWheels},
    MotionEffect{"wheels0.radius", SIZE_OF(wheels.radius), kWheels},
    MotionEffect{"wheels0.radius_difference", SIZE_OF(wheels.radius_difference), kWheels},
    MotionEffect{"wheels0.track_width", SIZE_OF(wheels.track_width), kWheels},
    MotionEffect{"wheels0.locked_axle", SIZE_OF(wheels.locked_axle), kWheels},
    MotionEffect{"wheels0.latency", SIZE_OF(wheels.latency), kWheels | kSteeringBit},
    MotionEffect{"wheels0.slip_acceleration", SIZE_OF(wheels.slip_acceleration), kWheels},
    MotionEffect{"wheels0.radius_speed", SIZE_OF(wheels.radius_speed), kWheels},
    MotionEffect{"wheels0.eccentricity", SIZE_OF(wheels.eccentricity), kWheels},
    MotionEffect{"steering0.offset", SIZE_OF(steering.offset), kSteeringBit},
    MotionEffect{"steering0.ratio", SIZE_OF(steering.ratio), kSteeringBit},
    MotionEffect{"steering0.understeer", SIZE_OF(steering.understeer), kSteeringBit},
    MotionEffect{"steering0.wheelbase", SIZE_OF(steering.wheelbase), kWheels | kSteeringBit},
    MotionEffect{"steering0.latency", SIZE_OF(steering.latency), kSteeringBit},
    MotionEffect{"imu0.gyro_bias", SIZE_OF(imu.gyro_bias), kGyroBit},
    MotionEffect{"imu0.gyro_scale", SIZE_OF(imu.gyro_scale), kGyroBit},
    MotionEffect{"imu0.latency", SIZE_OF(imu.latency), kGyroBit},
    MotionEffect{kBank, SIZE_OF(bank), kWheels | kSteeringBit | kGyroBit},
    MotionEffect{"clock.drift", SIZE_OF(clock_drift), kWheels | kSteeringBit | kGyroBit},
    MotionEffect{"cam.latency", SIZE_OF(pose.latency), kPoses},
    MotionEffect{"cam.rotation", SIZE_OF(pose.rotation), kPoses},
    MotionEffect{"cam.position", SIZE_OF(pose.position), kPoses},
    MotionEffect{"map.scale", SIZE_OF(pose.scale), kPoses},
    MotionEffect{"map.bend", SIZE_OF(pose.bend), kPoses},
};

#undef SIZE_OF

}  // namespace

std::span<const MotionEffect> motion_effects() { return kMotionEffects; }

std::size_t effect_index(std::string_view name) {
  const auto found = std::find_if(kMotionEffects.begin(), kMotionEffects.end(),
                                  [&](const MotionEffect& e) { return e.name == name; });
  ROADBOOK_ASSERT(found != kMotionEffects.end());
  return static_cast<std::size_t>(found - kMotionEffects.begin());
}

MotionEffects motion_effects_of(const EffectSizes& sizes) {
  MotionEffects effects;
  for (const MotionEffect& effect : kMotionEffects)
    if (const auto size = sizes.find(std::string(effect.name)); size != sizes.end())
      effect.size(effects) = size->second;
  return effects;
}

const EffectInfo& declaration_of(std::string_view name) {
  for (const auto& part : {wheel_effects(), camera_effects(), imu_effects(), world_effects()}) {
    const auto found =
        std::find_if(part.begin(), part.end(), [&](const EffectInfo& e) { return e.name == name; });
    if (found != part.end()) return *found;
  }
  ROADBOOK_ASSERT(!"a declared effect");
  std::abort();
}

}  // namespace roadbook
