#include "tests/diagnosis/hidden_views/view_injector.hpp"

#include <algorithm>
#include <cmath>

#include "base/random.hpp"
#include "drive/writer.hpp"
#include "mapping/store/map_file_builder.hpp"
#include "tests/diagnosis/hidden_views/view_world.hpp"
#include "tests/diagnosis/hidden_views/visits.hpp"

namespace roadbook::test {
namespace {

constexpr std::int64_t kStart = 1'500'000'000'000'000'000LL;
constexpr int kWidth = 1280;
constexpr int kHeight = 800;

Rig stated_rig() {
  Rig rig;
  const auto cameras = nominal_cameras();
  for (std::size_t c = 0; c < cameras.size(); ++c) {
    const OwnLens& lens = cameras[c].lens;
    MountedCamera mounted;
    mounted.name = "cam" + std::to_string(c);
    mounted.camera.model = CameraModel::kKannalaBrandt;
    mounted.camera.width = kWidth;
    mounted.camera.height = kHeight;
    mounted.camera.parameters = {lens.focal, lens.focal, lens.centre_u, lens.centre_v,
                                 lens.k1,    lens.k2,    lens.k3,       lens.k4};
    mounted.camera.max_angle_rad = 1.6;
    mounted.T_vehicle_camera.linear() = cameras[c].axes;
    mounted.T_vehicle_camera.translation() = cameras[c].place;
    rig.cameras.push_back(mounted);
  }
  return rig;
}

// Images come at 12.5 Hz. An image becomes a keyframe if the car has moved far enough since the
// previous keyframe.
std::vector<double> keyframe_times(const std::vector<Moment>& drive) {
  std::vector<double> times;
  const double end_s = kTick * static_cast<double>(drive.size() - 1);
  Moment last;
  for (int k = 1; 0.08 * k < end_s - 0.3; ++k) {
    const Moment now = moment_at(drive, 0.08 * k);
    if (now.distance < 0.5) continue;
    if (!times.empty() && now.distance - last.distance < 0.2 &&
        std::abs(now.turned - last.turned) < 0.0873)
      continue;
    times.push_back(0.08 * k);
    last = now;
  }
  return times;
}

// Pixel of a landmark in an image stamped t: the row decides when it was read out.
std::optional<Eigen::Vector2d> look(const OwnCamera& camera,
                                    const OwnMotion& motion,
                                    const Eigen::Vector3d& place,
                                    double t_s) {
  double row = 0.5 * kHeight;
  std::optional<Eigen::Vector2d> pixel;
  for (int round = 0; round < (camera.shutter_s == 0.0 ? 1 : 4); ++round) {
    const double share = (row + 0.5) / kHeight - 0.5;
    const Eigen::Isometry3d body = motion.body(t_s - camera.latency_s + share * camera.shutter_s);
    const Eigen::Vector3d p = camera.axes.transpose() * (body.inverse() * place - camera.place);
    if (p.norm() < 0.6) return std::nullopt;
    pixel = camera.lens.see(p);
    if (!pixel) return std::nullopt;
    row = std::clamp(pixel->y(), 0.0, kHeight - 1.0);
  }
  const bool inside = pixel->x() > 4.0 && pixel->x() < kWidth - 5.0 && pixel->y() > 4.0 &&
                      pixel->y() < kHeight - 5.0;
  return inside ? pixel : std::nullopt;
}

Eigen::Isometry3d shaken(const Eigen::Isometry3d& T, Random& random) {
  Vector6d xi;
  for (int i = 0; i < 6; ++i) xi[i] = (i < 3 ? 0.01 : 0.001) * random.normal();
  return T * se3_exp(xi);
}

// First-order process of unit variance with coefficient 0.9.
class Wander {
 public:
  explicit Wander(Random random) : random_(random), now_(fresh()) {}
  Eigen::Vector2d next() {
    constexpr double kAsBefore = 0.9;
    now_ = kAsBefore * now_ + std::sqrt(1.0 - kAsBefore * kAsBefore) * fresh();
    return now_;
  }

