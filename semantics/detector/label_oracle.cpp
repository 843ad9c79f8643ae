#include "semantics/detector/label_oracle.hpp"

#include <algorithm>
#include <chrono>
#include <numeric>
#include <string>

#include "base/error.hpp"
#include "base/random.hpp"

namespace roadbook {
namespace {

std::vector<std::size_t> shuffled(std::size_t count, Random& random) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i)
    std::swap(order[i - 1], order[random.below(static_cast<std::uint64_t>(i))]);
  return order;
}

class Oracle {
 public:
  Oracle(const GroundImage& image,
         const std::vector<OrientedBox>& truth,
         const OracleOptions& options)
      : truth_(truth),
        options_(options),
        learner_(image, options.learner),
        random_(options.seed, "oracle"),
        order_(shuffled(truth.size(), random_)) {
    if (!options.start.empty()) learner_.start_from(options.start);
  }

  OracleResult play() {
    OracleResult result;
    draw(options_.first_boxes);
    for (int round = 0; round < options_.rounds; ++round) {
      const auto start = std::chrono::steady_clock::now();
      (void)learner_.learn();
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
      result.rounds.push_back(judge(taken.count()));
      result.found = learner_.found();
      if (options_.after_round) options_.after_round(learner_);
      if (round + 1 == options_.rounds) break;
      answer();
      draw(options_.boxes_a_round);
    }
    return result;
  }

 private:
  // Draws things that the search missed and that have no label, in a fixed random order.
  void draw(int count) {
    const std::vector<OrientedBox> found = learner_.found();
    const auto match = match_boxes(found, truth_, options_.same_overlap);
    std::vector<bool> hit(truth_.size(), false);
    for (const int m : match)
      if (m >= 0) hit[static_cast<std::size_t>(m)] = true;
    for (const std::size_t t : order_) {
      if (count == 0 || drawn_ == options_.max_boxes) return;
      if (hit[t]) continue;
      learner_.add_positive(truth_[t]);
      ++drawn_;
      --count;
    }
  }

  void answer() {
    std::vector<OrientedBox> boxes;
    for (const Hypothesis& h : learner_.hypotheses()) boxes.push_back(h.box);
    const auto match = match_boxes(boxes, truth_, options_.same_overlap);
    for (const std::size_t q :
         learner_.questions(static_cast<std::size_t>(options_.questions_a_round))) {
      ++clicks_;
      learner_.answer(q, match[q] >= 0);
      const int t = nearest(boxes[q]);
      const double overlap =
          t < 0 ? 0.0 : intersection_over_union(boxes[q], truth_[static_cast<std::size_t>(t)]);
      if (match[q] >= 0 && overlap >= options_.good_overlap)
        learner_.add_positive(boxes[q]);
      else if (overlap >= options_.near_overlap)
        put_right(static_cast<std::size_t>(t));
      else
        learner_.add_negative(boxes[q]);
    }
  }

  [[nodiscard]] int nearest(const OrientedBox& box) const {
    int best = -1;
    double most = 0.0;
    for (std::size_t t = 0; t < truth_.size(); ++t)
      if (const double o = intersection_over_union(box, truth_[t]); o > most) {
        most = o;
        best = static_cast<int>(t);
      }
    return best;
  }

  // A hypothesis that covers a thing only in part is neither a positive nor a negative example. The
  // labeller moves it onto the thing with one more click. If the thing already has a label, the
  // labeller does nothing.
  void put_right(std::size_t t) {
    const auto& known = learner_.positives();
    if (std::any_of(known.begin(), known.end(), [&](const OrientedBox& box) {
          return intersection_over_union(box, truth_[t]) >= options_.same_overlap;
        }))
      return;
    ++clicks_;
    ++put_right_;
    learner_.add_positive(truth_[t]);
  }

  [[nodiscard]] OracleRound judge(double seconds) const {
    const std::vector<OrientedBox> found = learner_.found();
    OracleRound round{score_boxes(found, truth_, options_.same_overlap)};
    round.drawn = drawn_;
    round.put_right = put_right_;
    round.clicks = clicks_;
    round.found = found.size();
    round.seconds = seconds;
    if (learner_.classifier()) round.classifier = learner_.classifier()->digest();
    return round;
  }

  const std::vector<OrientedBox>& truth_;
  const OracleOptions& options_;
  BoxLearner learner_;
  Random random_;
  std::vector<std::size_t> order_;
  int drawn_ = 0;
  int put_right_ = 0;
  int clicks_ = 0;
};

}  // namespace

void OracleOptions::check() const {
  learner.check();
  if (rounds < 1) throw InvalidOption("rounds", std::to_string(rounds), ">= 1");
  const int least = start.empty() ? 1 : 0;
  if (first_boxes < least)
    throw InvalidOption("first_boxes", std::to_string(first_boxes), ">= " + std::to_string(least));
  if (boxes_a_round < 0)
    throw InvalidOption("boxes_a_round", std::to_string(boxes_a_round), ">= 0");
  if (questions_a_round < 0)
    throw InvalidOption("questions_a_round", std::to_string(questions_a_round), ">= 0");
}

BoxScore score_boxes(const std::vector<OrientedBox>& found,
                     const std::vector<OrientedBox>& truth,
                     double min_overlap) {
  const auto match = match_boxes(found, truth, min_overlap);
  const auto right =
      static_cast<double>(std::count_if(match.begin(), match.end(), [](int m) { return m >= 0; }));
  BoxScore score;
  score.precision = found.empty() ? 0.0 : right / static_cast<double>(found.size());
  score.recall = truth.empty() ? 0.0 : right / static_cast<double>(truth.size());
  const double sum = score.precision + score.recall;
  score.f1 = sum > 0.0 ? 2.0 * score.precision * score.recall / sum : 0.0;
  return score;
}

double OracleResult::area_under_curve() const {
  double area = 0.0;
  int labels = 0;
  for (std::size_t i = 1; i < rounds.size(); ++i) {
    const int more =
        rounds[i].drawn + rounds[i].clicks - rounds[i - 1].drawn - rounds[i - 1].clicks;
    area += 0.5 * (rounds[i].f1 + rounds[i - 1].f1) * more;
    labels += more;
  }
  return labels > 0 ? area / labels : 0.0;
}

OracleResult play_oracle(const GroundImage& image,
                         const std::vector<OrientedBox>& truth,
                         const OracleOptions& options) {
  options.check();
  if (truth.empty()) throw InvalidOption("truth", "nothing", "at least one thing to find");
  return Oracle(image, truth, options).play();
}

}  // namespace roadbook
