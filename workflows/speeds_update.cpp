#include "workflows/speeds_update.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/error.hpp"
#include "exchange/layers/path_layers.hpp"
#include "speedmap/presence/presence_map.hpp"
#include "workflows/layers/slow_by_items.hpp"

namespace roadbook {
namespace {

constexpr double kDay_s = 86400.0;

PresenceGrid lane_grid(const SpeedSources& sources, const SpeedsConfig& config) {
  std::vector<GridLane> lanes;
  for (const LanePath& path : sources.paths) {
    if (path.status == LanePathStatus::kDegenerate) continue;
    const PathCurve curve(path.path);
    GridLane lane{{}, std::max(path.width_m, config.speed.vehicle_width_m)};
    for (const double s : even_places(curve, 1.0)) lane.centre.push_back(curve.at(s).position);
    if (curve.closed()) lane.centre.push_back(lane.centre.front());
    lanes.push_back(std::move(lane));
  }
  if (lanes.empty()) throw Refused("error: lanes: got none with a path, want at least one");
  return {lanes, sources.spaces, sources.crossings, config.presence};
}

const Session* find_session(const Map& map, const std::string& name, int& index) {
  for (std::size_t i = 0; i < map.sessions.size(); ++i)
    if (map.sessions[i].name == name) {
      index = static_cast<int>(i);
      return &map.sessions[i];
    }
  return nullptr;
}

class Builder {
 public:
  Builder(const Map& map,
          SpeedSources sources,
          const SpeedsConfig& config,
          std::int64_t now_ns,
          LocalUpdate* local)
      : map_(map),
        sources_(std::move(sources)),
        config_(config),
        grid_(lane_grid(sources_, config)),
        local_(local),
        items_(sources_.items, now_ns, config.speed),
        presence_(presence_of_grid()) {
    result_.cell_m = config.presence.cell_m;
    result_.now_ns = now_ns;
    result_.options = config.speed;
    result_.paths = paths_digest(sources_.paths);
    for (std::size_t i = 0; i < grid_.size(); ++i) {
      SpeedCell cell;
      cell.centre = grid_.centres()[i];
      cell.place = grid_.place_class(i);
      cell.prior = config.presence.priors[static_cast<std::size_t>(cell.place)].presence;
      result_.cells.push_back(cell);
    }
  }

  VisitSummary add_visit(const SessionSightings& sightings) {
    int index = 0;
    const Session* session = find_session(map_, sightings.session, index);
    ROADBOOK_ASSERT(session != nullptr);
    const AgedItem item{"people " + session->name, session->t_end_ns,
                        config_.visit_half_life_days * kDay_s};
    result_.ages.put(item);
    result_.sessions.push_back(session->name);
    result_.date_ns = std::max(result_.date_ns, session->t_end_ns);
    VisitSummary summary;
    summary.session = session->name;
    summary.weight = item.weight(result_.now_ns);
    const auto frames = visit_frames(SessionTrack(map_, index), sightings, summary);
    const VisitEvidence evidence =
        gather_evidence(grid_, frames, sightings.blockers, config_.sight);
    summary.people = evidence.people;
    summary.off_map = evidence.people_off_map;
    presence_.add(observations_of(grid_, evidence, frames, config_.sight, summary.weight));
    for (std::size_t i = 0; i < grid_.size(); ++i) {
      SpeedCell& cell = result_.cells[i];
      cell.seen_s += evidence.seen_s[i];
      cell.person_s += evidence.person_s[i];
      if (evidence.seen_s[i] <= 0.0) continue;
      ++cell.visits;
      cell.newest_ns = std::max(cell.newest_ns, session->t_end_ns);
    }
    return summary;
  }

  SpeedMap finish() {
    add_ages();
    if (local_ != nullptr)
      local_->solved = presence_.resume().solved;
    else
      presence_.solve();
    const Eigen::VectorXd variances = presence_.variances();
    for (std::size_t i = 0; i < grid_.size(); ++i) {
      result_.cells[i].presence = presence_.presence()[static_cast<Eigen::Index>(i)];
      result_.cells[i].sigma = std::sqrt(variances[static_cast<Eigen::Index>(i)]);
    }
    // Friction and the limits of lanes need `strips_`.
    strips_.emplace(sources_.paths, 1.0, 2.0);
    for (SpeedCell& cell : result_.cells) set_speed(cell);
    add_profiles();
    for (SpeedCell& cell : result_.cells) slow_in_bends(cell);
    if (!items_.empty()) slow_by_items(result_, items_, sources_.friction);
    return std::move(result_);
  }