 private:
  Eigen::Vector2d fresh() { return {random_.normal(), random_.normal()}; }
  Random random_;
  Eigen::Vector2d now_;
};

// Error common to a whole image.
struct ImageError {
  Eigen::Vector2d shift;
  Eigen::Matrix2d about_middle;
  [[nodiscard]] Eigen::Vector2d at(const Eigen::Vector2d& pixel) const {
    return shift + about_middle * (pixel - Eigen::Vector2d(640.0, 400.0));
  }
};

// One for each keyframe.
std::vector<ImageError> image_errors(const HiddenViewOptions& options,
                                     std::size_t keyframes,
                                     std::size_t camera) {
  Wander shifts(Random(options.seed, "image shifts", camera));
  Wander turns(Random(options.seed, "image turns", camera));
  std::vector<ImageError> errors;
  for (std::size_t k = 0; k < keyframes; ++k) {
    ImageError& error = errors.emplace_back();
    error.shift = options.images_shift_px * shifts.next();
    const Eigen::Vector2d turn = options.images_turn * turns.next();
    error.about_middle << turn.x(), -turn.y(), turn.y(), turn.x();
  }
  return errors;
}

// One drive through the place, with its own random streams.
struct Visit {
  std::string name = "drive";
  std::string views = "views";
  std::string poses = "map";
  std::int64_t start_ns = kStart;
};

HiddenSights sights_of(const HiddenViewOptions& options,
                       const OwnMotion& motion,
                       const std::vector<double>& times,
                       const std::vector<OwnLandmark>& landmarks,
                       const Visit& visit,
                       int first_keyframe) {
  const auto cameras = hidden_cameras(options.secret);
  Random random(options.seed, visit.views);
  const double sigma_px = random.uniform(0.3, 0.5);
  std::vector<double> travelled;
  for (const double t : times) travelled.push_back(moment_at(motion.drive(), t).distance);
  std::vector<std::vector<ImageError>> images;
  for (std::size_t c = 0; c < cameras.size(); ++c)
    images.push_back(image_errors(options, times.size(), c));
  HiddenSights all;
  for (const OwnLandmark& l : landmarks) {
    HiddenSight sight;
    std::vector<Wander> corner;
    for (std::size_t c = 0; c < cameras.size(); ++c)
      corner.emplace_back(Random(options.seed, "corners", cameras.size() * all.size() + c));
    const auto first = std::lower_bound(travelled.begin(), travelled.end(), l.near_m - l.reach_m);
    for (auto at = first; at != travelled.end() && *at < l.near_m + l.reach_m; ++at) {
      const auto k = static_cast<std::size_t>(at - travelled.begin());
      for (std::size_t c = 0; c < cameras.size(); ++c) {
        const Eigen::Vector2d wander = options.corners_wander_px * corner[c].next();
        const auto pixel = look(cameras[c], motion, l.place, times[k]);
        if (!pixel || random.uniform() < 0.1) continue;
        const Eigen::Vector2d off = images[c][k].at(*pixel) + wander;
        Observation o;
        o.keyframe = first_keyframe + static_cast<int>(k);
        o.camera = static_cast<int>(c);
        const bool wrong = random.uniform() < options.outliers;
        const double spread = wrong ? 15.0 : sigma_px;
        o.pixel = (*pixel + off + spread * Eigen::Vector2d(random.normal(), random.normal()))
                      .cast<float>();
        o.sigma_px = 1.2F;
        sight.views.push_back(o);
      }
    }
    if (sight.views.size() < 4) sight.views.clear();
    if (!sight.views.empty())
      sight.rough = 0.02 * Eigen::Vector3d(random.normal(), random.normal(), random.normal());
    all.push_back(sight);
  }
  return all;
}

void add_visit(const HiddenViewOptions& options,
               const OwnMotion& motion,
               const WheelModel& wheels,
               const std::vector<double>& times,
               const Visit& visit,
               Map& map) {
  Session session;
  session.name = visit.name;
  session.drive_path = visit.name;
  session.rig = stated_rig();
  session.wheels = wheels;
  session.scale_source = ScaleSource::kWheels;
  session.t_begin_ns = visit.start_ns;
  session.t_end_ns = visit.start_ns + std::llround(1e9 * times.back());
  map.sessions.push_back(session);
  Random random(options.seed, visit.poses);
  for (std::size_t k = 0; k < times.size(); ++k) {
    Keyframe keyframe;
    keyframe.session = static_cast<int>(map.sessions.size()) - 1;
    keyframe.t_ns = visit.start_ns + std::llround(1e9 * times[k]);
    keyframe.drive_frame = static_cast<int>(k);
    keyframe.map_frame = static_cast<int>(map.map_frames.size());
    keyframe.travelled_m = moment_at(motion.drive(), times[k]).distance;
    map.map_frames.push_back({shaken(motion.body(times[k]), random)});
    map.keyframes.push_back(keyframe);
  }
}

Map make_map(const HiddenViewOptions& options,
             const OwnMotion& motion,
             const WheelModel& wheels,
             std::vector<GoneClump>& gone) {
  Map map;
  const std::vector<double> times = keyframe_times(motion.drive());
  std::vector<OwnLandmark> landmarks = scatter_landmarks(options, motion);
  const auto add = [&](const Visit& visit) {
    const auto first = static_cast<int>(map.keyframes.size());
    add_visit(options, motion, wheels, times, visit, map);
    return sights_of(options, motion, times, landmarks, visit, first);
  };
  if (!options.earlier) {
    const HiddenSights sights = add({});
    for (std::size_t l = 0; l < landmarks.size(); ++l)
      add_landmark(landmarks[l], {&sights[l]}, map);
  } else {
    const HiddenSights then =
        add({"earlier", "earlier views", "earlier map", kStart - 86'400'000'000'000LL});
    const std::vector<OwnLandmark> before = landmarks;
    move_landmarks(options, landmarks);
    HiddenSights now = add({});
    gone = remove_landmarks(options, landmarks, then, now);
    join_visits(options, before, then, landmarks, now, map);
    bend_map(options, map);
  }
  std::stable_sort(map.observations.begin(), map.observations.end(),
                   [](const Observation& a, const Observation& b) {
                     return std::pair(a.keyframe, a.camera) < std::pair(b.keyframe, b.camera);
                   });
  return map;
}

}  // namespace

void write_hidden_views(const HiddenViewOptions& options, const std::filesystem::path& folder) {
  HiddenDriveOptions streams;
  streams.seed = options.seed;
  streams.length_m = options.length_m;
  streams.secret = options.secret;
  const Recording recording = record_drive(streams);
  DriveWriterOptions writing;
  writing.wheel_rate_hz = 50.0;
  writing.overwrite = true;
  DriveWriter writer(folder / "drive", {},
                     options.wheels ? std::optional(recording.wheel_model) : std::nullopt, writing);
  for (std::size_t i = 0; options.wheels && i < recording.wheels.size(); ++i)
    writer.write_wheels(recording.wheels[i]);
  for (std::size_t i = 0; options.imu && i < recording.imu.size(); ++i)
    writer.write_imu(recording.imu[i]);
  // Camera effects do not change the reference poses.
  std::erase_if(streams.secret, [](const auto& effect) {
    return effect.first.starts_with("cam") || effect.first.starts_with("rig");
  });
  if (options.reference) writer.write_truth(record_drive(streams).poses);
  writer.finish();
  const WheelModel& wheels = recording.wheel_model;
  const OwnMotion motion(options,
                         drive_car_park(options.seed, options.length_m, wheels.wheelbase_m, false),
                         wheels.wheelbase_m, wheels.track_width_m);
  const std::filesystem::path file = folder / "map.gpkg";
  std::filesystem::remove(file);
  MapFileBuilder build(file, "hidden views");
  MapFinishOptions finish;
  finish.max_landmark_points = 0;
  std::vector<GoneClump> gone;
  build.finish(make_map(options, motion, wheels, gone), {}, finish);
  write_gone(gone, folder / "gone.csv");
}

const std::vector<EffectRange>& practical_view_ranges() {
  static const std::vector<EffectRange> kRanges = [] {
    std::vector<EffectRange> ranges;
    const std::vector<EffectRange> camera{
        {"focal", 0.002, 0.01},          {"centre", 1.0, 5.0},     {"distortion", 0.0008, 0.005},
        {"rotation", 0.0017, 0.017},     {"position", 0.01, 0.10}, {"latency", 0.005, 0.04},
        {"rolling_shutter", 0.01, 0.03}, {"pitch", 0.0017, 0.017}, {"roll", 0.0017, 0.017},
        {"lateral", 0.01, 0.10},         {"height", 0.01, 0.05},   {"aspect", 0.002, 0.01},
        {"centre_x", 1.0, 5.0},          {"centre_y", 1.0, 5.0},   {"distortion2", 0.0004, 0.003}};
    for (const EffectRange& r : camera) {
      ranges.push_back({"cam1." + r.name, r.low, r.high});
      ranges.push_back({"cam." + r.name, r.low, r.high});
    }
    for (const char* turn : {"rig.rotation", "rig.pitch", "rig.roll"})
      ranges.push_back({turn, 0.0035, 0.0175});
    for (const EffectRange& r : practical_ranges())
      // Views show neither wet patches nor a locked axle nor wheel noise.
      if (r.name.starts_with("wheels0.") && r.name != "wheels0.wet_patch" &&
          r.name != "wheels0.locked_axle" && r.name != "wheels0.outliers" &&
          !r.name.starts_with("wheels0.variance"))
        ranges.push_back(r);
    ranges.push_back({"ground.height", 0.01, 0.03});
    ranges.push_back({"ground.slope", 0.003, 0.02});
    ranges.push_back({"ground.hinge", 0.017, 0.052});
    return ranges;
  }();
  return kRanges;
}

const std::vector<EffectRange>& practical_map_ranges() {
  static const std::vector<EffectRange> kRanges{{"map.moved_landmarks", 0.02, 0.2, true},
                                                {"map.landmarks_gone", 0.01, 0.1, true},
                                                {"map.scale", 0.003, 0.02},
                                                {"map.bend", 5e-5, 3e-4}};
  return kRanges;
}

}  // namespace roadbook::test
