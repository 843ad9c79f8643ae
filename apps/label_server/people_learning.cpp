#include "apps/label_server/people_learning.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>
#include <numeric>

#include "apps/label_server/label_wire.hpp"
#include "apps/label_server/people_wire.hpp"
#include "base/parallel.hpp"
#include "base/wall_clock.hpp"
#include "semantics/detector/gp_laplace.hpp"
#include "semantics/detector/search_prior.hpp"
#include "semantics/people/person_labels.hpp"
#include "workflows/labels/hard_negatives.hpp"
#include "workflows/labels/people_training.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kImagesARound = 24;
constexpr double kLeastShown = 0.1;  // less likely hypotheses are not informative and hide the
                                     // others
constexpr std::int64_t kNoEnd = std::numeric_limits<std::int64_t>::max();

// Returns a step size that visits each of `count` items once and spreads the first few over all.
std::size_t spreading_step(std::size_t count) {
  auto step = static_cast<std::size_t>(0.6180339887 * static_cast<double>(count));
  while (step > 1 && std::gcd(step, count) != 1) --step;
  return std::max<std::size_t>(1, step);
}

// Returns the smallest distance of a hypothesis from probability 0.5. An image without questions
// comes last.
double sureness(const SearchedImage& image) {
  double least = 1.0;
  for (const PersonHypothesis& h : image.hypotheses)
    if (h.prediction.probability >= kLeastShown)
      least = std::min(least, std::abs(h.prediction.probability - 0.5));
  return least;
}

}  // namespace

PeopleLearning::PeopleLearning(const PeopleImages* images,
                               const LabelService* service,
                               EventHub* hub,
                               PersonExamples known,
                               const PersonLearnerOptions& options,
                               PeopleRecord record,
                               std::function<void(const PeopleRecord&)> keep)
    : images_(images),
      service_(service),
      known_(std::move(known)),
      options_(options),
      keep_(std::move(keep)),
      record_(std::move(record)),
      worker_(hub, "people", [this](const std::string&) { run_round(); }) {
  std::erase_if(record_.images, [&](const SearchedImage& i) { return !images_->has(i.image); });
}

void PeopleLearning::start() {
  const PersonExamples all = people_examples(service_->image_labels(), {}, known_);
  if (all.positives() == 0)
    throw RequestError(422, "people: got no labelled person, draw at least one person first");
  if (all.positives() == all.size())
    throw RequestError(
        422, "people: got no finished image, label every person in one image and press Enter");
  worker_.start(kPersonKind);
}

// Returns the classifier of the last round. After a restart of the server, returns the same
// classifier, learnt again.
std::shared_ptr<const GpClassifier> PeopleLearning::learnt() const {
  PeopleRecord record;
  {
    const std::lock_guard lock(mutex_);
    if (classifier_) return classifier_;
    record = record_;
  }
  const std::int64_t last = record.rounds.empty() ? 0 : record.rounds.back().event;
  const auto labels =
      last > 0 ? image_labels_at(service_->events(), last) : service_->image_labels();
  const auto made = people_classifier(people_examples(labels, record.looks, known_), options_);
  const std::lock_guard lock(mutex_);
  if (!classifier_) classifier_ = made;
  return classifier_;
}

std::vector<LabelAnchor> PeopleLearning::next_images(std::size_t count, std::size_t* next) const {
  const auto& all = images_->all();
  const auto done = done_images(service_->image_labels());
  const std::size_t step = spreading_step(all.size());
  std::vector<LabelAnchor> chosen;
  for (std::size_t tried = 0; tried < all.size() && chosen.size() < count; ++tried, ++*next) {
    const LabelAnchor& image = all[*next * step % all.size()];
    if (!done.contains(image)) chosen.push_back(image);
  }
  return chosen;
}

std::shared_ptr<const GpClassifier> PeopleLearning::learn(PeopleRecord& record,
                                                          PeopleRound& round) const {
  const auto events = service_->events();
  round.event = static_cast<std::int64_t>(events.size());
  const auto labels = image_labels_at(events, round.event);
  round.basis = people_basis(*images_, labels, known_);
  PeopleLesson lesson = learn_people(*images_, labels, known_, std::move(record.looks), options_);
  if (!lesson.classifier)
    throw RequestError(422, "people: got no training examples, want at least one labelled person");
  record.looks = std::move(lesson.looks);
  round.persons = lesson.persons;
  round.nobody = lesson.nobody;
  round.again = lesson.again;
  round.classifier = lesson.classifier->digest();
  return lesson.classifier;
}

void PeopleLearning::search_next(const GpClassifier& classifier,
                                 PeopleRecord& record,
                                 PeopleRound& round) const {
  record.images.clear();
  for (const LabelAnchor& image : next_images(kImagesARound, &record.next))
    record.images.push_back({image, {}});
  parallel_for(record.images.size(), options_.num_threads, [&](std::size_t i) {
    record.images[i].hypotheses = images_->search(record.images[i].image, classifier);
  });
  round.images = record.images.size();
  for (const SearchedImage& searched : record.images)
    for (const PersonHypothesis& h : searched.hypotheses)
      if (h.prediction.probability >= options_.min_probability) ++round.found;
  std::stable_sort(
      record.images.begin(), record.images.end(),
      [](const SearchedImage& a, const SearchedImage& b) { return sureness(a) < sureness(b); });
}

