#include "apps/label_server/learning.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>

#include "apps/label_server/label_wire.hpp"
#include "base/wall_clock.hpp"
#include "semantics/detector/gp_laplace.hpp"
#include "workflows/labels/label_boxes.hpp"
#include "workflows/labels/round_replay.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

constexpr std::size_t kQuestions = 24;  // questions per round
constexpr double kLeastSeenBox = 0.75;  // seen share of a box in a question
constexpr std::int64_t kEver = std::numeric_limits<std::int64_t>::max();

bool near(const OrientedBox& a, const OrientedBox& b, double overlap) {
  const double reach = 0.5 * (a.length_m + a.width_m + b.length_m + b.width_m);
  return (a.centre - b.centre).norm() < reach && intersection_over_union(a, b) > overlap;
}

bool near_any(const OrientedBox& box, const std::vector<OrientedBox>& others, double overlap) {
  return std::any_of(others.begin(), others.end(),
                     [&](const OrientedBox& other) { return near(box, other, overlap); });
}

std::vector<OrientedBox> found_boxes(const std::vector<Hypothesis>& hypotheses, double least) {
  std::vector<OrientedBox> boxes;
  for (const Hypothesis& h : hypotheses)
    if (h.prediction.probability >= least) boxes.push_back(h.box);
  return boxes;
}

}  // namespace

Learning::Learning(const GroundImage& image,
                   const BoxLearnerOptions& options,
                   const LabelService* service,
                   EventHub* hub,
                   std::map<std::string, BoxExamples> taught,
                   LearningRecord record,
                   std::function<void(const LearningRecord&)> keep)
    : image_(image),
      options_(options),
      service_(service),
      taught_(std::move(taught)),
      keep_(std::move(keep)),
      record_(std::move(record)),
      worker_(hub, "learning", [this](const std::string& kind) { run_round(kind); }) {}

void Learning::start(const std::string& kind) {
  if (image_.grey.empty())
    throw RequestError(422, "overhead image: got none, want one (roadbook overhead -m MAP)");
  if (taught_.count(kind) == 0 && service_->boxes(kind).positives.empty())
    throw RequestError(422, kind + ": got no labelled box, draw at least one box first");
  worker_.start(kind);
}

// The order of label numbers and the window of the last round of this class fix the result. After a
// restart, the server therefore learns the same classifier. The learner keeps its computed features
// of the picture while the window stays the same.
void Learning::take_examples(const std::string& kind, const LearningRecord& record) {
  const auto window = window_before(record.rounds, kind);
  if (!learner_ || learner_kind_ != kind || learner_->window_sides() != window) {
    learner_.emplace(image_, options_);
    learner_kind_ = kind;
    if (const auto taught = taught_.find(kind); taught != taught_.end())
      learner_->start_from(taught->second);
    if (window) learner_->begin_window(window->x(), window->y());
  }
}

std::string Learning::basis_of(const std::string& kind) {
  const auto [found, is_new] = bases_.try_emplace(kind);
  const auto taught = taught_.find(kind);
  if (is_new)
    found->second = round_basis(service_->map(), image_,
                                taught == taught_.end() ? BoxExamples() : taught->second);
  return found->second;
}

// If paint bounds the positive examples, the function moves the hypotheses onto the paint. Then
// accepted boxes lie like drawn boxes.
std::vector<Hypothesis> Learning::on_their_lines(std::vector<Hypothesis> hypotheses) {
  constexpr double kPainted = 0.3;
  double painted = 0.0;
  if (!paint_) paint_.emplace(image_);
  for (const OrientedBox& box : learner_->positives()) painted += paint_along(*paint_, box);
  if (learner_->positives().empty() ||
      painted < kPainted * static_cast<double>(learner_->positives().size()))
    return hypotheses;
  std::vector<OrientedBox> boxes;
  for (const Hypothesis& h : hypotheses) boxes.push_back(h.box);
  boxes = all_snapped(*paint_, std::move(boxes), options_.search.num_threads);
  for (std::size_t i = 0; i < boxes.size(); ++i) hypotheses[i].box = boxes[i];
  return hypotheses;
}

// A user cannot answer a question about a place that the picture does not show.
std::vector<std::size_t> Learning::questions_in_sight(
    const std::vector<Hypothesis>& hypotheses) const {
  std::vector<std::size_t> questions;
  for (const std::size_t i : learner_->questions(2 * kQuestions))
    if (questions.size() < kQuestions && seen_share(image_, hypotheses[i].box) >= kLeastSeenBox)
      questions.push_back(i);
  return questions;
}