 private:
  // Starts from the earlier solution if it has the same places.
  PresenceMap presence_of_grid() const {
    if (local_ == nullptr) return PresenceMap(grid_.graph());
    Eigen::VectorXd x(static_cast<Eigen::Index>(grid_.size()));
    const auto& cells = local_->earlier->cells;
    bool same = cells.size() == grid_.size();
    for (std::size_t i = 0; i < grid_.size() && same; ++i) {
      same = (cells[i].centre - grid_.centres()[i]).norm() < 1e-6;
      x[static_cast<Eigen::Index>(i)] = cells[i].presence;
    }
    return same ? PresenceMap(grid_.graph(), std::move(x)) : PresenceMap(grid_.graph());
  }

  void add_ages() {
    std::int64_t newest = 0;
    for (const Session& session : map_.sessions) newest = std::max(newest, session.t_end_ns);
    result_.ages.put({"lanes", newest, 0.0});
    result_.ages.put({"spaces and crossings", newest, 0.0});
    if (result_.date_ns == 0) result_.date_ns = newest;
    if (!sources_.friction) return;
    FrictionMap& friction = *sources_.friction;
    result_.ages.put({"friction", friction.date_ns, config_.friction_half_life_days * kDay_s});
    if (result_.now_ns > friction.date_ns)
      friction.map.forget(1e-9 * static_cast<double>(result_.now_ns - friction.date_ns));
  }

  void set_speed(SpeedCell& cell) {
    const LaneSpeedOptions& speed = config_.speed;
    cell.pedestrian = recommended_speed(cell.presence + speed.caution * cell.sigma, speed.min_speed,
                                        speed.max_speed);
    cell.grip = INFINITY;
    double limit = speed.max_speed;
    double grip_sigma = 0.0;
    if (!config_.limits.empty()) {
      strips_->places_of(cell.centre, places_);
      for (const PathPlace& place : places_)
        limit = std::min(limit, config_.limit_of(strips_->strip_of(place).lane));
    }
    if (sources_.friction) {
      sources_.friction->strips.places_of(cell.centre, places_);
      for (const PathPlace& place : places_)
        if (const auto moments = sources_.friction->map.moments(0, place)) {
          const GripSpeed grip = grip_speed_of(*moments, 0.0, speed);
          if (!(grip.speed < cell.grip)) continue;
          cell.grip = grip.speed;
          grip_sigma = grip.sigma;
        }
    }
    if (!std::isfinite(cell.grip) && speed.unknown_grip > 0.0)
      cell.grip = grip_speed(speed.unknown_grip, 0.0, speed);
    cell.speed = std::min({limit, cell.pedestrian, cell.grip});
    cell.speed_sigma = (speed.max_speed - speed.min_speed) * cell.sigma;
    if (cell.grip < cell.pedestrian) cell.speed_sigma = grip_sigma;
    if (limit < std::min(cell.grip, cell.pedestrian)) cell.speed_sigma = 0.0;
  }

  // The cells of a lane are no faster than its bends allow, because a vehicle that follows the map
  // follows the lane.
  void slow_in_bends(SpeedCell& cell) {
    strips_->places_of(cell.centre, places_);
    for (const PathPlace& place : places_) {
      const LaneStrips::Strip& strip = strips_->strip_of(place);
      for (const LaneProfile& profile : result_.profiles) {
        if (profile.lane != strip.lane) continue;
        const auto k =
            std::clamp<std::ptrdiff_t>(std::lround((place.s_m - strip.begin_m) / profile.step_m), 0,
                                       static_cast<std::ptrdiff_t>(profile.places.size()) - 1);
        const double bend = profile.places[static_cast<std::size_t>(k)].bend;
        if (!(bend < cell.speed)) continue;
        cell.speed = bend;
        cell.speed_sigma = 0.0;
      }
    }
  }

