#include "workflows/diagnosis/advice.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <numbers>

#include "base/format.hpp"
#include "workflows/diagnosis/camera_advice.hpp"
#include "workflows/diagnosis/effect_words.hpp"

namespace roadbook {
namespace {

constexpr double kSureNats = 10.0;  // odds of 22,000
constexpr double kSureP = 1e-4;

int digits_for(double error) {
  if (!(error > 0.0) || !std::isfinite(error)) return 3;
  return std::clamp(1 - static_cast<int>(std::floor(std::log10(error))), 0, 9);
}

std::string sensor_of(const std::string& effect) { return effect.substr(0, effect.find('.')); }

// "cam2": "camera cam2"; "cam": "every camera".
std::string sensor_words(const std::string& sensor) {
  static const std::map<std::string, std::string> kNames{{"cam", "every camera"},
                                                         {"rig", "the rig of cameras"},
                                                         {"wheels0", "the wheels"},
                                                         {"steering0", "the steering angle"},
                                                         {"imu0", "the gyro"},
                                                         {"poses", "the reference poses"},
                                                         {"friction0", "the friction sensor"},
                                                         {"range0", "the range sensor"},
                                                         {"detector0", "the person detector"}};
  if (const auto found = kNames.find(sensor); found != kNames.end()) return found->second;
  return sensor.starts_with("cam") ? "camera " + sensor : sensor;
}

std::string with_unit(const std::string& number, std::string_view unit) {
  return unit.empty() ? number : number + " " + std::string(unit);
}

// The vehicle with one cause corrected.
WheelModel corrected(WheelModel vehicle, const std::string& effect, double size) {
  if (effect == "wheels0.left_radius" || effect == "wheels0.radius")
    vehicle.radius_left_m *= 1.0 + size;
  if (effect == "wheels0.right_radius" || effect == "wheels0.radius")
    vehicle.radius_right_m *= 1.0 + size;
  if (effect == "wheels0.radius_difference") {
    vehicle.radius_left_m *= 1.0 - 0.5 * size;
    vehicle.radius_right_m *= 1.0 + 0.5 * size;
  }
  if (effect == "wheels0.track_width") vehicle.track_width_m *= 1.0 + size;
  if (effect == "steering0.wheelbase") vehicle.wheelbase_m *= 1.0 + size;
  return vehicle;
}

// Replaces the names in braces; empty if one of them is not known.
std::string filled(std::string_view sentence, const std::map<std::string, std::string>& values) {
  std::string text;
  for (std::size_t i = 0; i < sentence.size();) {
    if (sentence[i] != '{') {
      text += sentence[i++];
      continue;
    }
    const std::size_t end = sentence.find('}', i);
    const auto value = values.find(std::string(sentence.substr(i + 1, end - i - 1)));
    if (value == values.end()) return "";
    text += value->second;
    i = end + 1;
  }
  return text;
}

// "add -3 ms to X" is "subtract 3 ms from X".
std::string in_plain_words(const std::string& action) {
  constexpr std::string_view kAddMinus = "add -";
  constexpr std::string_view kTo = " to ";
  const auto to = action.find(kTo);
  if (!action.starts_with(kAddMinus) || to == std::string::npos) return action;
  return "subtract " + action.substr(kAddMinus.size(), to - kAddMinus.size()) + " from " +
         action.substr(to + kTo.size());
}

// Values of a vehicle are said to a ten thousandth.
void add_vehicle(const WheelModel& vehicle,
                 const WheelModel& stated,
                 std::map<std::string, std::string>& values) {
  const auto add = [&](const char* key, double now_m, double stated_m) {
    values[key] = fixed(now_m, 4) + " m (stated: " + fixed(stated_m, 4) + " m)";
  };
  add("left", vehicle.radius_left_m, stated.radius_left_m);
  add("right", vehicle.radius_right_m, stated.radius_right_m);
  add("track", vehicle.track_width_m, stated.track_width_m);
  add("wheelbase", vehicle.wheelbase_m, stated.wheelbase_m);
}

void add_keys(bool of_log, std::map<std::string, std::string>& values) {
  values["left_key"] = of_log ? "the radius of the left wheel" : "`wheel_radius_left`";
  values["right_key"] = of_log ? "that of the right wheel" : "`wheel_radius_right`";
  values["right_only_key"] = of_log ? "the radius of the right wheel" : "`wheel_radius_right`";
  values["track_key"] = of_log ? "`track_width_m`" : "`track_width`";
  values["wheelbase_key"] = of_log ? "`wheelbase_m`" : "`wheelbase`";
  values["offset_key"] = of_log ? "the stamps of" : "`time_offset` of";
}

std::string error_text(const ReckoningError& error) {
  constexpr double kDegrees = 180.0 / std::numbers::pi;
  const double cm = 100.0 * error.position_m;
  const double deg = kDegrees * error.heading_rad;
  return fixed(cm, cm < 10.0 ? 1 : 0) + " cm and " + fixed(deg, deg < 1.0 ? 2 : 1) + " deg";
}

// What one correction gains, with all others made.
std::string gain_text(const ReckoningError& without, const ReckoningError& with) {
  const std::string before = error_text(without);
  const std::string after = error_text(with);
  if (before == after) return "Dead reckoning is the same with and without this correction";
  return "Without this correction, dead reckoning is off by " + before + " after " +
         fixed(without.over_s, 0) + " s; with it, by " + after;
}

// With all causes that hold everywhere and in all drives: a new value is right together with the
// others.
WheelModel corrected_by(const Diagnosis& d, WheelModel vehicle) {
  for (const FoundCause& c : d.causes)
    if (c.session.empty() && !c.in_place) vehicle = corrected(vehicle, c.effect, c.size);
  return vehicle;
}

std::string noun_of(const std::string& effect, bool of_log) {
  const auto words = effect_words(effect, of_log);
  if (!words) return effect;
  const std::string sensor = sensor_of(effect);
  const bool one_camera = sensor.starts_with("cam") && sensor != "cam";
  const bool of_noise = words->effect.starts_with("STREAM");
  return std::string(words->noun) +
         (one_camera || of_noise ? " of " + sensor_words(sensor) : std::string());
}

std::string listed(const std::vector<std::string>& names, const char* last = " and ") {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i)
    text += (i == 0 ? "" : i + 1 == names.size() ? last : ", ") + names[i];
  return text;
}

std::string certainty_of(const FoundCause& c, bool of_log) {
  if (c.inseparable.empty())
    return c.evidence >= kSureNats && c.gain.low > 0.0 && c.p <= kSureP ? "sure" : "likely";
  std::vector<std::string> nouns;
  for (const std::string& other : c.inseparable) nouns.push_back(noun_of(other, of_log));
  return "sure that something is wrong; in this drive, an error of " + listed(nouns, " or ") +
         " looks the same";
}

}  // namespace

