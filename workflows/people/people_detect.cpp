#include "workflows/people/people_detect.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/parallel.hpp"
#include "mapping/session_car.hpp"
#include "mapping/session_track.hpp"

namespace roadbook {
namespace {

double quantile(std::vector<double> values, double part) {
  if (values.empty()) return 0.0;
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

double part_of(std::size_t part, std::size_t whole) {
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole)
                   : std::numeric_limits<double>::quiet_NaN();
}

Detection detection_of(const PlacedPerson& person, const PersonCamera& camera, std::int64_t t_ns) {
  const Eigen::Matrix2d& C = person.covariance;
  const Eigen::Vector3d eye = camera.mounted().T_vehicle_camera.translation();
  return {t_ns,
          person.foot.x(),
          person.foot.y(),
          std::sqrt(0.5 * C.trace()),
          person.probability,
          {C(0, 0), C(0, 1), C(1, 1)},
          std::array{eye.x(), eye.y()}};
}

}  // namespace

PeopleDetectOptions::PeopleDetectOptions() {
  learner.classifier.scale = 2.0;  // near the usual maximum of the marginal likelihood
}

double PeopleScore::precision() const { return part_of(right, right + wrong); }
double PeopleScore::recall() const { return part_of(right, people); }
double PeopleScore::median_error_m() const { return quantile(foot_error_m, 0.5); }
double PeopleScore::calibration_error() const { return roadbook::calibration_error(said); }
void PeopleScore::add(const PeopleScore& other) {
  people += other.people;
  right += other.right;
  wrong += other.wrong;
  foot_error_m.insert(foot_error_m.end(), other.foot_error_m.begin(), other.foot_error_m.end());
  mahalanobis2.insert(mahalanobis2.end(), other.mahalanobis2.begin(), other.mahalanobis2.end());
  said.insert(said.end(), other.said.begin(), other.said.end());
}

PeopleScore score_instant(const std::vector<PlacedPerson>& people,
                          const PeopleTruth::Instant& truth,
                          double same_overlap) {
  PeopleScore score;
  std::vector<bool> wanted(truth.feet.size(), false);
  for (std::size_t i = 0; i < truth.people.size(); ++i)
    if (truth.people[i].clear) wanted[static_cast<std::size_t>(truth.who[i])] = true;
  score.people = static_cast<std::size_t>(std::count(wanted.begin(), wanted.end(), true));
  std::vector<bool> taken(truth.feet.size(), false);
  for (const PlacedPerson& person : people) {
    int who = -1;
    double best = same_overlap;
    for (std::size_t i = 0; i < truth.people.size(); ++i) {
      const double overlap = intersection_over_union(person.box, truth.people[i].box);
      if (overlap < best || taken[static_cast<std::size_t>(truth.who[i])]) continue;
      best = overlap;
      who = truth.who[i];
    }
    score.said.emplace_back(person.probability, who >= 0);
    if (who < 0) {
      ++score.wrong;
      continue;
    }
    const auto w = static_cast<std::size_t>(who);
    taken[w] = true;
    if (!wanted[w]) continue;
    ++score.right;
    const Eigen::Vector2d d = person.foot - truth.feet[w];
    score.foot_error_m.push_back(d.norm());
    score.mahalanobis2.push_back(d.dot(person.covariance.inverse() * d));
  }
  return score;
}

PeopleSession::PeopleSession(const Map& map,
                             int session,
                             const Drive& drive,
                             const GroundModel& ground,
                             const PeopleDetectOptions& options)
    : map_(map), session_(session), drive_(drive), ground_(ground), options_(options) {
  const Session& recorded = map.sessions[static_cast<std::size_t>(session)];
  const auto masks =
      own_car_of(recorded, drive, options.vehicle, options.learner.num_threads).masks;
  const Rig& rig = recorded.rig;
  for (std::size_t c = 0; c < rig.cameras.size(); ++c)
    cameras_.emplace_back(rig.cameras[c], c < masks.size() ? masks[c] : cv::Mat());
  const SessionTrack track(map, session);
  std::int64_t next = std::numeric_limits<std::int64_t>::min();
  for (std::size_t f = 0; f < drive.frame_count(); ++f) {
    const std::int64_t t = drive.frame_stamp_ns(f);
    if (t < next) continue;
    const auto T = track.at(t);
    if (!T) continue;
    instants_.push_back({f, t, *T});
    next = t + static_cast<std::int64_t>(1e9 * options.every_s) - 1'000'000;
  }
}

PeopleFrame PeopleSession::read(const Instant& instant) const {
  PeopleFrame frame;
  frame.images.resize(cameras_.size());
  parallel_for(cameras_.size(), options_.learner.num_threads, [&](std::size_t c) {
    if (!drive_.has_image(instant.frame, c)) return;
    const cv::Mat grey = drive_.read_image(instant.frame, c);
    if (!grey.empty()) frame.images[c] = image_pyramid(grey);
  });
  return frame;
}

std::vector<PersonRound> PeopleSession::play(const PeopleTruth& truth,
                                             PersonLearner& learner,
                                             PersonRound total,
                                             const Progress& progress) const {
  const PersonSearchOptions& search = options_.learner.search;
  std::vector<PersonRound> rounds;
  std::vector<PeopleFrame> frames;
  std::vector<std::vector<TruePerson>> people;
  const std::string& recording = map_.sessions[static_cast<std::size_t>(session_)].drive_digest;
  std::size_t populated = 0;
  std::size_t empty = 0;
  for (std::size_t i = 0; i < instants_.size(); ++i) {
    report(progress, "learn", i, instants_.size());
    auto there = truth.at(instants_[i].t_ns, cameras_, search.min_range_m, search.max_range_m);
    // A labeller visits the places with people, and collects negative examples at as many other
    // places.
    if (there.people.empty() && empty >= populated) continue;
    ++(there.people.empty() ? empty : populated);
    frames.push_back(read(instants_[i]));
    frames.back().name = recording + ' ' + std::to_string(instants_[i].t_ns);
    people.push_back(std::move(there.people));
    if (frames.size() < options_.batch) continue;
    total = play_person_round(frames, people, options_.oracle, learner, total);
    rounds.push_back(total);
    frames.clear();
    people.clear();
  }
  report(progress, "learn", instants_.size(), instants_.size());
  return rounds;
}

SessionSightings PeopleSession::find(const PersonLearner& learner,
                                     const PeopleTruth* truth,
                                     PeopleScore* score,
                                     const Progress& progress) const {
  const VisibleGround visible(map_, ground_, cameras_, options_.visible);
  const PersonSearchOptions& search = options_.learner.search;
  SessionSightings sightings;
  const double least =
      learner.classifier() ? options_.least_probability(*learner.classifier()) : 1.0;
  sightings.session = map_.sessions[static_cast<std::size_t>(session_)].name;
  for (std::size_t i = 0; i < instants_.size(); ++i) {
    report(progress, "find", i, instants_.size());
    const Instant& instant = instants_[i];
    const PeopleFrame frame = read(instant);
    std::vector<PlacedPerson> people;
    for (const PersonHypothesis& h : learner.find(frame)) {
      if (h.prediction.probability < least) continue;
      const auto placed =
          place_on_ground(h, cameras_[static_cast<std::size_t>(h.box.camera)].mounted(),
                          instant.T_map_vehicle, ground_, options_.place);
      if (placed) people.push_back(*placed);
    }
    people = merge_cameras(std::move(people));
    for (const PlacedPerson& person : people)
      sightings.detections.push_back(detection_of(
          person, cameras_[static_cast<std::size_t>(person.box.camera)], instant.t_ns));
    std::vector<bool> has_image;
    for (const ImagePyramid& image : frame.images) has_image.push_back(!image.empty());
    Look look{instant.t_ns, {}};
    for (const double reach : visible.reach_m(instant.T_map_vehicle, has_image))
      look.reach_dm.push_back(
          static_cast<std::uint8_t>(std::clamp(10.0 * reach + 0.5, 0.0, 255.0)));
    sightings.looks.push_back(std::move(look));
    if (truth != nullptr)
      score->add(score_instant(
          people, truth->at(instant.t_ns, cameras_, search.min_range_m, search.max_range_m),
          options_.oracle.same_overlap));
  }
  report(progress, "find", instants_.size(), instants_.size());
  return sightings;
}

}  // namespace roadbook
