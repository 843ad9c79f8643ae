#include "semantics/detector/box_learner.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "base/error.hpp"
#include "base/parallel.hpp"
#include "base/random.hpp"
#include "semantics/detector/gp_laplace.hpp"
#include "semantics/detector/question_choice.hpp"

namespace roadbook {
namespace {

bool overlaps_any(const OrientedBox& box, const std::vector<OrientedBox>& others, double overlap) {
  return std::any_of(others.begin(), others.end(), [&](const OrientedBox& other) {
    return intersection_over_union(box, other) > overlap;
  });
}

// The classifier's own probability, without the prior of searches and without calibration. The
// questions depend on this probability only.
double own_probability(const GpPrediction& prediction) {
  return logistic_gaussian(prediction.mean, prediction.variance);
}

OrientedBox turned_half(OrientedBox box) {
  box.heading += std::numbers::pi;
  return box;
}

}  // namespace

void BoxLearnerOptions::check() const {
  window.check();
  search.check();
  classifier.check();
  if (random_negatives < 1) throw InvalidOption("random_negatives", "0", ">= 1");
  if (!(min_probability > 0.0 && min_probability < 1.0))
    throw InvalidOption("min_probability", std::to_string(min_probability), "between 0 and 1");
}

BoxLearner::BoxLearner(const GroundImage& image, const BoxLearnerOptions& options)
    : options_(options), full_(image) {
  options_.check();
}

void BoxLearner::add_positive(const OrientedBox& box) { positives_.push_back(box); }
void BoxLearner::add_negative(const OrientedBox& box) { negatives_.push_back(box); }

void BoxLearner::answer(std::size_t hypothesis, bool right) {
  const Hypothesis& asked = hypotheses_.at(hypothesis);
  answers_.push_back({logit_of(asked.prediction.probability) - classifier_->shift(), right});
}

void BoxLearner::set_examples(std::vector<OrientedBox> positives,
                              std::vector<OrientedBox> negatives) {
  positives_ = std::move(positives);
  negatives_ = std::move(negatives);
}

void BoxLearner::begin_window(double length_m, double width_m) {
  window_.emplace(length_m, width_m, options_.window);
  image_ = coarser(full_, window_->pixel_m());
  search_.reset();
}

std::optional<Eigen::Vector2d> BoxLearner::window_sides() const {
  if (!window_) return std::nullopt;
  return Eigen::Vector2d(window_->length_m(), window_->width_m());
}

bool BoxLearner::is_known(const OrientedBox& box) const {
  return overlaps_any(box, positives_, options_.same_overlap) ||
         overlaps_any(box, negatives_, options_.same_overlap);
}

// Fits the window to the mean size of the positives. The blocks are computed again only if the size
// changes by more than the scale steps can bridge. With examples of another place, the window keeps
// their shape.
void BoxLearner::fit_window() {
  double length_m = 0.0;
  double width_m = 0.0;
  for (const OrientedBox& box : positives_) {
    length_m += box.length_m / static_cast<double>(positives_.size());
    width_m += box.width_m / static_cast<double>(positives_.size());
  }
  if (positives_.empty()) length_m = before_.length_m;
  if (!before_.empty()) width_m = length_m * before_.width_m / before_.length_m;
  const auto near = [&](double a, double b) {
    return std::abs(a - b) <= options_.rebuild_change * b;
  };
  if (window_ && near(length_m, window_->length_m()) && near(width_m, window_->width_m())) return;
  begin_window(length_m, width_m);
}

// Random boxes on seen ground, at the scales of the search, without overlap with positives. They
// are equal in every round. They may hit unconfirmed hypotheses: a classifier without negatives at
// its false alarms makes more false alarms in each round. A few random boxes hit a real thing that
// has no label yet, but this does less harm.
std::vector<OrientedBox> BoxLearner::random_boxes() const {
  const std::size_t count = options_.random_negatives;
  Random random(options_.seed, "negatives");
  std::vector<OrientedBox> boxes;
  const auto scales = static_cast<std::uint64_t>(options_.search.scales.size());
  for (std::size_t tries = 0; boxes.size() < count && tries < 100 * count; ++tries) {
    OrientedBox box;
    box.centre = image_.corner +
                 image_.resolution_m * Eigen::Vector2d(random.uniform(0.0, image_.grey.cols),
                                                       -random.uniform(0.0, image_.grey.rows));
    box.heading = random.uniform(-std::numbers::pi, std::numbers::pi);
    const double scale = options_.search.scales[random.below(scales)];
    box.length_m = scale * window_->length_m();
    box.width_m = scale * window_->width_m();
    if (seen_share(image_, box) < options_.search.min_seen) continue;
    if (overlaps_any(box, positives_, options_.same_overlap)) continue;
    boxes.push_back(box);
  }
  return boxes;
}

// Collects the examples of other places, then those of this place. Random negatives, or the vector
// 0, join with the first positive box.
void BoxLearner::collect_examples() {
  const bool only_rejected = options_.negatives == NegativePolicy::kRejected;
  std::vector<OrientedBox> negatives = negatives_;
  if (!positives_.empty() && !only_rejected) {
    const auto some = random_boxes();
    negatives.insert(negatives.end(), some.begin(), some.end());
  }
  examples_ = before_;
  examples_.length_m = window_->length_m();
  examples_.width_m = window_->width_m();
  if (!positives_.empty() && only_rejected) examples_.labels.push_back(-1);
  const std::size_t before = examples_.labels.size();
  // A box seen from behind, turned by half a turn, is a positive example too.
  const std::size_t more = 2 * positives_.size() + negatives.size();
  examples_.features.conservativeResizeLike(
      Eigen::MatrixXf::Zero(static_cast<Eigen::Index>(before + more), window_->feature_size()));
  std::vector<OrientedBox> boxes;
  const auto add = [&](const OrientedBox& box, int label) {
    boxes.push_back(box);
    examples_.labels.push_back(label);
  };
  for (const OrientedBox& box : positives_) {
    add(box, 1);
    add(turned_half(box), 1);
  }
  for (const OrientedBox& box : negatives) add(box, -1);
  examples_.features.bottomRows(static_cast<Eigen::Index>(more)) = features_of(boxes).cast<float>();
}

// One example a row.
Eigen::MatrixXd BoxLearner::features_of(const std::vector<OrientedBox>& boxes) const {
  Eigen::MatrixXd features(window_->feature_size(), static_cast<Eigen::Index>(boxes.size()));
  parallel_for(boxes.size(), options_.search.num_threads, [&](std::size_t i) {
    features.col(static_cast<Eigen::Index>(i)) = window_->feature(image_, boxes[i]);
  });
  return features.transpose();
}

bool BoxLearner::gather() {
  if (positives_.empty() && before_.empty()) return false;
  fit_window();
  collect_examples();
  return true;
}

bool BoxLearner::train() {
  if (!gather()) return false;
  const auto& labels = examples_.labels;
  if (std::count(labels.begin(), labels.end(), -1) == 0) return false;
  classifier_ = GpClassifier::train(examples_.features.cast<double>(), labels, options_.classifier);
  classifier_->set_shift(prior_shift(answers_));
  return true;
}

bool BoxLearner::learn() {
  if (!train()) return false;
  search();
  return true;
}

void BoxLearner::search() {
  ++round_;
  if (!search_) search_.emplace(image_, *window_, options_.search);
  hypotheses_ = search_->run(*classifier_);
  std::erase_if(hypotheses_, [&](const Hypothesis& h) { return is_known(h.box); });
}

std::vector<OrientedBox> BoxLearner::found() const {
  std::vector<OrientedBox> boxes = positives_;
  for (const Hypothesis& h : hypotheses_)
    if (own_probability(h.prediction) >= options_.min_probability) boxes.push_back(h.box);
  return boxes;
}

std::vector<std::size_t> BoxLearner::telling(std::size_t count) const {
  if (hypotheses_.empty()) return {};
  std::vector<OrientedBox> boxes;
  Eigen::VectorXd probability(static_cast<Eigen::Index>(hypotheses_.size()));
  for (const Hypothesis& h : hypotheses_) {
    probability[static_cast<Eigen::Index>(boxes.size())] = own_probability(h.prediction);
    boxes.push_back(h.box);
  }
  return most_telling(classifier_->covariance(features_of(boxes)), probability, count);
}

std::vector<std::size_t> BoxLearner::questions(std::size_t count) const {
  if (options_.questions == QuestionPolicy::kTelling) return telling(count);
  std::vector<std::size_t> order(hypotheses_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  if (options_.questions == QuestionPolicy::kRandom) {
    Random random(options_.seed, "questions", round_);
    for (std::size_t i = order.size(); i > 1; --i)
      std::swap(order[i - 1], order[random.below(static_cast<std::uint64_t>(i))]);
  } else {
    std::vector<double> sureness;
    for (const Hypothesis& h : hypotheses_)
      sureness.push_back(std::abs(own_probability(h.prediction) - 0.5));
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return sureness[a] < sureness[b]; });
  }
  std::vector<std::size_t> chosen;
  for (const std::size_t i : order) {
    if (chosen.size() == count) break;
    const bool apart = std::all_of(chosen.begin(), chosen.end(), [&](std::size_t c) {
      return (hypotheses_[i].box.centre - hypotheses_[c].box.centre).norm() >= options_.min_apart_m;
    });
    if (apart || options_.questions == QuestionPolicy::kRandom) chosen.push_back(i);
  }
  return chosen;
}

void BoxLearner::start_from(BoxExamples examples) {
  if (!(examples.length_m > 0.0 && examples.width_m > 0.0))
    throw InvalidOption("examples", "boxes without size", "sides above 0");
  const HogWindow window(examples.length_m, examples.width_m, options_.window);
  if (examples.features.cols() != window.feature_size() ||
      examples.features.rows() != static_cast<Eigen::Index>(examples.labels.size()))
    throw InvalidOption("examples", std::to_string(examples.features.cols()) + " features",
                        std::to_string(window.feature_size()));
  before_ = std::move(examples);
}

}  // namespace roadbook
