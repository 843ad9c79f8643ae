#include "workflows/labels/people_training.hpp"

#include <algorithm>
#include <map>
#include <set>

#include "base/digest.hpp"
#include "semantics/people/person_labels.hpp"
#include "workflows/labels/hard_negatives.hpp"

namespace roadbook {
namespace {

void feed_camera(const MountedCamera& mounted, Sha256& digest) {
  const Camera& camera = mounted.camera;
  digest.update(camera_model_name(camera.model));
  for (const double parameter : camera.parameters) digest.update(parameter);
  for (const int side : {camera.width, camera.height}) digest.update(std::int64_t{side});
  digest.update(camera.max_angle_rad);
  for (const double number : mounted.T_vehicle_camera.matrix().reshaped()) digest.update(number);
}

}  // namespace

std::vector<Label> image_labels_at(const std::vector<LabelEvent>& events, std::int64_t event) {
  std::map<std::int64_t, const Label*> last;
  for (const LabelEvent& e : events)
    if (e.event <= event && e.action != LabelAction::kClasses) last[e.label.id] = &e.label;
  std::vector<Label> labels;
  for (const auto& [id, label] : last)
    if (label->state == LabelState::kActive && !is_on_ground(*label)) labels.push_back(*label);
  return labels;
}

PersonExamples people_examples(const std::vector<Label>& labels,
                               const std::vector<SecondLook>& looks,
                               const PersonExamples& known) {
  return joined(joined(examples_of(labels), examples_of_looks(looks, labels)), known);
}

// Creates a new learner each time. After a restart, the server therefore learns the same
// classifier, bit by bit.
std::shared_ptr<const GpClassifier> people_classifier(const PersonExamples& examples,
                                                      const PersonLearnerOptions& options) {
  PersonLearner learner({}, options);
  learner.start_from(examples);
  if (!learner.learn()) return nullptr;
  return std::make_shared<const GpClassifier>(*learner.classifier());
}

PeopleLesson learn_people(const PeopleImages& images,
                          const std::vector<Label>& labels,
                          const PersonExamples& known,
                          std::vector<SecondLook> looks,
                          const PersonLearnerOptions& options) {
  PeopleLesson lesson;
  lesson.looks = looks_that_stand(std::move(looks), labels);
  PersonExamples examples = people_examples(labels, lesson.looks, known);
  lesson.classifier = people_classifier(examples, options);
  if (lesson.classifier) {
    for (SecondLook& look :
         further_looks(images, *lesson.classifier, labels, lesson.looks, options.num_threads)) {
      lesson.again += look.alarms.size();
      lesson.looks.push_back(std::move(look));
    }
    if (lesson.again > 0) {
      examples = people_examples(labels, lesson.looks, known);
      lesson.classifier = people_classifier(examples, options);
    }
  }
  lesson.persons = examples.positives() / 2;  // each with its mirror image
  lesson.nobody = examples.size() - examples.positives();
  return lesson;
}

std::string people_basis(const PeopleImages& images,
                         const std::vector<Label>& labels,
                         const PersonExamples& known) {
  std::set<int> sessions;
  for (const LabelAnchor& image : done_images(labels)) sessions.insert(image.session);
  Sha256 digest;
  for (const int s : sessions) {
    const Session& session = images.map().sessions.at(static_cast<std::size_t>(s));
    digest.update(session.drive_digest).update(std::int64_t{images.at_hand(s) ? 1 : 0});
    for (const MountedCamera& mounted : session.rig.cameras) feed_camera(mounted, digest);
  }
  for (std::size_t i = 0; i < known.size(); ++i) {
    digest.update(std::int64_t{known.labels[i]});
    for (const float value : known.features[i]) digest.update(static_cast<double>(value));
  }
  return digest.hex().substr(0, 16);
}

std::vector<ReplayedRound> replayed_people(const PeopleImages& images,
                                           const PersonExamples& known,
                                           const PersonLearnerOptions& options,
                                           const std::vector<LabelEvent>& events,
                                           const std::vector<PeopleRound>& rounds) {
  std::vector<ReplayedRound> replayed;
  std::vector<SecondLook> looks;
  bool follows = true;
  for (const PeopleRound& round : rounds) {
    const auto labels = image_labels_at(events, round.event);
    ReplayedRound now{people_basis(images, labels, known), follows, {}};
    // A round without a recorded basis is an early one, with one search only.
    if (!round.basis.empty()) follows = follows && round.basis == now.basis;
    if (follows && !round.basis.empty()) {
      PeopleLesson lesson = learn_people(images, labels, known, std::move(looks), options);
      looks = std::move(lesson.looks);
      now.classifier = lesson.classifier ? lesson.classifier->digest() : std::string();
    }
    replayed.push_back(std::move(now));
  }
  return replayed;
}

}  // namespace roadbook