void PeopleLearning::run_round() {
  const auto begin = std::chrono::steady_clock::now();
  PeopleRecord record;
  {
    const std::lock_guard lock(mutex_);
    record = record_;
  }
  PeopleRound round;
  round.number = record.rounds.empty() ? 1 : record.rounds.back().number + 1;
  round.begin_ns = wall_clock_ns();
  const auto classifier = learn(record, round);
  search_next(*classifier, record, round);
  round.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  record.rounds.push_back(round);
  {
    const std::lock_guard lock(mutex_);
    record_ = record;
    classifier_ = classifier;
  }
  if (keep_) keep_(record);
}

Json PeopleLearning::rounds_json(const std::vector<PeopleRound>& rounds) const {
  Json list = Json::array();
  const auto said = service_->answers_in_images(kPersonKind);
  for (std::size_t i = 0; i < rounds.size(); ++i) {
    const PeopleRound& r = rounds[i];
    const std::int64_t end = i + 1 < rounds.size() ? rounds[i + 1].begin_ns : kNoEnd;
    const auto answers = count_answers(said, options_.min_probability, r.begin_ns, end);
    list.push_back({{"round", r.number},
                    {"seconds", r.seconds},
                    {"persons", r.persons},
                    {"nobody", r.nobody},
                    {"images", r.images},
                    {"found", r.found},
                    {"again", r.again},
                    {"accepted", answers.accepted},
                    {"rejected", answers.rejected},
                    {"missed", answers.drawn}});
  }
  return list;
}

Json PeopleLearning::overview() const {
  PeopleRecord record;
  {
    const std::lock_guard lock(mutex_);
    record = record_;
  }
  const auto labels = service_->image_labels();
  const auto done = done_images(labels);
  Json queue = Json::array();
  for (const SearchedImage& searched : record.images)
    if (!done.contains(searched.image)) queue.push_back(image_to_wire(searched.image));
  std::size_t next = record.next;
  if (record.rounds.empty())
    for (const LabelAnchor& image : next_images(kImagesARound, &next))
      queue.push_back(image_to_wire(image));
  std::size_t persons = 0;
  for (const Label& label : labels) persons += label.kind == kPersonKind ? 1U : 0U;
  return {{"images", images_->all().size()},
          {"done", done.size()},
          {"persons", persons},
          {"learnt_before", known_.size()},
          {"running", worker_.running()},
          {"round", record.rounds.empty() ? 0 : record.rounds.back().number},
          {"rounds", rounds_json(record.rounds)},
          {"queue", queue}};
}

std::vector<PersonHypothesis> PeopleLearning::hypotheses_in(const LabelAnchor& image) const {
  {
    const std::lock_guard lock(mutex_);
    for (const SearchedImage& searched : record_.images)
      if (searched.image == image) return searched.hypotheses;
  }
  const auto classifier = learnt();
  return classifier ? images_->search(image, *classifier) : std::vector<PersonHypothesis>();
}

Json PeopleLearning::image(const LabelAnchor& image) const {
  if (!images_->has(image))
    throw RequestError(
        404, "image: got no image of an available recording, want one (label --drive FOLDER)");
  const Session& session = images_->map().sessions[static_cast<std::size_t>(image.session)];
  const MountedCamera& mounted = session.rig.cameras[static_cast<std::size_t>(image.camera)];
  std::vector<PersonBox> known;
  bool done = false;
  for (const Label& label : service_->image_labels()) {
    if (label.anchor != image) continue;
    if (label.shape == LabelShape::kImage) done = true;
    if (label.shape == LabelShape::kUpright) known.push_back(label.window);
  }
  Json list = Json::array();
  const std::array answers{known_.answers, answers_of(service_->image_labels())};
  const double shift = prior_shift_of(answers);
  const auto hypotheses = hypotheses_in(image);
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    const PersonHypothesis& h = hypotheses[i];
    if (h.prediction.probability < kLeastShown ||
        std::any_of(known.begin(), known.end(), [&](const PersonBox& box) {
          return intersection_over_union(box, h.box) > options_.same_overlap;
        }))
      continue;
    Json wire = box_to_wire(mounted, h.box);
    wire["index"] = i;
    wire["probability"] = h.prediction.probability;
    wire["calibrated"] = logistic(logit_of(h.prediction.probability) + shift);
    list.push_back(wire);
  }
  const auto neighbour = [&](int step) -> Json {
    const auto other = images_->neighbour(image, step);
    return other ? image_to_wire(*other) : Json(nullptr);
  };
  Json json = image_to_wire(image);
  json["place"] = session.name + ", " + mounted.name;
  json["cameras"] = Json::array();
  for (const MountedCamera& other : session.rig.cameras) json["cameras"].push_back(other.name);
  json["width"] = mounted.camera.width;
  json["height"] = mounted.camera.height;
  json["done"] = done;
  json["hypotheses"] = list;
  json["before"] = neighbour(-1);
  json["after"] = neighbour(1);
  return json;
}

}  // namespace roadbook
