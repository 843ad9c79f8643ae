#include "workflows/calibration/calibrate_drives.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/format.hpp"
#include "base/index.hpp"
#include "base/temporary_folder.hpp"
#include "drive/drive.hpp"
#include "mapping/pipeline/build_map.hpp"
#include "mapping/store/map_file.hpp"
#include "workflows/further_drives.hpp"
#include "workflows/settings/effect_model.hpp"

namespace roadbook {
namespace {

constexpr int kMappings = 2;

bool is_same_camera(const MountedCamera& a, const MountedCamera& b) {
  return a.name == b.name && a.camera.model == b.camera.model &&
         a.camera.parameters == b.camera.parameters && a.camera.width == b.camera.width &&
         a.camera.height == b.camera.height && a.exposed_after_s == b.exposed_after_s &&
         a.rolling_shutter_s == b.rolling_shutter_s &&
         a.T_vehicle_camera.matrix() == b.T_vehicle_camera.matrix();
}

bool is_same_wheels(const WheelModel& a, const WheelModel& b) {
  return a.radius_left_m == b.radius_left_m && a.radius_right_m == b.radius_right_m &&
         a.track_width_m == b.track_width_m && a.time_offset_s == b.time_offset_s;
}

void require_one_vehicle(const std::vector<Drive>& drives) {
  const Drive& first = drives.front();
  for (const Drive& drive : drives) {
    const auto refuse = [&](const std::string& field, const std::string& got) {
      throw BadInput({Severity::kError, drive.folder().string(), 0, field,
                      got + " than " + first.folder().string(),
                      "drives of one vehicle with one calibration"});
    };
    const auto& a = first.rig().cameras;
    const auto& b = drive.rig().cameras;
    if (!std::equal(a.begin(), a.end(), b.begin(), b.end(), is_same_camera))
      refuse("cameras", "other cameras");
    if (drive.wheel_model().has_value() != first.wheel_model().has_value() ||
        (drive.wheel_model() && !is_same_wheels(*drive.wheel_model(), *first.wheel_model())))
      refuse("wheels0", "other wheels");
  }
}

// Known effects that are no columns; these are corrected in what is read of the drives.
EffectSizes effects_beyond(const std::vector<CalibrationColumn>& columns, EffectSizes effects) {
  for (const CalibrationColumn& column : columns) {
    effects.erase(column.name);
    if (column.camera >= 0) effects.erase("cam" + column.name.substr(column.name.find('.')));
  }
  return effects;
}

// The drives with `effects` corrected, and the sessions of `map` by them.
std::vector<CalibrationSession> sessions_of(const Map& map, const std::vector<Drive>& drives) {
  std::vector<CalibrationSession> sessions(map.sessions.size());
  for (CalibrationSession& session : sessions) session.used = false;
  for (const Drive& drive : drives) {
    const auto found =
        std::find_if(map.sessions.begin(), map.sessions.end(),
                     [&](const Session& s) { return s.drive_digest == drive.digest(); });
    if (found == map.sessions.end())
      throw BadInput({Severity::kError, drive.folder().string(), 0, "drive",
                      "no session of the map", "a drive from which the map was made"});
    CalibrationSession& session = sessions[static_cast<std::size_t>(found - map.sessions.begin())];
    session.used = true;
    // Wheels that contradicted the cameras say nothing of their calibration.
    if (found->scale_source != ScaleSource::kWheels) continue;
    session.model = drive.wheel_model();
    session.readings = drive.wheel_readings();
  }
  return sessions;
}

double degrees(double rad) { return rad * 180.0 / std::numbers::pi; }

CalibratedValue value_of(const CalibratedColumn& c,
                         double start,
                         const Rig& rig,
                         const std::optional<WheelModel>& wheels) {
  CalibratedValue v{c, {}, 0.0, 0.0, 0.0};
  const auto set = [&](const char* unit, double stated, double per_size) {
    v.unit = unit;
    v.before = stated + per_size * start;
    v.after = stated + per_size * c.value;
    v.half_width = std::abs(per_size) * c.half_width;
  };
  switch (c.column.kind) {
    case CalibrationKind::kPitch:
    case CalibrationKind::kYaw:
    case CalibrationKind::kRoll:
      set("deg", 0.0, degrees(1.0));
      break;
    case CalibrationKind::kFocal: {
      const double focal = rig.cameras[at(c.column.camera)].camera.focal_px();
      set("px", focal, focal);
      break;
    }
    case CalibrationKind::kImageDelay:
      set("ms", -1e3 * rig.cameras[at(c.column.camera)].time_offset_s, 1e3);
      break;
    case CalibrationKind::kRadius: {
      const double radius = 0.5 * (wheels->radius_left_m + wheels->radius_right_m);
      set("m", radius, radius);
      break;
    }
    case CalibrationKind::kRadiusDifference: {
      const double mean = 0.5 * (wheels->radius_left_m + wheels->radius_right_m);
      set("%", 100.0 * (wheels->radius_right_m - wheels->radius_left_m) / mean, 100.0);
      break;
    }
    case CalibrationKind::kTrackWidth:
      set("m", wheels->track_width_m, wheels->track_width_m);
      break;
    case CalibrationKind::kWheelDelay:
      set("ms", -1e3 * wheels->time_offset_s, 1e3);
      break;
  }
  return v;
}

// "+- 0.52 deg" of a column, without its stated value.
std::string interval_text(const CalibratedColumn& c) {
  if (c.column.is_turn()) return "+- " + fixed(degrees(c.half_width), 2) + " deg";
  if (c.column.is_delay()) return "+- " + fixed(1e3 * c.half_width, 1) + " ms";
  return "+- " + fixed(100.0 * c.half_width, 2) + " %";
}

EffectSizes merged(EffectSizes effects, const EffectSizes& estimated) {
  for (const auto& [name, size] : estimated) effects[name] = size;
  return effects;
}

Map map_of_drives(const CalibrateRequest& request,
                  const EffectSizes& model,
                  Messages& messages,
                  std::vector<Problem>* warnings) {
  const TemporaryFolder folder;
  MapOptions options = request.options;
  options.covariances = false;
  options.gate.apart = true;  // a vehicle is calibrated from drives of any places
  options.model = model;
  const auto file = folder.path() / "calibration.gpkg";
  const MapSummary summary = build_map(request.drives, file, options, messages.progress());
  if (warnings != nullptr) *warnings = summary.warnings;
  return load_map(file);
}

}  // namespace

std::optional<Refused> refusal_of(const std::vector<CalibratedColumn>& columns,
                                  const std::filesystem::path& drive) {
  std::string got;
  std::string names;
  std::vector<std::string> manoeuvres;
  for (const CalibratedColumn& c : columns) {
    if (c.observable || !is_needed(c.column.kind)) continue;
    got += (got.empty() ? "" : ", ") + c.column.name + " " + interval_text(c);
    names += (names.empty() ? "" : ",") + c.column.name;
    const std::string manoeuvre = manoeuvre_for(c.column.kind);
    if (std::find(manoeuvres.begin(), manoeuvres.end(), manoeuvre) == manoeuvres.end())
      manoeuvres.push_back(manoeuvre);
  }
  if (got.empty()) return std::nullopt;
  std::string want;
  for (const std::string& manoeuvre : manoeuvres) want += (want.empty() ? "" : "; ") + manoeuvre;
  return Refused("error: " + drive.string() + ": calibration: got " + got +
                 " (95 %), want a drive in which they are observable: " + want + " (or --hold " +
                 names + ")");
}

CalibrateResult calibrate_drives(const CalibrateRequest& request, Messages& messages) {
  refuse_same_drives(request.drives);
  EffectSizes known;
  if (!request.model.empty()) known = read_effect_model(request.model);
  std::vector<Drive> drives;
  for (const auto& folder : request.drives) drives.push_back(Drive::open(folder));
  require_one_vehicle(drives);
  CalibrateResult result;
  CalibrationOptions options;
  options.held = request.held;
  const bool has_wheels = drives.front().wheel_model().has_value();
  const EffectSizes beyond =
      effects_beyond(calibration_columns(drives.front().rig(), has_wheels), known);
  if (!beyond.empty())
    for (Drive& drive : drives) drive.correct(beyond);
  const Rig rig = drives.front().rig();
  const auto wheels = drives.front().wheel_model();
  EffectSizes model = known;
  Eigen::VectorXd start;
  double before_px = 0.0;
  for (int mapping = 0; mapping < kMappings; ++mapping) {
    const bool from_file = mapping == 0 && !request.map.empty();
    const Map map = from_file ? load_map(request.map)
                              : map_of_drives(request, model, messages,
                                              mapping == 0 ? &result.warnings : nullptr);
    CalibrationData data = calibration_data(map, rig, sessions_of(map, drives));
    const auto columns = calibration_columns(rig, data.has_wheels());
    const Eigen::VectorXd values = column_values(columns, model);
    if (mapping == 0) start = values;
    const bool is_last = mapping + 1 == kMappings;
    result.calibration = is_last ? calibrate(data, values, options, messages.progress())
                                 : first_step(data, values, options);
    if (mapping == 0) before_px = result.calibration.reprojection_before_px;
    if (!result.calibration.usable)
      throw Refused("error: " + request.drives.front().string() +
                    ": calibration: got no solution, want a drive that can be mapped");
    model = merged(beyond, to_effects(result.calibration));
  }
  for (std::size_t i = 0; i < result.calibration.columns.size(); ++i)
    result.values.push_back(value_of(result.calibration.columns[i], start[index(i)], rig, wheels));
  result.calibration.reprojection_before_px = before_px;
  result.model = model;
  result.refusal = refusal_of(result.calibration.columns, request.drives.front());
  return result;
}

std::string calibrated_model_text(const CalibrateResult& result) {
  std::map<std::string, std::string> notes;
  for (const CalibratedValue& v : result.values)
    notes[v.column.column.name] =
        v.column.reference ? "the delays are relative to this one"
        : v.column.held    ? "held"
                           : "+- " + nlohmann::json(v.column.half_width).dump() + " (95 %)";
  std::string text = "effects:\n";
  for (const auto& [name, size] : result.model) {
    text += "  " + name + ": " + nlohmann::json(size).dump();
    const auto note = notes.find(name);
    text += (note == notes.end() ? std::string() : "  # " + note->second) + "\n";
  }
  return result.model.empty() ? "effects: {}\n" : text;
}

}  // namespace roadbook
