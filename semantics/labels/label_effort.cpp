#include "semantics/labels/label_effort.hpp"

#include <algorithm>
#include <optional>

#include "semantics/labels/label_classes.hpp"

namespace roadbook {
namespace {

// Events in [first, last) that one request stored.
struct StepEvents {
  std::size_t first = 0;
  std::size_t last = 0;
};

std::vector<StepEvents> steps_of(const LabelReplay& replay) {
  const auto& events = replay.events();
  std::vector<StepEvents> steps;
  for (std::size_t i = 0; i < events.size(); ++i) {
    const std::string& request = replay.request_of(events[i].event);
    const bool goes_on = i > 0 && !request.empty() &&
                         request == replay.request_of(events[i - 1].event) &&
                         events[i].label.who == events[i - 1].label.who;
    if (!goes_on) steps.push_back({i, i});
    steps.back().last = i + 1;
  }
  return steps;
}

// A page stores a row as a list of boxes, even if the list has only one box.
bool is_of_a_row(const LabelEvent& event) {
  return event.together && event.label.source == LabelSource::kDrawn && is_on_ground(event.label);
}

LabelStep step_of(const LabelEvent& first) {
  if (first.undoes != 0) return LabelStep::kUndo;
  switch (first.action) {
    case LabelAction::kDelete:
      return LabelStep::kDelete;
    case LabelAction::kCreate:
      break;
    case LabelAction::kChange:
    case LabelAction::kRestore:
    case LabelAction::kClasses:
      return LabelStep::kChange;
  }
  if (first.label.shape == LabelShape::kImage) return LabelStep::kAccept;
  if (is_rejected_kind(first.label.kind)) return LabelStep::kReject;
  if (first.label.source != LabelSource::kDrawn) return LabelStep::kAccept;
  return is_of_a_row(first) ? LabelStep::kFill : LabelStep::kDraw;
}

std::size_t clicks_of(LabelStep step, const Label& first) {
  if (step != LabelStep::kDraw) return 1;
  switch (first.shape) {
    case LabelShape::kBox:
      return 3;
    case LabelShape::kPolygon:
      return first.corners_vehicle.size() + 1;
    case LabelShape::kUpright:
      return 2;
    case LabelShape::kImage:
      break;
  }
  return 1;
}

void count_event(const LabelEvent& event, bool by_page, LabelEffort& effort) {
  if (event.action != LabelAction::kCreate)
    ++effort.changes;
  else if (!by_page && event.label.source == LabelSource::kDrawn)
    ++effort.imported;
  else if (event.label.shape == LabelShape::kImage)
    ++effort.images;
  else if (is_rejected_kind(event.label.kind))
    ++effort.rejected;
  else if (event.label.source != LabelSource::kDrawn)
    ++effort.accepted;
  else
    ++(is_of_a_row(event) ? effort.filled : effort.drawn);
}

}  // namespace

std::size_t LabelEffort::all_clicks() const {
  std::size_t sum = 0;
  for (const auto& [step, count] : clicks) sum += count;
  return sum;
}

LabelLedger label_effort(const LabelReplay& replay) {
  LabelLedger ledger;
  std::map<std::string, std::int64_t> last_ns;  // of each labeller
  for (const StepEvents& step : steps_of(replay)) {
    const LabelEvent& first = replay.events()[step.first];
    const std::string& request = replay.request_of(first.event);
    const bool by_page = !request.empty() && !request.starts_with(kImportRequest);
    const auto efforts_of = [&](const LabelEvent& event) {
      std::vector<LabelEffort*> efforts{&ledger.all};
      if (event.action != LabelAction::kClasses)
        efforts.push_back(&ledger.classes[searched_kind(event.label.kind)]);
      return efforts;
    };
    for (std::size_t i = step.first; i < step.last; ++i)
      for (LabelEffort* effort : efforts_of(replay.events()[i]))
        count_event(replay.events()[i], by_page, *effort);
    if (!by_page) continue;
    const auto [last, is_first] = last_ns.try_emplace(first.label.who, first.label.t_ns);
    const double since_s = static_cast<double>(first.label.t_ns - last->second) * 1e-9;
    last->second = first.label.t_ns;
    const LabelStep what = step_of(first);
    for (LabelEffort* effort : efforts_of(first)) {
      effort->clicks[what] += clicks_of(what, first.label);
      effort->seconds += std::clamp(since_s, 0.0, kLongestPauseS);
    }
  }
  for (const Label& label : replay.active()) {
    if (is_rejected_kind(label.kind)) continue;
    ++ledger.classes[label.kind].labels;
    ++ledger.all.labels;
  }
  return ledger;
}

}  // namespace roadbook