void Learning::run_round(const std::string& kind) {
  const auto begin = std::chrono::steady_clock::now();
  LearningRecord record;
  {
    const std::lock_guard lock(mutex_);
    record = record_;
  }
  take_examples(kind, record);
  const auto events = service_->events();
  const LabelBoxes boxes = label_boxes(service_->map(), events, kind);
  learner_->set_examples(boxes.positives, boxes.negatives);
  learner_->learn();
  LearningRound round;
  round.number = record.rounds.empty() ? 1 : record.rounds.back().number + 1;
  round.kind = kind;
  round.begin_ns = wall_clock_ns();
  round.positives = learner_->positives().size();
  round.negatives = learner_->negatives().size();
  round.event = static_cast<std::int64_t>(events.size());
  round.basis = basis_of(kind);
  if (learner_->classifier()) round.classifier = learner_->classifier()->digest();
  if (const auto window = learner_->window_sides()) {
    round.window_length_m = window->x();
    round.window_width_m = window->y();
  }
  const double least = options_.min_probability;
  const bool same_kind = !record.rounds.empty() && record.rounds.back().kind == kind;
  const auto before =
      same_kind ? found_boxes(record.hypotheses, least) : std::vector<OrientedBox>();
  const auto now = found_boxes(learner_->hypotheses(), least);
  round.found = now.size();
  for (const auto& box : now)
    if (!near_any(box, before, options_.same_overlap)) ++round.fresh;
  for (const auto& box : before)
    if (!near_any(box, now, options_.same_overlap) &&
        !near_any(box, learner_->positives(), options_.same_overlap) &&
        !near_any(box, learner_->negatives(), options_.same_overlap))
      ++round.gone;
  record.hypotheses = on_their_lines(learner_->hypotheses());
  record.questions = questions_in_sight(record.hypotheses);
  record.shift = prior_shift(search_answers(service_->answers(kind)));
  round.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  record.rounds.push_back(round);
  {
    const std::lock_guard lock(mutex_);
    record_ = record;
  }
  if (keep_) keep_(record);
}

std::vector<Learning::Open> Learning::open_hypotheses() const {
  if (record_.rounds.empty()) return {};
  const auto known = service_->boxes(record_.rounds.back().kind);
  std::vector<Open> open;
  for (std::size_t i = 0; i < record_.hypotheses.size(); ++i)
    if (!near_any(record_.hypotheses[i].box, known.positives, options_.same_overlap) &&
        !near_any(record_.hypotheses[i].box, known.negatives, options_.same_overlap))
      open.push_back({i, record_.hypotheses[i]});
  return open;
}

Json Learning::hypotheses() const {
  const std::lock_guard lock(mutex_);
  Json list = Json::array();
  std::vector<bool> is_open(record_.hypotheses.size(), false);
  for (const Open& o : open_hypotheses()) {
    is_open[o.index] = true;
    const OrientedBox& box = o.hypothesis.box;
    const double probability = o.hypothesis.prediction.probability;
    list.push_back({{"index", o.index},
                    {"x", box.centre.x()},
                    {"y", box.centre.y()},
                    {"heading", box.heading},
                    {"length", box.length_m},
                    {"width", box.width_m},
                    {"probability", probability},
                    {"calibrated", logistic(logit_of(probability) + record_.shift)},
                    {"sigma", std::sqrt(std::max(0.0, o.hypothesis.prediction.variance))}});
  }
  Json questions = Json::array();
  for (const std::size_t i : record_.questions)
    if (is_open[i]) questions.push_back(i);
  return {{"round", record_.rounds.empty() ? 0 : record_.rounds.back().number},
          {"kind", record_.rounds.empty() ? std::string() : record_.rounds.back().kind},
          {"hypotheses", list},
          {"questions", questions}};
}

Json Learning::progress() const {
  const std::lock_guard lock(mutex_);
  Json rounds = Json::array();
  for (std::size_t i = 0; i < record_.rounds.size(); ++i) {
    const LearningRound& round = record_.rounds[i];
    const std::int64_t end = i + 1 < record_.rounds.size() ? record_.rounds[i + 1].begin_ns : kEver;
    const auto answers =
        count_answers(service_->answers(round.kind), options_.min_probability, round.begin_ns, end);
    rounds.push_back({{"round", round.number},
                      {"kind", round.kind},
                      {"seconds", round.seconds},
                      {"positives", round.positives},
                      {"negatives", round.negatives},
                      {"found", round.found},
                      {"fresh", round.fresh},
                      {"gone", round.gone},
                      {"accepted", answers.accepted},
                      {"rejected", answers.rejected}});
  }
  Json json = {{"running", worker_.running()}, {"rounds", rounds}};
  if (!record_.rounds.empty()) {
    const auto answers = count_answers(service_->answers(record_.rounds.back().kind),
                                       options_.min_probability, 0, kEver);
    std::size_t left = 0;
    for (const Open& o : open_hypotheses())
      if (o.hypothesis.prediction.probability >= options_.min_probability) ++left;
    json["accepted"] = answers.accepted;
    json["rejected"] = answers.rejected;
    json["left"] = left;
  }
  json["counts"] = service_->counts();
  return json;
}

}  // namespace roadbook
