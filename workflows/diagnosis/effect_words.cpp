#include "workflows/diagnosis/effect_words.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "sensors/effects.hpp"

namespace roadbook {
namespace {

constexpr double kToDegrees = 180.0 / std::numbers::pi;
constexpr std::string_view kCalibrate = "{calibrate}";
constexpr std::string_view kOffset = "add {-size} ms to {offset_key} {sensor}";

constexpr std::array kWords{
    EffectWords{"wheels0.left_radius", "radius of the left rear wheel",
                "the left rear wheel is larger than stated",
                "the left rear wheel is smaller than stated", "%", 100.0,
                "set {left_key} to {left}"},
    EffectWords{"wheels0.right_radius", "radius of the right rear wheel",
                "the right rear wheel is larger than stated",
                "the right rear wheel is smaller than stated", "%", 100.0,
                "set {right_only_key} to {right}"},
    EffectWords{"wheels0.radius", "radius of both rear wheels",
                "both rear wheels are larger than stated",
                "both rear wheels are smaller than stated", "%", 100.0,
                "set {left_key} to {left} and {right_key} to {right}"},
    EffectWords{"wheels0.radius_difference", "difference of the rear wheels",
                "the right rear wheel is larger than the left one, unlike stated",
                "the right rear wheel is smaller than the left one, unlike stated", "%", 100.0,
                "set {left_key} to {left} and {right_key} to {right}; compare "
                "the tyres' pressures"},
    EffectWords{"wheels0.track_width", "track width", "the rear track is wider than stated",
                "the rear track is narrower than stated", "%", 100.0, "set {track_key} to {track}"},
    EffectWords{
        "wheels0.locked_axle", "differential",
        "both rear wheels turn by nearly the same angle in bends, as without a differential", "",
        "%", 100.0, "take turns from the gyro, not from the wheels; look at the differential"},
    EffectWords{"wheels0.latency", "time stamps of the wheels", "the wheels are stamped too late",
                "the wheels are stamped too early", "ms", 1000.0, kOffset},
    EffectWords{"wheels0.slip_acceleration", "slip of the wheels under power",
                "the wheels turn more than the road passes when the car accelerates",
                "the wheels turn less than the road passes when the car accelerates",
                "% at 1 m/s^2", 100.0,
                "keep it in the model (`--write-model`); a calibration cannot remove it"},
    EffectWords{"wheels0.radius_speed", "growth of the tyres with speed",
                "the tyres grow with speed", "the tyres shrink with speed", "% at 10 m/s", 1000.0,
                "keep it in the model (`--write-model`); calibrate the radius at the usual speed"},
    EffectWords{"wheels0.eccentricity", "centring of the wheel encoder",
                "the wheel encoder has an error that repeats each turn", "", "deg", kToDegrees,
                "look at the encoder's ring: it is not centred"},
    EffectWords{"wheels0.wet_patch", "slip on wet ground", "the wheels slip on a wet place",
                "the wheels turn too little on one place", "%", 100.0,
                "nothing at the car: the place is slippery", true},
    EffectWords{"steering0.offset", "zero of the steering angle",
                "the steering angle reads too far to the left",
                "the steering angle reads too far to the right", "deg", kToDegrees,
                "add {-size} deg to the angle of the road wheels"},
    EffectWords{"steering0.ratio", "steering ratio", "the steering angle reads too large",
                "the steering angle reads too small", "%", 100.0,
                "divide the steering angle by {factor}"},
    EffectWords{"steering0.understeer", "understeer",
                "the car turns less than its steering angle says the faster it drives",
                "the car turns more than its steering angle says the faster it drives",
                "% at 10 m/s", 1e4, "nothing is broken: give it to the planner's vehicle model"},
    EffectWords{"steering0.wheelbase", "wheelbase", "the wheelbase is longer than stated",
                "the wheelbase is shorter than stated", "%", 100.0,
                "set {wheelbase_key} to {wheelbase}"},
    EffectWords{"steering0.latency", "time stamps of the steering angle",
                "the steering angle is older than the wheel angles of its row",
                "the steering angle is newer than the wheel angles of its row", "ms", 1000.0,
                "shift the steering angle by {-size} ms"},
    EffectWords{"cam.latency", "time stamps of the images", "{sensor} is stamped too late",
                "{sensor} is stamped too early", "ms", 1000.0, kOffset},
    EffectWords{"cam.rolling_shutter", "rolling shutter",
                "the rows of {sensor} are exposed one after the other, downwards",
                "the rows of {sensor} are exposed one after the other, upwards", "ms", 1000.0,
                kCalibrate},
    EffectWords{"cam.focal", "focal length", "the focal length of {sensor} is longer than stated",
                "the focal length of {sensor} is shorter than stated", "%", 100.0, kCalibrate},
    EffectWords{"cam.centre", "image centre",
                "the image centre of {sensor} lies farther to the lower right than stated",
                "the image centre of {sensor} lies farther to the upper left than stated", "px",
                1.0, kCalibrate},
    EffectWords{"cam.distortion", "lens distortion",
                "the distortion of {sensor} is larger than stated",
                "the distortion of {sensor} is smaller than stated", "in the first coefficient",
                1.0, kCalibrate},
    EffectWords{"cam.aspect", "horizontal over vertical focal length",
                "the horizontal focal length of {sensor} is longer against the vertical one than "
                "stated",
                "the horizontal focal length of {sensor} is shorter against the vertical one than "
                "stated",
                "%", 100.0, kCalibrate},
    EffectWords{"cam.centre_x", "horizontal image centre",
                "the image centre of {sensor} lies farther to the right than stated",
                "the image centre of {sensor} lies farther to the left than stated", "px", 1.0,
                kCalibrate},
    EffectWords{"cam.centre_y", "vertical image centre",
                "the image centre of {sensor} lies lower than stated",
                "the image centre of {sensor} lies higher than stated", "px", 1.0, kCalibrate},
    EffectWords{"cam.distortion2", "lens distortion far from the image centre",
                "the distortion of {sensor} grows more towards the edge than stated",
                "the distortion of {sensor} grows less towards the edge than stated",
                "in the second coefficient", 1.0, kCalibrate},
    EffectWords{"cam.rotation", "direction of the cameras",
                "{sensor} looks farther to its right than stated",
                "{sensor} looks farther to its left than stated", "deg", kToDegrees, kCalibrate},
    EffectWords{"cam.pitch", "pitch of the cameras", "{sensor} looks farther up than stated",
                "{sensor} looks farther down than stated", "deg", kToDegrees, kCalibrate},
    EffectWords{"cam.roll", "roll of the cameras",
                "{sensor} is turned clockwise about its axis, unlike stated",
                "{sensor} is turned counter-clockwise about its axis, unlike stated", "deg",
                kToDegrees, kCalibrate},
    EffectWords{"cam.position", "position of the cameras",
                "{sensor} is mounted farther forward than stated",
                "{sensor} is mounted farther back than stated", "cm", 100.0, kCalibrate},
    EffectWords{"cam.lateral", "lateral position of the cameras",
                "{sensor} is mounted farther to the left than stated",
                "{sensor} is mounted farther to the right than stated", "cm", 100.0, kCalibrate},
    EffectWords{"cam.height", "mounting height of the cameras",
                "{sensor} is mounted higher than stated", "{sensor} is mounted lower than stated",
                "cm", 100.0, kCalibrate},
    EffectWords{"rig.rotation", "direction of the rig of cameras",
                "{sensor} looks farther to the right than stated",
                "{sensor} looks farther to the left than stated", "deg", kToDegrees, kCalibrate},
    EffectWords{"rig.pitch", "pitch of the rig of cameras", "{sensor} looks farther up than stated",
                "{sensor} looks farther down than stated", "deg", kToDegrees, kCalibrate},
    EffectWords{"rig.roll", "roll of the rig of cameras",
                "{sensor} is turned clockwise seen from behind, unlike stated",
                "{sensor} is turned counter-clockwise seen from behind, unlike stated", "deg",
                kToDegrees, kCalibrate},
    EffectWords{"cam.vignetting", "light at the edge of the images",
                "{sensor} loses light towards the edge of its image",
                "{sensor} gains light towards the edge of its image", "%", 100.0,
                "keep it in the model (`--write-model`)"},
    EffectWords{"cam.exposure", "exposure", "{sensor} is brighter than the others",
                "{sensor} is darker than the others", "%", 100.0,
                "let all cameras share one exposure control"},
    EffectWords{"cam.exposure_step", "steadiness of the exposure",
                "{sensor} becomes brighter at one moment of the drive",
                "{sensor} becomes darker at one moment of the drive", "%", 100.0,
                "look at the exposure control of {sensor}"},
    EffectWords{"imu0.gyro_bias", "bias of the gyro", "the gyro reads a left turn at rest",
                "the gyro reads a right turn at rest", "deg/s", kToDegrees,
                "add {-size} deg/s to the turn rates, or measure the bias at each stop"},
    EffectWords{"imu0.gyro_scale", "scale of the gyro", "the gyro reads turns too large",
                "the gyro reads turns too small", "%", 100.0,
                "divide the turn rates by {factor}; a tilted mount reads too small as well"},
    EffectWords{"imu0.latency", "time stamps of the gyro", "the gyro is stamped too late",
                "the gyro is stamped too early", "ms", 1000.0, kOffset},
    EffectWords{"imu0.tilt_roll", "roll of the IMU",
                "the IMU is mounted with its right side lower than stated",
                "the IMU is mounted with its left side lower than stated", "deg", kToDegrees,
                "roll `T_BS` of imu0 by {size} deg about the vehicle's x axis"},
    EffectWords{"imu0.tilt_pitch", "pitch of the IMU",
                "the IMU is mounted with its front higher than stated",
                "the IMU is mounted with its front lower than stated", "deg", kToDegrees,
                "turn `T_BS` of imu0 by {-size} deg about the vehicle's y axis"},
    EffectWords{"clock.drift", "rate of the clocks",
                "the clock of wheels and gyro is faster than that of the reference",
                "the clock of wheels and gyro is slower than that of the reference", "ppm", 1e6,
                "stamp all sensors by one clock"},
    EffectWords{"ground.height", "height of the cameras above the ground",
                "the ground is higher than stated", "the ground is lower than stated", "cm", 100.0,
                "correct the height of the cameras in their `T_BS`"},
    EffectWords{"ground.slope", "inclination of the vehicle",
                "the vehicle's nose hangs lower than stated",
                "the vehicle's nose points higher than stated", "deg", kToDegrees,
                "correct the pitch of the cameras in their `T_BS`, or look at load and springs"},
    EffectWords{"ground.hinge", "edges of ramps", "the ground becomes steeper at a line",
                "the ground becomes flatter at a line", "deg", kToDegrees,
                "nothing at the car: a ramp begins or ends there", true},
    EffectWords{"ground.bank", "bank of the bends",
                "bends are banked: wheels, steering and gyro turn less than the reference", "",
                "% of each turn", 100.0,
                "nothing at the car: record the roll of the reference, then turns are levelled"},
    EffectWords{"map.scale", "scale of the map", "the map is too large", "the map is too small",
                "%", 100.0, "build the map again with the corrected wheels"},
    EffectWords{"map.moved_landmarks", "landmarks that moved", "landmarks of the map have moved",
                "", "%", 100.0, "extend the map by this drive (`roadbook map`)", true},
    EffectWords{"map.landmarks_gone", "removed landmarks",
                "landmarks of the map are no longer there", "", "%", 100.0,
                "extend the map by this drive (`roadbook map`)", true},
    EffectWords{"map.bend", "bend of the map", "straight lines of the map bend to the left",
                "straight lines of the map bend to the right", "mm in 10 m", 5e4,
                "build the map again with the corrected wheels and gyro"},
    EffectWords{"detector.range", "range of the person detector",
                "people are found less often the farther away they are",
                "people are found more often the farther away they are", "log odds a metre", 1.0,
                "use detections only up to the range that you need"},
    EffectWords{"detector.foot_point", "foot points of people",
                "people are placed too far from the camera",
                "people are placed too near to the camera", "cm", 100.0,
                "move the foot points by {-size} cm along the line of sight"},
    EffectWords{"friction0.slip_bias", "friction near the limit",
                "the friction reads too high near the limit",
                "the friction reads too low near the limit", "% of the friction", 100.0,
                "keep it in the model (`--write-model`)"},
    EffectWords{"friction0.speed_bias", "friction at speed", "the friction reads higher with speed",
                "the friction reads lower with speed", "at 10 m/s", 10.0,
                "keep it in the model (`--write-model`)"},
    EffectWords{"friction0.drying", "drying of the ground", "wet ground dries during the drive",
                "ground becomes wetter during the drive", "of friction in 10 min", 600.0,
                "nothing at the car", true},
    EffectWords{"friction0.temperature", "temperature of the tyres",
                "the friction grows with the tyres' temperature",
                "the friction falls with the tyres' temperature", "at 10 K", 10.0,
                "keep it in the model (`--write-model`)"},
    EffectWords{"friction0.extra_class", "classes of the ground",
                "a surface has more friction than its class",
                "a surface has less friction than its "
                "class",
                "of friction", 1.0, "correct the label of that surface", true},
    EffectWords{"friction0.spatial_bias", "friction from place to place",
                "the friction reads differently from place to place", "", "of friction", 1.0,
                "keep it in the model (`--write-model`)"},
    EffectWords{"range0.bias", "offset of the ranges", "ranges read too long",
                "ranges read too short", "cm", 100.0, "add {-size} cm to the ranges"},
    EffectWords{"range0.scale", "scale of the ranges", "ranges read too long in proportion",
                "ranges read too short in proportion", "%", 100.0, "divide the ranges by {factor}"},
    EffectWords{"range0.short", "short readings of the ranges", "some beams end before the target",
                "", "% of the readings", 100.0,
                "look for what hangs into the beams: spray, dust, the own car"},
    EffectWords{"range0.maximum", "lost echoes of the ranges", "some beams bring no echo", "",
                "% of the readings", 100.0, "keep it in the model of the beams"},
    EffectWords{"range0.crosstalk", "crosstalk of the ranges",
                "some beams read another sensor's pulse", "", "% of the readings", 100.0,
                "look for other scanners nearby"},
    EffectWords{"STREAM.outliers", "outliers", "some readings of {sensor} are far off", "",
                "% of the readings", 100.0, "look at the cable and the log of {sensor}"},
    EffectWords{"STREAM.variance(speed)", "noise at speed",
                "readings of {sensor} are noisier the faster the car drives",
                "readings of {sensor} are less noisy the faster the car drives",
                "in log variance a m/s", 1.0, "keep it in the model (`--write-model`)"},
    EffectWords{"STREAM.variance(turn)", "noise in bends",
                "readings of {sensor} are noisier in bends",
                "readings of {sensor} are less noisy in bends", "in log variance a rad/s", 1.0,
                "keep it in the model (`--write-model`)"},
    EffectWords{"STREAM.correlation", "errors that last",
                "errors of {sensor} last from reading to reading",
                "errors of {sensor} alternate from reading to reading", "", 1.0,
                "count these readings for less: they repeat their errors"},
};

// In a plain log, the place of the poses' sensor and its direction stand for a camera's.
constexpr std::array kWordsOfLogs{
    EffectWords{"cam.latency", "time stamps of the reference",
                "the reference poses are stamped too late",
                "the reference poses are stamped too early", "ms", 1000.0,
                "add {-size} ms to the stamps of the poses"},
    EffectWords{"cam.position", "position of the reference's sensor",
                "the reference's sensor is mounted farther forward than stated",
                "the reference's sensor is mounted farther back than stated", "cm", 100.0,
                "add {size} cm to `sensor_forward_m` of the poses"},
    EffectWords{"cam.rotation", "direction of the reference's sensor",
                "the reference's heading reads too far to the right",
                "the reference's heading reads too far to the left", "deg", kToDegrees,
                "add {size} deg to the heading of the poses"},
};

}  // namespace

std::optional<EffectWords> effect_words(std::string_view name, bool of_log) {
  if (of_log)
    for (const EffectWords& words : kWordsOfLogs)
      if (words.effect == name) return words;
  const auto declared = declared_effect(name);
  if (!declared) return std::nullopt;
  const auto* const found =
      std::find_if(kWords.begin(), kWords.end(),
                   [&](const EffectWords& words) { return words.effect == declared->name; });
  if (found == kWords.end()) return std::nullopt;
  return *found;
}

std::string_view drive_that_shows(std::string_view covariate) {
  if (covariate == "speed") return "drive the same street at 5 and at 20 m/s";
  if (covariate == "turn rate" || covariate == "steering angle")
    return "drive bends to the left and to the right, five of each";
  if (covariate == "acceleration") return "speed up and brake hard, three times";
  if (covariate == "distance" || covariate == "position")
    return "drive farther, a kilometre or more";
  if (covariate == "wheel phase") return "drive slowly and straight for 200 m";
  if (covariate == "time") return "record ten minutes or more";
  if (covariate == "image row" || covariate == "image radius")
    return "drive past objects that fill the images, with `-m MAP`";
  if (covariate == "range") return "pass targets at near and at far range";
  if (covariate == "wet ground") return "drive over wet and dry ground";
  return "record a longer drive with changes of speed and direction";
}

}  // namespace roadbook
