#include "apps/evaluation/sessions/session_study.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "apps/evaluation/simulated_visits.hpp"
#include "base/index.hpp"
#include "base/messages.hpp"
#include "base/random.hpp"
#include "mapping/pieces.hpp"
#include "mapping/similarity.hpp"
#include "mapping/store/map_file.hpp"
#include "vo/own_car_mask.hpp"
#include "workflows/localisation/localise_in_map.hpp"
#include "workflows/localisation/world_in_map.hpp"
#include "workflows/map_drives.hpp"

namespace roadbook {
namespace {

namespace fs = std::filesystem;

double process_cpu_s() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& t) {
    return static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

struct Timed {
  MapSummary summary;
  double cpu_s = 0.0;
};

Timed run_map(const std::vector<fs::path>& drives,
              const fs::path& map,
              std::optional<SessionAdjust> adjust,
              bool batch,
              int num_threads) {
  MapRequest request;
  request.drives = drives;
  request.map = map;
  request.adjust = adjust;
  request.batch = batch;
  request.options.num_threads = num_threads;
  NoMessages messages;
  const double start_s = process_cpu_s();
  Timed timed;
  timed.summary = map_drives(request, messages).summary;
  timed.cpu_s = process_cpu_s() - start_s;
  return timed;
}

SessionStep step_of(const Timed& timed, int visit, double alone_cpu_s, const fs::path& map) {
  SessionStep step;
  step.visit = visit;
  step.cpu_s = timed.cpu_s;
  step.alone_cpu_s = alone_cpu_s;
  for (const StageTime& stage : timed.summary.stages)
    step.peak_rss_mb = std::max(step.peak_rss_mb, stage.peak_rss_mb);
  step.localised_share = timed.summary.localised_share;
  step.landmarks = timed.summary.landmarks;
  step.map_frames = load_map(map).map_frames.size();
  step.bytes = fs::file_size(map);
  step.together_m = timed.summary.ate_median_m;
  // A build of one session has its error as the one of all together.
  if (timed.summary.truth_sessions.empty())
    step.sessions.push_back({timed.summary.ate_median_m, std::nullopt});
  for (const SessionTruth& session : timed.summary.truth_sessions)
    step.sessions.push_back(
        {session.ate_median_m,
         session.offset ? std::optional<double>(session.offset->shift_m.norm()) : std::nullopt});
  return step;
}

void add_held_out(const fs::path& map, const fs::path& drive, int num_threads, SessionStep& step) {
  LocaliseRequest request;
  request.drive = drive;
  request.map = map;
  request.options.tracking.num_threads = num_threads;
  NoMessages messages;
  const auto truth = localise_in_map(request, messages).figures.truth;
  if (!truth) return;
  step.held_out_m = truth->median_m;
  step.held_out_share = truth->recall_0_1_m;
}

std::vector<Eigen::Vector3d> places_of(const Map& map, const std::vector<std::string>& digests) {
  std::vector<Eigen::Vector3d> places;  // session by session in the order of `digests`
  for (const std::string& digest : digests)
    for (std::size_t k = 0; k < map.keyframes.size(); ++k)
      if (map.sessions[at(map.keyframes[k].session)].drive_digest == digest)
        places.push_back(map.T_map_vehicle(static_cast<int>(k)).translation());
  return places;
}

// Maps of the same visits in all orders must agree.
void compare_orders(const SimulatedVisits& visits,
                    const SessionStudyOptions& options,
                    const Progress& progress,
                    SessionStudy& study) {
  std::vector<int> order(at(options.order_visits));
  std::iota(order.begin(), order.end(), 0);
  std::vector<std::string> digests;
  std::vector<Eigen::Vector3d> reference;
  std::vector<double> off_m;
  for (study.orders = 0; study.orders < options.orders; ++study.orders) {
    const fs::path map = visits.file(options.place, "_order.gpkg");
    fs::remove(map);
    for (const int visit : order)
      (void)run_map({visits.drive(options.place, visit)}, map, SessionAdjust::kAll, false,
                    options.num_threads);
    const Map built = load_map(map);
    if (digests.empty())
      for (const Session& session : built.sessions) digests.push_back(session.drive_digest);
    const auto places = places_of(built, digests);
    if (reference.empty()) {
      reference = places;
    } else if (places.size() == reference.size()) {
      const Similarity T = align(reference, places, false);
      for (std::size_t i = 0; i < places.size(); ++i)
        off_m.push_back((T * places[i] - reference[i]).norm());
    }
    report(progress, "orders", at(study.orders) + 1, at(options.orders));
    if (!std::next_permutation(order.begin(), order.end())) {
      ++study.orders;
      break;
    }
  }
  if (off_m.empty()) return;
  std::sort(off_m.begin(), off_m.end());
  study.orders_worst_m = off_m.back();
  study.orders_median_m = off_m[off_m.size() / 2];
}

// A share of the landmarks gets the descriptor of another landmark, as if something else that the
// place knows had taken its place.
Map outdated_map(const Map& map, double share, std::uint64_t seed) {
  Random random(seed, "outdated landmarks");
  Map outdated = map;
  const auto count = static_cast<std::uint64_t>(map.landmarks.size());
  for (Landmark& landmark : outdated.landmarks)
    if (random.uniform() < share)
      landmark.descriptor = map.landmarks[static_cast<std::size_t>(random.below(count))].descriptor;
  return outdated;
}

void add_outdated(const SimulatedVisits& visits,
                  const fs::path& map_file,
                  const SessionStudyOptions& options,
                  const Progress& progress,
                  SessionStudy& study) {
  const Map map = load_joined_map(map_file);
  const Drive drive = Drive::open(visits.drive(options.place, options.visits));
  const OwnCar car = find_own_car(drive, std::nullopt, options.num_threads);
  const auto T_map_world = world_in_map(map_file, map, drive);
  if (!T_map_world) return;
  LocaliseDriveOptions localise;
  localise.tracking.num_threads = options.num_threads;
  for (int tenth = 0; tenth <= 9; ++tenth) {
    OutdatedStep step;
    step.share = 0.1 * tenth;
    const Map outdated = outdated_map(map, step.share, options.seed);
    const LandmarkIndex index(outdated);
    const auto frames = localise_drive(drive, car.masks, index, localise);
    const auto off_m = localisation_errors(frames, drive.truth(), *T_map_world);
    std::vector<double> known;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const auto status = frames[i].pose.status;
      if (status != LocalisationStatus::kLocalised && status != LocalisationStatus::kRelocalised)
        continue;
      step.localised += 1.0;
      if (std::isnan(off_m[i])) continue;
      known.push_back(off_m[i]);
      (off_m[i] <= 0.3 ? step.right : step.wrong) += 1.0;
    }
    for (double* value : {&step.localised, &step.right, &step.wrong})
      *value /= static_cast<double>(frames.size());
    if (!known.empty()) {
      std::nth_element(known.begin(), known.begin() + static_cast<std::ptrdiff_t>(known.size() / 2),
                       known.end());
      step.median_m = known[known.size() / 2];
    }
    study.outdated.push_back(step);
    report(progress, "outdated", at(tenth) + 1, 10);
  }
}

}  // namespace

