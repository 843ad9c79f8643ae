#include "sensors/effects.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

#include "base/error.hpp"
#include "base/text.hpp"

namespace roadbook {
namespace {

constexpr std::array kWheelEffects{
    EffectInfo{"wheels0.left_radius", "1", 0.02, -0.5, 0.5, "distance",
               "radius of the left rear wheel, relative"},
    EffectInfo{"wheels0.right_radius", "1", 0.02, -0.5, 0.5, "distance",
               "radius of the right rear wheel, relative"},
    EffectInfo{"wheels0.radius", "1", 0.02, -0.5, 0.5, "distance",
               "radius of both rear wheels, relative"},
    EffectInfo{"wheels0.radius_difference", "1", 0.01, -0.5, 0.5, "distance",
               "right radius minus left radius, relative to their mean"},
    EffectInfo{"wheels0.track_width", "1", 0.05, -0.5, 1.0, "turn rate", "track width, relative"},
    EffectInfo{"wheels0.locked_axle", "1", 1.0, 0.5, 1.2, "turn rate",
               "missing share of the wheels' rotation difference in bends (1: no differential)"},
    EffectInfo{"wheels0.latency", "s", 0.1, -5.0, 5.0, "speed",
               "a reading stamped t shows the wheels at t - size"},
    EffectInfo{"wheels0.slip_acceleration", "s^2/m", 0.01, -0.1, 0.1, "acceleration",
               "extra wheel rotation, relative, per m/s^2 of acceleration"},
    EffectInfo{"wheels0.radius_speed", "s/m", 0.003, -0.01, 0.01, "speed",
               "growth of both radii, relative, per m/s of speed"},
    EffectInfo{"wheels0.eccentricity", "rad", 0.02, -0.5, 0.5, "wheel phase",
               "error of the angle read: size times the sine of the wheel angle"},
    EffectInfo{"wheels0.wet_patch", "1", 0.05, -0.9, 2.0, "wet ground",
               "extra wheel rotation on wet ground, relative"},
    EffectInfo{"steering0.offset", "rad", 0.02, -0.5, 0.5, "", "added to the steering angle read"},
    EffectInfo{"steering0.ratio", "1", 0.05, -0.9, 9.0, "steering angle",
               "scale error of the steering angle read, relative"},
    EffectInfo{"steering0.understeer", "s^2/m^2", 0.002, -0.02, 0.05, "speed",
               "extra steering angle for the same curvature, relative, per (m/s)^2"},
    EffectInfo{"steering0.wheelbase", "1", 0.05, -0.5, 1.0, "steering angle",
               "wheelbase of the real car, relative to the stated one"},
    EffectInfo{"steering0.latency", "s", 0.1, -5.0, 5.0, "turn rate",
               "delay of the steering angle against the wheel angles of its row"},
};

constexpr std::array kCameraEffects{
    EffectInfo{"cam.latency", "s", 0.05, -5.0, 5.0, "speed",
               "an image stamped t shows the world at t - size"},
    EffectInfo{"cam.rolling_shutter", "s", 0.03, -0.2, 0.2, "image row",
               "time from the first image row to the last; the stamp is that of the middle row"},
    EffectInfo{"cam.focal", "1", 0.01, -0.5, 1.0, "image radius", "both focal lengths, relative"},
    EffectInfo{"cam.centre", "px", 3.0, -500.0, 500.0, "",
               "shift of the principal point, to the right and down by size each"},
    EffectInfo{"cam.distortion", "1", 0.01, -1.0, 1.0, "image radius",
               "added to the first distortion coefficient (double sphere: alpha)"},
    EffectInfo{"cam.aspect", "1", 0.005, -0.5, 0.5, "image radius",
               "horizontal over vertical focal length, relative; their mean stays"},
    EffectInfo{"cam.centre_x", "px", 3.0, -500.0, 500.0, "",
               "shift of the principal point to the right"},
    EffectInfo{"cam.centre_y", "px", 3.0, -500.0, 500.0, "", "shift of the principal point down"},
    EffectInfo{"cam.distortion2", "1", 0.005, -1.0, 1.0, "image radius",
               "added to the second distortion coefficient (double sphere: xi)"},
    EffectInfo{"cam.rotation", "rad", 0.02, -1.6, 1.6, "",
               "turn about the camera's y axis, positive to its right"},
    EffectInfo{"cam.pitch", "rad", 0.02, -1.6, 1.6, "",
               "turn about the camera's x axis, positive upwards"},
    EffectInfo{"cam.roll", "rad", 0.02, -3.2, 3.2, "",
               "turn about the camera's z axis, positive clockwise seen from behind"},
    EffectInfo{"cam.position", "m", 0.05, -5.0, 5.0, "turn rate",
               "shift along the vehicle's x axis, positive forward"},
    EffectInfo{"cam.lateral", "m", 0.05, -5.0, 5.0, "turn rate",
               "shift along the vehicle's y axis, positive to the left"},
    EffectInfo{"cam.height", "m", 0.06, -2.0, 2.0, "",
               "shift along the vehicle's z axis, positive upwards"},
    EffectInfo{"rig.rotation", "rad", 0.02, -1.6, 1.6, "distance",
               "turn of all cameras as one body about the vehicle's z axis, positive to the right"},
    EffectInfo{"rig.pitch", "rad", 0.03, -0.5, 0.5, "distance",
               "turn of all cameras as one body about the vehicle's y axis, positive upwards"},
    EffectInfo{
        "rig.roll", "rad", 0.03, -0.5, 0.5, "turn rate",
        "turn of all cameras as one body about the vehicle's x axis, positive clockwise seen "
        "from behind"},
    EffectInfo{"cam.vignetting", "1", 0.5, -1.0, 1.0, "image radius",
               "light lost at the edge of the image circle, relative"},
    EffectInfo{"cam.exposure", "1", 0.3, -0.95, 9.0, "", "light that reaches the sensor, relative"},
    EffectInfo{"cam.exposure_step", "1", 0.3, -0.95, 9.0, "time",
               "exposure from one moment of the drive on (simulated: its middle), relative"},
};

constexpr std::array kImuEffects{
    EffectInfo{"imu0.gyro_bias", "rad/s", 0.01, -0.5, 0.5, "time", "added to the turn rates"},
    EffectInfo{"imu0.gyro_scale", "1", 0.02, -0.5, 0.5, "turn rate",
               "scale error of the turn rates read, relative"},
    EffectInfo{"imu0.latency", "s", 0.05, -5.0, 5.0, "turn rate",
               "a reading stamped t shows the motion at t - size"},
    EffectInfo{"imu0.tilt_roll", "rad", 0.05, -0.5, 0.5, "turn rate",
               "roll of the IMU against its stated mounting, positive with its right side down"},
    EffectInfo{"imu0.tilt_pitch", "rad", 0.05, -0.5, 0.5, "turn rate",
               "pitch of the IMU against its stated mounting, positive with its front up"},
};

constexpr std::array kWorldEffects{
    EffectInfo{"clock.drift", "1", 1e-4, -0.01, 0.01, "time",
               "rate error of the clock of wheels and IMU, positive: faster than the cameras'"},
    EffectInfo{"ground.height", "m", 0.05, -2.0, 2.0, "", "height added to the ground"},
    EffectInfo{"ground.slope", "rad", 0.02, -0.5, 0.5, "distance",
               "rise of the ground ahead, seen from the vehicle (its nose hangs down)"},
    EffectInfo{"ground.hinge", "rad", 0.05, -0.5, 0.5, "position",
               "added to the change of slope at the hinge line"},
    EffectInfo{"ground.bank", "1", 0.03, 0.0, 0.3, "turn rate",
               "share of each turn that a car in banked bends does not read: 1 - cos(bank)"},
    EffectInfo{"map.scale", "1", 0.01, -0.5, 1.0, "position", "scale of the map, relative"},
    EffectInfo{"map.moved_landmarks", "1", 0.1, 0.0, 1.0, "", "share of landmarks that have moved"},
    EffectInfo{"map.landmarks_gone", "1", 0.1, 0.0, 1.0, "", "share of landmarks that are gone"},
    EffectInfo{"map.bend", "1/m", 1e-4, -0.01, 0.01, "distance",
               "curvature of a straight line in the map"},
};

std::string_view kind_of(std::string_view sensor) {
  const auto last = sensor.find_last_not_of("0123456789");
  return last == std::string_view::npos ? std::string_view{} : sensor.substr(0, last + 1);
}

bool has_noise(std::string_view stream) {
  for (const char* known : {"wheels0", "steering0", "imu0", "poses", "friction0", "range0"})
    if (stream == known) return true;
  return false;
}

// "cam2.focal" is declared as "cam.focal", "imu0.outliers" as "STREAM.outliers"; all other names
// are declared unchanged.
std::string declared_name(std::string_view name) {
  const auto dot = name.find('.');
  if (dot == std::string_view::npos) return std::string(name);
  if (kind_of(name.substr(0, dot)) == "cam") return "cam" + std::string(name.substr(dot));
  const std::string of_noise = "STREAM" + std::string(name.substr(dot));
  for (const EffectInfo& e : noise_effects())
    if (e.name == of_noise && has_noise(name.substr(0, dot))) return of_noise;
  return std::string(name);
}

std::string shortest(double value) {
  std::array<char, 32> text{};
  const auto end = std::to_chars(text.data(), text.data() + text.size(), value).ptr;
  return {text.data(), end};
}

// Combines the effect of one camera with the same effect of the whole rig, where both are on.
std::optional<double> together(const EffectSizes& sizes, const std::string& name) {
  const auto dot = name.find('.');
  const std::string declared = declared_name(name);
  if (declared == name || !declared.starts_with("cam.") || !sizes.contains(declared))
    return std::nullopt;
  return effect_size(sizes, std::string_view(name).substr(0, dot), name.substr(dot + 1));
}

std::string bounds_of(const EffectInfo& info) {
  const std::string unit = info.unit == "1" ? "" : " " + std::string(info.unit);
  return shortest(info.lowest) + " to " + shortest(info.highest) + unit;
}

}  // namespace

std::span<const EffectInfo> wheel_effects() { return kWheelEffects; }
std::span<const EffectInfo> camera_effects() { return kCameraEffects; }
std::span<const EffectInfo> imu_effects() { return kImuEffects; }
std::span<const EffectInfo> world_effects() { return kWorldEffects; }

std::vector<EffectInfo> all_effects() {
  std::vector<EffectInfo> all;
  for (const auto& part : {wheel_effects(), camera_effects(), imu_effects(), world_effects(),
                           reading_effects(), noise_effects()})
    all.insert(all.end(), part.begin(), part.end());
  return all;
}

std::optional<EffectInfo> declared_effect(std::string_view name) {
  const std::string declared = declared_name(name);
  for (const EffectInfo& e : all_effects())
    if (e.name == declared) return e;
  return std::nullopt;
}

double effect_size(const EffectSizes& sizes, std::string_view sensor, std::string_view effect) {
  const auto find = [&](std::string_view owner) {
    return sizes.find(std::string(owner) + "." + std::string(effect));
  };
  const auto own = find(sensor);
  const std::string_view kind = kind_of(sensor);
  const auto whole = kind == sensor ? sizes.end() : find(kind);
  return (own != sizes.end() ? own->second : 0.0) + (whole != sizes.end() ? whole->second : 0.0);
}

bool is_camera_effect(std::string_view name) {
  const std::string_view sensor = name.substr(0, name.find('.'));
  return sensor == "rig" || kind_of(sensor) == "cam";
}

void check_effects(const EffectSizes& sizes) {
  std::vector<std::string> known;
  for (const auto& info : all_effects()) known.emplace_back(info.name);
  std::vector<Problem> problems;
  const auto add = [&](const std::string& got, const std::string& want) {
    Problem problem;
    problem.field = "effects";
    problem.got = got;
    problem.want = want;
    problems.push_back(problem);
  };
  for (const auto& [name, size] : sizes) {
    const auto info = declared_effect(name);
    if (!info) {
      const auto nearest = nearest_name(declared_name(name), known);
      add(name, nearest ? "a known effect; did you mean " + *nearest + "?"
                        : "an effect listed in docs/reference/effects.md");
    } else if (!std::isfinite(size)) {
      add(name + " = " + std::to_string(size), "a finite size");
    } else if (size != 0.0 && (size < info->lowest || size > info->highest)) {
      add(name + " = " + shortest(size), bounds_of(*info));
    } else if (const auto both = together(sizes, name);
               both && (*both < info->lowest || *both > info->highest)) {
      add(name + " and " + declared_name(name) + " = " + shortest(*both) + " together",
          bounds_of(*info));
    }
  }
  if (!problems.empty()) throw BadInput(problems);
}

}  // namespace roadbook