  void add_profiles() {
    const PresenceAt presence = [this](const Eigen::Vector2d& p) -> std::optional<PresenceValue> {
      const auto node = grid_.node_at(p);
      if (!node) return std::nullopt;
      const SpeedCell& cell = result_.cells[static_cast<std::size_t>(*node)];
      return PresenceValue{cell.presence, cell.sigma * cell.sigma};
    };
    for (const LanePath& path : sources_.paths) {
      if (path.status == LanePathStatus::kDegenerate) continue;
      const PathCurve curve(path.path);
      LaneProfile profile;
      profile.lane = path.lane;
      profile.closed = curve.closed();
      for (const Lane& lane : sources_.network.lanes)
        if (lane.id == path.lane) {
          profile.from_intersection = lane.from_intersection;
          profile.to_intersection = lane.to_intersection;
        }
      const auto s = even_places(curve, config_.speed.step_m);
      profile.step_m = s[1] - s[0];
      FrictionAt friction;
      if (sources_.friction)
        if (const LaneStrips::Strip* strip = sources_.friction->strips.find(path.lane))
          friction = [this, begin_m = strip->begin_m](double at_m, double e_m) {
            return sources_.friction->map.moments(0, {begin_m + at_m, e_m});
          };
      profile.places = speed_limits_along(way_points(curve, s), s, config_.limit_of(path.lane),
                                          presence, friction, config_.speed);
      make_feasible(profile.places, profile.step_m, profile.closed, config_.speed);
      result_.profiles.push_back(std::move(profile));
    }
    agree_at_intersections(result_.profiles, config_.speed);
  }

  const Map& map_;
  SpeedSources sources_;
  const SpeedsConfig& config_;
  PresenceGrid grid_;
  LocalUpdate* local_;
  ItemEffects items_;
  PresenceMap presence_;
  std::optional<LaneStrips> strips_;
  std::vector<PathPlace> places_;
  SpeedMap result_;
};

}  // namespace

std::vector<VisitFrame> visit_frames(const SessionTrack& track,
                                     const SessionSightings& sightings,
                                     VisitSummary& summary) {
  constexpr std::int64_t kNear_ns = 250'000'000;
  const std::vector<Detection>& detections = sightings.detections;
  std::map<std::int64_t, const Look*> looks;
  for (const Look& look : sightings.looks) looks[look.t_ns] = &look;
  constexpr double kLongest_s = 1.0;
  std::set<std::int64_t> times;
  for (const Detection& detection : detections) times.insert(detection.t_ns);
  const std::set<std::int64_t> of_people = times;
  for (const auto& [t, look] : looks) times.insert(t);
  for (const std::int64_t t : looks.empty() ? track.stamps() : std::vector<std::int64_t>{}) {
    const auto next = of_people.lower_bound(t - kNear_ns);
    if (next == of_people.end() || *next > t + kNear_ns) times.insert(t);
  }
  std::vector<VisitFrame> frames;
  std::size_t at = 0;
  for (auto t = times.begin(); t != times.end(); ++t) {
    const auto T = track.at(*t);
    VisitFrame frame;
    const auto following = std::next(t);
    frame.duration_s = following == times.end()
                           ? 0.1
                           : std::min(kLongest_s, 1e-9 * static_cast<double>(*following - *t));
    if (T) {
      frame.position = T->translation().head<2>();
      frame.heading = heading_of(*T);
    }
    if (const auto look = looks.find(*t); look != looks.end())
      for (const std::uint8_t reach : look->second->reach_dm) frame.reach_m.push_back(0.1 * reach);
    for (; at < detections.size() && detections[at].t_ns == *t; ++at) {
      const Detection& seen = detections[at];
      if (!T) {
        ++summary.without_pose;
        continue;
      }
      frame.people.push_back({(*T * Eigen::Vector3d(seen.x_m, seen.y_m, 0.0)).head<2>(),
                              seen.sigma_m, seen.probability});
    }
    if (T) frames.push_back(std::move(frame));
  }
  summary.frames = frames.size();
  return frames;
}

SpeedMap make_speed_map(const Map& map,
                        SpeedSources sources,
                        const SpeedsConfig& config,
                        std::int64_t now_ns,
                        std::vector<VisitSummary>& visits,
                        LocalUpdate* local) {
  config.check();
  const std::vector<SessionSightings> sightings = sources.sightings;
  Builder builder(map, std::move(sources), config, now_ns, local);
  for (const SessionSightings& one : sightings) visits.push_back(builder.add_visit(one));
  return builder.finish();
}

}  // namespace roadbook