SessionStudy session_study(const fs::path& folder,
                           const SessionStudyOptions& options,
                           const Progress& progress) {
  const SimulatedVisits visits{folder, options.size, options.image_scale, options.seed,
                               options.num_threads};
  std::vector<fs::path> drives;
  std::vector<double> alone_cpu_s;
  for (int visit = 0; visit <= options.visits; ++visit)
    drives.push_back(visits.drive(options.place, visit, progress));
  const fs::path held_out = drives.back();
  drives.pop_back();
  for (std::size_t v = 0; v < drives.size(); ++v) {
    const fs::path map = visits.file(options.place, "_alone" + std::to_string(v) + ".gpkg");
    fs::remove(map);
    alone_cpu_s.push_back(
        run_map({drives[v]}, map, std::nullopt, false, options.num_threads).cpu_s);
    report(progress, "maps of one visit", v + 1, drives.size());
  }
  SessionStudy study;
  struct Kind {
    std::string name;
    std::optional<SessionAdjust> adjust;
    bool batch;
  };
  const std::array<Kind, 4> kinds{{{"near", SessionAdjust::kNear, false},
                                   {"all", SessionAdjust::kAll, false},
                                   {"none", SessionAdjust::kNone, false},
                                   {"batch", std::nullopt, true}}};
  for (const Kind& kind : kinds) {
    SessionChain chain{kind.name, {}};
    const fs::path map = visits.file(options.place, "_" + kind.name + ".gpkg");
    fs::remove(map);
    for (std::size_t v = 0; v < drives.size(); ++v) {
      // All recordings at once is the judge of the end: it is built for the first ones and the
      // last.
      if (kind.batch && v > 1 && v + 1 < drives.size()) continue;
      const std::vector<fs::path> given =
          kind.batch ? std::vector<fs::path>(drives.begin(),
                                             drives.begin() + static_cast<std::ptrdiff_t>(v) + 1)
                     : std::vector<fs::path>{drives[v]};
      const Timed timed = run_map(given, map, kind.adjust, kind.batch, options.num_threads);
      SessionStep step = step_of(timed, static_cast<int>(v), alone_cpu_s[v], map);
      add_held_out(map, held_out, options.num_threads, step);
      chain.steps.push_back(std::move(step));
      report(progress, "sessions, " + kind.name, v + 1, drives.size());
    }
    study.chains.push_back(std::move(chain));
  }
  compare_orders(visits, options, progress, study);
  add_outdated(visits, visits.file(options.place, "_alone0.gpkg"), options, progress, study);
  return study;
}

}  // namespace roadbook
