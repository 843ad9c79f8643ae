#include "workflows/labels/round_replay.hpp"

#include <algorithm>
#include <iterator>

#include "base/digest.hpp"
#include "workflows/labels/label_boxes.hpp"
#include "workflows/labels/label_place.hpp"

namespace roadbook {

std::string round_basis(const Map& map, const GroundImage& image, const BoxExamples& taught) {
  Sha256 digest;
  digest.update(map_version(map) + "\n" + picture_version(image) + "\n");
  for (const double number :
       {image.corner.x(), image.corner.y(), image.resolution_m, taught.length_m, taught.width_m})
    digest.update(number);
  for (const int label : taught.labels) digest.update(std::int64_t{label});
  for (const float value : taught.features.reshaped()) digest.update(static_cast<double>(value));
  return digest.hex().substr(0, 16);
}

std::optional<Eigen::Vector2d> window_before(const std::vector<LearningRound>& rounds,
                                             const std::string& kind) {
  const auto last = std::find_if(rounds.rbegin(), rounds.rend(),
                                 [&](const LearningRound& r) { return r.kind == kind; });
  if (last == rounds.rend() || !(last->window_length_m > 0.0 && last->window_width_m > 0.0))
    return std::nullopt;
  return Eigen::Vector2d(last->window_length_m, last->window_width_m);
}

std::string replayed_classifier(const Map& map,
                                const GroundImage& image,
                                const BoxExamples& taught,
                                const BoxLearnerOptions& options,
                                const std::vector<LabelEvent>& events,
                                const std::vector<LearningRound>& rounds,
                                std::size_t number) {
  const LearningRound& round = rounds.at(number);
  std::vector<LabelEvent> known;
  std::copy_if(events.begin(), events.end(), std::back_inserter(known),
               [&](const LabelEvent& event) { return event.event <= round.event; });
  const LabelBoxes boxes = label_boxes(map, known, round.kind);
  BoxLearner learner(image, options);
  if (!taught.empty()) learner.start_from(taught);
  const auto begin = rounds.begin();
  if (const auto window =
          window_before({begin, begin + static_cast<std::ptrdiff_t>(number)}, round.kind))
    learner.begin_window(window->x(), window->y());
  learner.set_examples(boxes.positives, boxes.negatives);
  return learner.train() ? learner.classifier()->digest() : std::string();
}

}  // namespace roadbook
