#include "apps/evaluation/people_study.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <optional>

#include "apps/evaluation/people_scene.hpp"
#include "base/se3.hpp"

namespace roadbook {
namespace {

double cpu_s() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

std::vector<PlacedPerson> find_people(const PersonLearner& learner,
                                      const PeopleScene& scene,
                                      const GroundModel& ground,
                                      const PeopleScene::Instant& instant,
                                      const PeopleDetectOptions& options) {
  const double least = options.least_probability(*learner.classifier());
  std::vector<PlacedPerson> people;
  for (const PersonHypothesis& h : learner.find(instant.frame)) {
    if (h.prediction.probability < least) continue;
    const auto placed =
        place_on_ground(h, scene.cameras()[static_cast<std::size_t>(h.box.camera)].mounted(),
                        instant.T_world_vehicle, ground, options.place);
    if (placed) people.push_back(*placed);
  }
  return merge_cameras(std::move(people));
}

VisitFrame frame_of(const std::vector<PlacedPerson>& people,
                    const Eigen::Isometry3d& T,
                    double duration_s) {
  VisitFrame frame;
  frame.position = T.translation().head<2>();
  frame.heading = heading_of(T);
  frame.duration_s = duration_s;
  for (const PlacedPerson& person : people)
    frame.people.push_back({(T * Eigen::Vector3d(person.foot.x(), person.foot.y(), 0.0)).head<2>(),
                            std::sqrt(0.5 * person.covariance.trace()), person.probability});
  return frame;
}

// A visit that is searched repeatedly and never used for learning.
class HeldOut {
 public:
  HeldOut(const PeopleStudyOptions& options, const ScenarioOptions& place)
      : options_(options),
        scene_("zurich", place, options.seed + 1000, options.detect.learner.num_threads),
        ground_(scene_.ground()) {
    const double end = std::min(scene_.duration_s(), options.max_duration_s);
    const double step = std::max(options.step_s, (end - 0.5) / options.held_out_looks);
    for (double t = 0.5; t < end; t += step)
      looks_.push_back(scene_.at(t, options.detect.learner.search.max_range_m));
  }

  PeopleScore score(PersonLearner& learner) const {
    learner.set_cameras(scene_.cameras());
    learner.use_prior_of_searches(true);
    PeopleScore score;
    for (const PeopleScene::Instant& look : looks_)
      score.add(score_instant(find_people(learner, scene_, ground_, look, options_.detect),
                              look.there, options_.detect.oracle.same_overlap));
    learner.use_prior_of_searches(false);
    return score;
  }

 private:
  const PeopleStudyOptions& options_;
  PeopleScene scene_;
  GroundModel ground_;
  std::vector<PeopleScene::Instant> looks_;
};

}  // namespace

std::vector<PeopleVisit> study_people(const PeopleStudyOptions& options, const Progress& progress) {
  const PersonSearchOptions& search = options.detect.learner.search;
  std::vector<PeopleVisit> visits;
  std::optional<PersonLearner> learner;
  PersonRound total;
  ScenarioOptions place;
  place.size = options.small ? "small" : "full";
  place.visit = 1;
  std::optional<HeldOut> held_out;
  if (options.held_out_looks > 0) held_out.emplace(options, place);
  for (int v = 1; v <= options.visits; ++v) {
    report(progress, "visits", static_cast<std::size_t>(v - 1),
           static_cast<std::size_t>(options.visits));
    place.visit = v;
    const PeopleScene scene("zurich", place, options.seed, options.detect.learner.num_threads);
    const GroundModel ground = scene.ground();
    if (!learner) learner.emplace(scene.cameras(), options.detect.learner);
    learner->set_cameras(scene.cameras());
    learner->use_prior_of_searches(true);
    PeopleVisit visit;
    visit.visit = v;
    // The training instants: those with people, and the same number without. Nobody is searched
    // with what the last visit teaches, unless there is a held-out visit.
    const bool learns = held_out || v < options.visits;
    std::vector<PeopleScene::Instant> kept;
    std::size_t empty = 0;
    const double end = std::min(scene.duration_s(), options.max_duration_s);
    int looks = 0;
    for (double t = 0.5; t < end; t += options.step_s) {
      auto instant = scene.at(t, search.max_range_m);
      if (learner->classifier()) {
        const double before = cpu_s();
        const auto people = find_people(*learner, scene, ground, instant, options.detect);
        visit.find_s += cpu_s() - before;
        ++looks;
        visit.score.add(score_instant(people, instant.there, options.detect.oracle.same_overlap));
        visit.frames.push_back(frame_of(people, instant.T_world_vehicle, options.step_s));
      }
      const bool nobody = instant.there.people.empty();
      if (!learns || (nobody && empty >= kept.size() - empty)) continue;
      empty += nobody ? 1U : 0U;
      kept.push_back(std::move(instant));
    }
    if (looks > 0) visit.find_s /= looks;
    learner->use_prior_of_searches(false);
    std::vector<PeopleFrame> frames;
    std::vector<std::vector<TruePerson>> people;
    for (auto& instant : kept) {
      frames.push_back(std::move(instant.frame));
      people.push_back(std::move(instant.there.people));
      if (frames.size() < options.detect.batch) continue;
      total = play_person_round(frames, people, options.detect.oracle, *learner, total);
      visit.rounds.push_back(total);
      frames.clear();
      people.clear();
    }
    if (held_out && learner->classifier()) visit.held_out = held_out->score(*learner);
    visits.push_back(std::move(visit));
    if (options.after_visit) options.after_visit(visits.back());
  }
  return visits;
}

}  // namespace roadbook
