#include "workflows/diagnosis/advice.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "apps/report/diagnosis_page.hpp"
#include "workflows/diagnosis/effect_words.hpp"

namespace roadbook {
namespace {

FoundCause cause(const std::string& effect, double size, double half_width) {
  FoundCause c;
  c.effect = effect;
  c.size = size;
  c.low = size - half_width;
  c.high = size + half_width;
  c.evidence = 40.0;
  c.p = 1e-12;
  c.gain.total = 40.0;
  c.gain.low = 20.0;
  const auto declared = declared_effect(effect);
  c.unit = declared ? std::string(declared->unit) : "1";
  return c;
}

StatedVehicle stated_vehicle() {
  StatedVehicle vehicle;
  vehicle.wheels.radius_left_m = 0.31;
  vehicle.wheels.radius_right_m = 0.30;
  vehicle.wheels.track_width_m = 1.5;
  vehicle.wheels.wheelbase_m = 2.6;
  vehicle.wheels.steering_ratio = 15.0;
  return vehicle;
}

Advice advice_for(const FoundCause& c, const std::optional<StatedVehicle>& stated) {
  Diagnosis d;
  d.causes.push_back(c);
  return advice_of(d, stated).at(0);
}

TEST(Advice, SaysTheNewValueInTheKeysOfItsFile) {
  const Advice drive = advice_for(cause("wheels0.radius", 0.02, 0.002), stated_vehicle());
  EXPECT_EQ(drive.fault, "Both rear wheels are larger than stated");
  EXPECT_EQ(drive.size, "2.00 % (1.80 to 2.20 %)");
  EXPECT_EQ(drive.certainty, "sure");
  EXPECT_EQ(drive.action,
            "Set `wheel_radius_left` to 0.3162 m (stated: 0.3100 m) and `wheel_radius_right` to "
            "0.3060 m (stated: 0.3000 m)");
  StatedVehicle log = stated_vehicle();
  log.of_log = true;
  EXPECT_EQ(advice_for(cause("wheels0.track_width", -0.1, 0.01), log).action,
            "Set `track_width_m` to 1.3500 m (stated: 1.5000 m)");
  EXPECT_EQ(advice_for(cause("wheels0.radius", 0.02, 0.002), std::nullopt).action, "");
  const Advice place = advice_for(cause("cam.position", 0.3, 0.01), log);
  EXPECT_EQ(place.fault, "The reference's sensor is mounted farther forward than stated");
  EXPECT_EQ(place.action, "Add 30.0 cm to `sensor_forward_m` of the poses");
}

// The values of the file with all effects of the camera corrected.
TEST(Advice, SaysTheNewValuesOfACamera) {
  StatedVehicle vehicle = stated_vehicle();
  MountedCamera camera;
  camera.name = "cam2";
  camera.camera.model = CameraModel::kKannalaBrandt;
  camera.camera.parameters = {400.0, 401.0, 320.5, 240.0, -0.01, 0.002, 0.0, 0.0};
  camera.T_vehicle_camera.translation() = Eigen::Vector3d(1.5, 0.9, 1.1);
  camera.rolling_shutter_s = 0.02;
  vehicle.rig.cameras.push_back(camera);
  Diagnosis d;
  for (const auto& [effect, size] : std::map<std::string, double>{{"cam2.centre_y", 2.0},
                                                                  {"cam2.distortion2", 0.001},
                                                                  {"cam2.focal", 0.01},
                                                                  {"cam2.height", -0.05},
                                                                  {"cam2.rolling_shutter", 0.005},
                                                                  {"cam.height", 0.01}}) {
    d.causes.push_back(cause(effect, size, 0.001));
    d.extended[effect] = size;
  }
  d.causes.front().size = 1.5;  // the other half pixel was known before
  const auto advice = advice_of(d, vehicle);
  const auto action_of = [&](const std::string& effect) {
    const auto found = std::find_if(advice.begin(), advice.end(),
                                    [&](const Advice& a) { return a.effect == effect; });
    return found == advice.end() ? std::string() : found->action;
  };
  EXPECT_EQ(action_of("cam2.focal"),
            "Set `intrinsics` of cam2 to [404.00, 405.01, 320.50, 242.00] (stated: [400.00, "
            "401.00, 320.50, 240.00])");
  EXPECT_EQ(action_of("cam2.centre_y"), action_of("cam2.focal"));
  EXPECT_EQ(action_of("cam2.distortion2"),
            "Set `distortion_coefficients` of cam2 to [-0.01000, 0.00300, 0.00000, 0.00000] "
            "(stated: [-0.01000, 0.00200, 0.00000, 0.00000])");
  EXPECT_NE(action_of("cam2.height").find("Set `T_BS` of cam2 to [1.00000, "), std::string::npos);
  EXPECT_NE(action_of("cam2.height").find(", 1.05000, "), std::string::npos);
  EXPECT_EQ(action_of("cam2.rolling_shutter"),
            "Set `rolling_shutter` of cam2 to 0.02500 (stated: 0.02000)");
  EXPECT_EQ(action_of("cam.height"),
            "Correct it with `--write-model` and `roadbook map --model`, or calibrate every camera "
            "again");
}

// Both rows say the values that are right when both faults are corrected.
TEST(Advice, NewValuesHoldTogether) {
  Diagnosis d;
  d.causes.push_back(cause("wheels0.radius", 0.02, 0.002));
  d.causes.push_back(cause("wheels0.radius_difference", 0.01, 0.002));
  StatedVehicle vehicle = stated_vehicle();
  vehicle.wheels.radius_left_m = vehicle.wheels.radius_right_m = 0.30;
  for (const Advice& advice : advice_of(d, vehicle)) {
    EXPECT_NE(advice.action.find("0.3045 m"), std::string::npos) << advice.action;
    EXPECT_NE(advice.action.find("0.3075 m"), std::string::npos) << advice.action;
  }
  EXPECT_EQ(advice_for(cause("steering0.ratio", 0.05, 0.001), vehicle).action,
            "Divide the steering angle by 1.0500");
}

TEST(Advice, HasWordsForEitherSign) {
  const Advice late = advice_for(cause("wheels0.latency", 0.03, 0.001), stated_vehicle());
  EXPECT_EQ(late.fault, "The wheels are stamped too late");
  EXPECT_EQ(late.size, "30.0 ms (29.0 to 31.0 ms)");
  EXPECT_EQ(late.action, "Subtract 30.0 ms from `time_offset` of the wheels");
  const Advice early = advice_for(cause("wheels0.latency", -0.03, 0.001), stated_vehicle());
  EXPECT_EQ(early.fault, "The wheels are stamped too early");
  EXPECT_EQ(early.size, "30.0 ms (29.0 to 31.0 ms)");
  EXPECT_EQ(early.action, "Add 30.0 ms to `time_offset` of the wheels");
  const Advice camera = advice_for(cause("cam2.pitch", -0.0174533, 0.0017), std::nullopt);
  EXPECT_EQ(camera.fault, "Camera cam2 looks farther down than stated");
  EXPECT_EQ(camera.size.substr(0, 9), "1.000 deg");
}

TEST(Advice, SaysWhatACorrectionGainsAndWhereItGainsNothing) {
  Diagnosis d;
  d.causes.push_back(cause("imu0.gyro_scale", -0.03, 0.001));
  d.causes.push_back(cause("steering0.offset", 0.02, 0.001));
  d.reckoned_before = ReckoningError{5.0, 45, 0.28, 0.04};
  d.reckoned_after = ReckoningError{5.0, 45, 0.044, 0.001};
  d.causes[0].reckoned_without = d.reckoned_before;
  d.causes[1].reckoned_without = d.reckoned_after;
  const auto advice = advice_of(d, stated_vehicle());
  EXPECT_EQ(advice[0].action,
            "Divide the turn rates by 0.9700; a tilted mount reads too small as well");
  EXPECT_EQ(
      advice[0].gain,
      "Without this correction, dead reckoning is off by 28 cm and 2.3 deg after 5 s; with it, "
      "by 4.4 cm and 0.06 deg");
  EXPECT_EQ(advice[1].gain, "Dead reckoning is the same with and without this correction");
  EXPECT_EQ(
      reckoning_text(d),
      "After 5 s, dead reckoning is off by 28 cm and 2.3 deg; with all corrections, by 4.4 cm "
      "and 0.06 deg (root mean square of 45 pieces of the drive)");
}

// Of the whole catalogue, for both signs: no effect without words, no name left in braces.
TEST(Advice, KnowsEveryEffectOfTheCatalogue) {
  for (const EffectInfo& info : all_effects()) {
    std::string name(info.name);
    if (name.starts_with("STREAM")) name = "imu0" + name.substr(6);
    ASSERT_TRUE(effect_words(name)) << name;
    for (const double sign : {1.0, -1.0}) {
      const Advice advice =
          advice_for(cause(name, sign * info.plausible, 0.1 * info.plausible), stated_vehicle());
      EXPECT_NE(advice.fault, name);
      EXPECT_FALSE(advice.action.empty()) << name;
      for (const std::string& text : {advice.fault, advice.size, advice.action})
        EXPECT_EQ(text.find_first_of("{}"), std::string::npos) << text;
    }
  }
}

TEST(Advice, SaysWhatLooksTheSameAndWhichDriveDecides) {
  FoundCause c = cause("wheels0.radius", 0.02, 0.002);
  c.inseparable = {"map.scale"};
  c.separating = "three stops would separate them";
  const Advice advice = advice_for(c, stated_vehicle());
  EXPECT_EQ(advice.certainty,
            "sure that something is wrong; in this drive, an error of scale of the map looks the "
            "same");
  EXPECT_TRUE(advice.action.ends_with(", if it is this one; three stops would separate them"));
  FoundCause weak = cause("wheels0.radius", 0.02, 0.002);
  weak.evidence = 5.0;
  weak.p = 1e-3;
  EXPECT_EQ(advice_for(weak, stated_vehicle()).certainty, "likely");
}

TEST(Advice, ListsWhatIsFineAndWhatAnotherDriveShows) {
  Diagnosis d;
  d.causes.push_back(cause("wheels0.radius", 0.02, 0.002));
  d.looked_for = {"wheels0.radius", "wheels0.track_width", "wheels0.radius_speed"};
  d.not_observable = {"wheels0.radius_speed"};
  EXPECT_EQ(checked_and_fine(d), std::vector<std::string>{"track width"});
  const auto spots = blind_spots(d);
  ASSERT_EQ(spots.size(), 1U);
  EXPECT_EQ(spots[0].drive, "drive the same street at 5 and at 20 m/s");
  EXPECT_EQ(spots[0].nouns, std::vector<std::string>{"growth of the tyres with speed"});
}

// The first screen has no words of statistics. The fold-outs have them.
TEST(Advice, ThePageBeginsWithFaultSizeAndWhatToDo) {
  Diagnosis d;
  d.causes.push_back(cause("imu0.gyro_bias", 0.0041, 0.0001));
  d.causes.push_back(cause("ground.hinge", 0.05, 0.004));
  d.reckoned_before = ReckoningError{5.0, 60, 0.34, 0.021};
  d.reckoned_after = ReckoningError{5.0, 60, 0.021, 0.001};
  const std::string page = diagnosis_page(d, "drive", stated_vehicle());
  const std::string first = page.substr(0, page.find("<details>"));
  EXPECT_NE(first.find("The gyro reads a left turn at rest"), std::string::npos);
  EXPECT_NE(first.find("off by 34 cm and 1.2 deg"), std::string::npos);
  EXPECT_NE(first.find("2.1 cm and 0.06 deg"), std::string::npos);
  for (const char* word : {"nats", "p = ", "evidence", "imu0.gyro_bias"})
    EXPECT_EQ(first.find(word), std::string::npos) << word;
  EXPECT_LT(page.find("Features of the place"), page.find("<details>"));
  EXPECT_NE(page.find("nats"), std::string::npos);
}

}  // namespace
}  // namespace roadbook
