#include "semantics/people/person_learner.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "base/error.hpp"
#include "base/parallel.hpp"

namespace roadbook {

void PersonLearnerOptions::check() const {
  search.check();
  classifier.check();
  if (!(min_probability > 0.0 && min_probability < 1.0))
    throw InvalidOption("min_probability", std::to_string(min_probability), "between 0 and 1");
}

PersonLearner::PersonLearner(const std::vector<PersonCamera>& cameras,
                             const PersonLearnerOptions& options)
    : options_(options) {
  options_.check();
  set_cameras(cameras);
}

void PersonLearner::set_cameras(const std::vector<PersonCamera>& cameras) {
  std::vector<std::optional<PersonSearch>> made(cameras.size());
  parallel_for(cameras.size(), options_.num_threads, [&](std::size_t i) {
    made[i].emplace(static_cast<int>(i), cameras[i], options_.search);
  });
  searches_.clear();
  for (auto& search : made) searches_.push_back(std::move(*search));
}

void PersonLearner::add(const PeopleFrame& frame, const PersonBox& box, bool person) {
  const auto c = static_cast<std::size_t>(box.camera);
  const cv::Mat crop = searches_[c].camera().cut(frame.images[c], PersonWindow::patch(box));
  if (!knows(frame)) return add_example(window_, crop, person, examples_);
  PersonExamples again;
  add_example(window_, crop, person, again);
  examples_ = joined(std::move(examples_), again);
}

bool PersonLearner::knows(const PeopleFrame& frame) const {
  return examples_.instants.contains(frame.name);
}

void PersonLearner::remember(const PeopleFrame& frame) {
  if (!frame.name.empty()) examples_.instants.insert(frame.name);
}

void PersonLearner::add_random_negatives(const PeopleFrame& frame,
                                         const std::vector<PersonBox>& not_on) {
  Random random(options_.seed, "person negatives", drawn_++);
  std::size_t added = 0;
  for (std::size_t tries = 0; added < options_.random_negatives && tries < 1000; ++tries) {
    const auto c = random.below(searches_.size());
    if (frame.images[c].empty()) continue;
    const auto box = searches_[c].random_box(random);
    if (!box || std::any_of(not_on.begin(), not_on.end(), [&](const PersonBox& other) {
          return intersection_over_union(*box, other) > options_.same_overlap;
        }))
      continue;
    add(frame, *box, false);
    ++added;
  }
}

void PersonLearner::answer(const PersonHypothesis& hypothesis, bool person) {
  const double shift = classifier_ ? classifier_->shift() : 0.0;
  examples_.answers.push_back({logit_of(hypothesis.prediction.probability) - shift, person});
}

void PersonLearner::use_prior_of_searches(bool use, std::size_t from_page) {
  if (!classifier_) return;
  const auto& all = examples_.answers;
  const auto middle = all.begin() + static_cast<std::ptrdiff_t>(std::min(from_page, all.size()));
  const std::array<std::vector<SearchAnswer>, 2> sources{std::vector(all.begin(), middle),
                                                         std::vector(middle, all.end())};
  classifier_->set_shift(use ? prior_shift_of(sources) : 0.0);
}

bool PersonLearner::learn() {
  const std::size_t positives = examples_.positives();
  if (positives == 0 || positives == examples_.size()) return false;
  Eigen::MatrixXd X(static_cast<Eigen::Index>(examples_.size()), PersonWindow::feature_size());
  std::vector<int> labels;
  for (std::size_t i = 0; i < examples_.size(); ++i) {
    X.row(static_cast<Eigen::Index>(i)) = examples_.features[i].cast<double>();
    labels.push_back(examples_.labels[i]);
  }
  GpClassifierOptions options = options_.classifier;
  if (classifier_) options.scale = classifier_->scale();  // probably still the best scale
  classifier_ = GpClassifier::train(X, labels, options);
  return true;
}

std::vector<PersonHypothesis> PersonLearner::find(const PeopleFrame& frame) const {
  std::vector<PersonHypothesis> all;
  if (!classifier_) return all;
  std::vector<std::vector<PersonHypothesis>> by_camera(searches_.size());
  parallel_for(searches_.size(), options_.num_threads, [&](std::size_t c) {
    if (!frame.images[c].empty() && !frame.images[c].front().empty())
      by_camera[c] = searches_[c].run(frame.images[c], *classifier_);
  });
  for (const auto& some : by_camera) all.insert(all.end(), some.begin(), some.end());
  return all;
}

std::vector<std::size_t> PersonLearner::questions(const std::vector<PersonHypothesis>& hypotheses,
                                                  std::size_t count) {
  std::vector<std::size_t> order(hypotheses.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto doubt = [&](std::size_t i) {
    return std::abs(hypotheses[i].prediction.probability - 0.5);
  };
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return doubt(a) < doubt(b); });
  if (order.size() > count) order.resize(count);
  return order;
}

}  // namespace roadbook