std::string capitalised(std::string text) {
  if (!text.empty())
    text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

std::vector<Advice> advice_of(const Diagnosis& d, const std::optional<StatedVehicle>& stated) {
  std::vector<Advice> all;
  const bool of_log = stated && stated->of_log;
  for (const FoundCause& c : d.causes) {
    Advice advice;
    advice.effect = c.effect;
    const auto words = effect_words(c.effect, of_log);
    const double factor = words ? words->factor : 1.0;
    const std::string_view unit = words ? words->unit : std::string_view(c.unit);
    constexpr int kMostDigits = 3;
    const int digits = std::min(digits_for(0.5 * factor * (c.high - c.low)), kMostDigits);
    // A fault with words for either sign is said with its size alone.
    const double sign = words && !words->less.empty() && c.size < 0.0 ? -1.0 : 1.0;
    const auto shown = [&](double size) { return fixed(sign * factor * size, digits); };
    std::map<std::string, std::string> values{{"sensor", sensor_words(sensor_of(c.effect))},
                                              {"size", fixed(factor * c.size, digits)},
                                              {"factor", fixed(1.0 + c.size, digits + 2)},
                                              {"-size", fixed(-factor * c.size, digits)}};
    add_keys(of_log, values);
    values["calibrate"] =
        new_camera_values(d, c.effect, stated ? stated->rig : Rig{})
            .value_or("correct it with `--write-model` and `roadbook map --model`, or calibrate " +
                      values["sensor"] + " again");
    if (stated)
      add_vehicle(c.session.empty() ? corrected_by(d, stated->wheels)
                                    : corrected(stated->wheels, c.effect, c.size),
                  stated->wheels, values);
    advice.fault = c.effect;
    if (words) {
      const std::string_view fault = sign < 0.0 ? words->less : words->more;
      advice.fault = capitalised(filled(fault, values));
      advice.action = capitalised(in_plain_words(filled(words->act, values)));
      advice.of_place = words->of_place;
    }
    if (!c.session.empty()) advice.fault += " (in " + c.session + ")";
    advice.size = with_unit(shown(c.size), unit) + " (" + shown(sign < 0.0 ? c.high : c.low) +
                  " to " + with_unit(shown(sign < 0.0 ? c.low : c.high), unit) + ")";
    advice.certainty = certainty_of(c, of_log);
    if (!c.inseparable.empty() && !c.separating.empty()) {
      if (!advice.action.empty()) advice.action += ", if it is this one; ";
      advice.action += advice.action.empty() ? capitalised(c.separating) : c.separating;
    }
    if (c.reckoned_without && d.reckoned_after)
      advice.gain = gain_text(*c.reckoned_without, *d.reckoned_after);
    all.push_back(std::move(advice));
  }
  return all;
}

std::string reckoning_text(const Diagnosis& d) {
  if (!d.reckoned_before || !d.reckoned_after) return "";
  return "After " + fixed(d.reckoned_before->over_s, 0) + " s, dead reckoning is off by " +
         error_text(*d.reckoned_before) + "; with all corrections, by " +
         error_text(*d.reckoned_after) + " (root mean square of " +
         std::to_string(d.reckoned_before->pieces) + " pieces of the drive)";
}

std::vector<std::string> checked_and_fine(const Diagnosis& d,
                                          const std::optional<StatedVehicle>& stated) {
  std::vector<std::string> nouns;
  for (const std::string& effect : d.looked_for) {
    const auto is_named = [&](const FoundCause& c) {
      return c.effect == effect || std::count(c.inseparable.begin(), c.inseparable.end(), effect);
    };
    if (!shows(d, effect) || std::any_of(d.causes.begin(), d.causes.end(), is_named)) continue;
    const std::string noun = noun_of(effect, stated && stated->of_log);
    if (std::find(nouns.begin(), nouns.end(), noun) == nouns.end()) nouns.push_back(noun);
  }
  return nouns;
}

std::vector<BlindSpot> blind_spots(const Diagnosis& d, const std::optional<StatedVehicle>& stated) {
  std::vector<BlindSpot> spots;
  for (const std::string& effect : d.not_observable) {
    const auto declared = declared_effect(effect);
    const std::string drive(drive_that_shows(declared ? declared->covariate : ""));
    auto spot = std::find_if(spots.begin(), spots.end(),
                             [&](const BlindSpot& s) { return s.drive == drive; });
    if (spot == spots.end()) spot = spots.insert(spots.end(), {drive, {}});
    spot->nouns.push_back(noun_of(effect, stated && stated->of_log));
  }
  return spots;
}

std::vector<std::string> advice_lines(const Diagnosis& d,
                                      const std::optional<StatedVehicle>& stated) {
  std::vector<std::string> lines;
  for (const Advice& advice : advice_of(d, stated)) {
    lines.push_back(advice.fault + ": " + advice.size + ", " + advice.certainty);
    if (!advice.action.empty()) lines.push_back("  " + advice.action);
    if (!advice.gain.empty()) lines.push_back("  " + advice.gain);
  }
  if (const std::string text = reckoning_text(d); !text.empty()) lines.push_back(text);
  return lines;
}

}  // namespace roadbook
