#include "drive/vehicle_yaml.hpp"

#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "base/yaml.hpp"
#include "drive/checks/camera_places.hpp"
#include "drive/sensor_yaml.hpp"
#include "sensors/calibration/calibration_fields.hpp"

namespace roadbook {
namespace {

struct Measure {
  const char* key;
  std::optional<double> VehicleMeasures::*value;
  Range range;  // from a small robot to a long bus [m]
};

constexpr std::array<Measure, 6> kMeasures{{
    {"length", &VehicleMeasures::length_m, {0.1, 30.0}},
    {"width", &VehicleMeasures::width_m, {0.1, 5.0}},
    {"height", &VehicleMeasures::height_m, {0.1, 6.0}},
    {"rear_overhang", &VehicleMeasures::rear_overhang_m, {0.0, 15.0}},
    {"wheelbase", &VehicleMeasures::wheelbase_m, {0.05, 20.0}},
    {"track_width", &VehicleMeasures::track_width_m, {0.05, 5.0}},
}};

// Measures that no body can have together.
void check_together(YamlMap& yaml, const VehicleMeasures& v) {
  constexpr double kRoundingM = 1e-6;
  const double behind_front_axle = v.rear_overhang_m.value_or(0.0) + v.wheelbase_m.value_or(0.0);
  if (v.length_m && *v.length_m < behind_front_axle - kRoundingM)
    yaml.report("length", decimal(*v.length_m),
                "at least rear_overhang + wheelbase = " + decimal(behind_front_axle));
  if (v.width_m && v.track_width_m && *v.width_m < *v.track_width_m - kRoundingM)
    yaml.report("width", decimal(*v.width_m),
                "at least track_width = " + decimal(*v.track_width_m));
}

// Metres, to the millimetre.
std::string millimetres(double value_m) { return decimal(std::round(1e3 * value_m) / 1e3); }

std::string places_of(const VehicleMeasures& vehicle) {
  const auto body = vehicle.body();
  return "at most 0.5 m outside the body (x " + millimetres(body->min().x()) + " to " +
         millimetres(body->max().x()) + ", y " + millimetres(body->min().y()) + " to " +
         millimetres(body->max().y()) + ")";
}

void warn_of_axle(const std::filesystem::path& file,
                  const char* key,
                  const std::optional<double>& stated,
                  double of_wheels,
                  ProblemList& problems) {
  constexpr double kAxleTolerance = 0.1;  // calibrated and effective widths of axles differ by less
  if (stated && of_wheels > 0.0 && std::abs(*stated - of_wheels) > kAxleTolerance * of_wheels)
    problems.warning(file.string(), 0, key, decimal(*stated),
                     decimal(of_wheels) + " within 10 % as in wheels0/sensor.yaml");
}

}  // namespace

std::optional<VehicleMeasures> read_vehicle_yaml(const std::filesystem::path& file,
                                                 ProblemList& problems) {
  try {
    YamlMap yaml = YamlMap::load(file);
    VehicleMeasures vehicle;
    for (const Measure& measure : kMeasures)
      yaml.read(measure.key, vehicle.*measure.value, measure.range);
    check_together(yaml, vehicle);
    yaml.finish();
    return vehicle;
  } catch (const BadInput& bad) {
    problems.add_all(bad.problems());
    return std::nullopt;
  }
}

VehicleMeasures load_vehicle(const std::filesystem::path& file) {
  ProblemList problems;
  const auto vehicle = read_vehicle_yaml(file, problems);
  if (vehicle && !vehicle->body())
    problems.error(file.string(), 0, "length, width", "measures that give no body",
                   "both (or wheelbase and rear_overhang, and track_width)");
  if (problems.has_errors()) throw BadInput(problems.problems());
  return *vehicle;
}

std::string vehicle_yaml_text(const VehicleMeasures& vehicle) {
  std::string text;
  for (const Measure& measure : kMeasures)
    if (const auto& value = vehicle.*measure.value)
      text += std::string(measure.key) + ": " + decimal(*value) + "\n";
  return text;
}

void warn_of_vehicle(const std::filesystem::path& file,
                     const std::filesystem::path& sensors,
                     const VehicleMeasures& vehicle,
                     const Rig& rig,
                     const std::optional<WheelModel>& wheels,
                     ProblemList& problems) {
  const auto body = vehicle.body();
  if (!body)
    problems.warning(file.string(), 0, "length, width", "measures that give no body",
                     "both (or wheelbase and rear_overhang, and track_width); what the cameras "
                     "see of the vehicle is measured in the images");
  if (wheels) {
    warn_of_axle(file, "wheelbase", vehicle.wheelbase_m, wheels->wheelbase_m, problems);
    warn_of_axle(file, "track_width", vehicle.track_width_m, wheels->track_width_m, problems);
  }
  if (!body) return;
  constexpr double kBesideM = 0.5;  // mirrors and brackets reach less far
  for (const MountedCamera& mounted : rig.cameras) {
    const Eigen::Vector2d at = mounted.T_vehicle_camera.translation().head<2>();
    const std::string fault = mounting_fault(mounted.T_vehicle_camera, *body);
    if (!fault.empty() && !is_outside_fault(fault)) continue;  // told by warn_of_camera_places
    const Eigen::AlignedBox2d outline(body->min().head<2>(), body->max().head<2>());
    if (outline.exteriorDistance(at) > kBesideM)
      problems.warning((sensors / mounted.name / "sensor.yaml").string(), 0, "T_BS",
                       mounted.name + " at x " + millimetres(at.x()) + ", y " + millimetres(at.y()),
                       places_of(vehicle));
  }
}

std::vector<Problem> doubts_of_given_vehicle(const std::filesystem::path& file,
                                             const VehicleMeasures& vehicle,
                                             const std::filesystem::path& drive) {
  std::error_code ignored;
  const auto deeper = drive / "mav0";
  const auto sensors = std::filesystem::is_directory(deeper, ignored) ? deeper : drive;
  ProblemList faults;  // told where the drive is opened
  Rig rig;
  for (int number = 0; number < 64; ++number) {
    const std::string name = "cam" + std::to_string(number);
    if (!std::filesystem::exists(sensors / name / "sensor.yaml", ignored)) continue;
    if (auto camera = read_camera_yaml(sensors / name / "sensor.yaml", name, 1e4, faults))
      rig.cameras.push_back(std::move(camera->camera));
  }
  std::optional<WheelModel> wheels;
  if (std::filesystem::exists(sensors / "wheels0" / "sensor.yaml", ignored))
    if (const auto found = read_wheel_yaml(sensors / "wheels0" / "sensor.yaml", faults))
      wheels = found->wheels;
  ProblemList doubts;
  if (!faults.has_errors()) {
    warn_of_vehicle(file, sensors, vehicle, rig, wheels, doubts);
    warn_of_camera_places(sensors, rig, wheels, vehicle, doubts);
  }
  return doubts.problems();
}

}  // namespace roadbook
