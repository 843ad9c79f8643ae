#include "semantics/labels/label_store.hpp"

#include <algorithm>
#include <functional>
#include <mutex>
#include <utility>

#include "base/wall_clock.hpp"
#include "mapping/pieces.hpp"
#include "mapping/store/map_event_log.hpp"
#include "mapping/store/map_file.hpp"
#include "semantics/labels/classes_in_use.hpp"
#include "semantics/labels/label_check.hpp"
#include "semantics/labels/label_last_step.hpp"
#include "semantics/labels/label_replay.hpp"
#include "semantics/labels/turn_taker.hpp"

namespace roadbook {

struct LabelStore::Impl {
  explicit Impl(const std::filesystem::path& path)
      : log(path, kLabelLog),
        map(load_joined_map(path)),
        file(path.string()),
        replay(log.events(), file) {}

  // Runs `work`, which changes the replay by `store`. Returns when the changes are on the disk.
  std::vector<Label> run(std::function<std::vector<Label>()> work) {
    return turns.run(std::move(work), [this](const auto& jobs) { run_all(jobs); });
  }

  // Stores all jobs in one transaction. When the mutex is free, the memory holds exactly the stored
  // events.
  void run_all(const std::vector<TurnTaker::Job*>& jobs) {
    const std::scoped_lock lock(mutex);
    pending.clear();
    pending_classes.reset();
    for (TurnTaker::Job* job : jobs) {
      const std::size_t before = pending.size();
      const auto classes_before = pending_classes;
      try {
        job->labels = job->work();
      } catch (...) {
        job->fault = std::current_exception();
        if (pending.size() > before) take_out(before, classes_before);
      }
    }
    try {
      log.append(pending, pending_classes ? &*pending_classes : nullptr);
    } catch (...) {
      replay = LabelReplay(log.events(), file);
      for (TurnTaker::Job* job : jobs)
        if (!job->fault) job->fault = std::current_exception();
    }
  }

  // Removes the events of a job that failed midway. A step is stored completely or not at all.
  void take_out(std::size_t before, const std::optional<PlainTable>& classes_before) {
    pending.resize(before);
    pending_classes = classes_before;
    std::vector<std::string> contents = log.events();
    contents.insert(contents.end(), pending.begin(), pending.end());
    replay = LabelReplay(contents, file);
  }

  // Called by a job. The event is in memory at once. It is on the disk when all jobs of the turn
  // have run.
  Label store(LabelAction action,
              Label label,
              const std::string& who,
              const std::string& request,
              std::int64_t undoes = 0,
              bool together = false) {
    label.who = who;
    label.t_ns = wall_clock_ns();
    // Undo and redo do not show the label to a person. The label keeps the place where a person saw
    // it before.
    // Where the map does not know its accuracy, no later shift of the label can be judged.
    if (const auto seen = seen_in_map(map, label); seen && undoes == 0)
      label.seen = is_known(seen->covariance) ? seen : std::nullopt;
    StoredEvent stored{{static_cast<std::int64_t>(replay.events().size()) + 1, action,
                        std::move(label), undoes, together},
                       request};
    pending.push_back(content_of(stored));
    replay.take(stored);
    return stored.event.label;
  }
  void store_classes(const std::vector<LabelClass>& before,
                     const std::vector<LabelClass>& classes,
                     const std::string& who,
                     const std::string& request,
                     std::int64_t undoes = 0) {
    LabelEvent event;
    event.event = static_cast<std::int64_t>(replay.events().size()) + 1;
    event.action = LabelAction::kClasses;
    event.label.version = replay.classes().version + 1;
    event.label.who = who;
    event.label.t_ns = wall_clock_ns();
    event.classes = classes;
    event.classes_before = before;
    event.undoes = undoes;
    const StoredEvent stored{event, request};
    pending.push_back(content_of(stored));
    pending_classes = label_class_table(classes);
    replay.take(stored);
  }
  Label store_new(Label label, const std::string& who, const std::string& request, bool together) {
    const auto& known = replay.labels();
    label.id = known.empty() ? 1 : known.rbegin()->first + 1;
    label.version = 1;
    label.state = LabelState::kActive;
    return store(LabelAction::kCreate, std::move(label), who, request, 0, together);
  }
  const Label& at_version(std::int64_t id, std::int64_t version) const {
    const auto found = replay.labels().find(id);
    if (found == replay.labels().end())
      throw BadInput(
          {Severity::kError, file, 0, "label", std::to_string(id), "a label of this map"});
    if (found->second.version != version) throw LabelConflict(found->second);
    return found->second;
  }
  Label store_change(Label label,
                     const std::string& who,
                     const std::string& request,
                     bool together) {
    const Label& now = at_version(label.id, label.version);
    // Only a new anchor is checked. If the map has lost the old anchor, the label may still change.
    if (now.anchor != label.anchor) check_label_anchor(map, label, file);
    forget_other_search(now, label);
    const bool restored = now.state == LabelState::kDeleted;
    label.state = LabelState::kActive;
    ++label.version;
    return store(restored ? LabelAction::kRestore : LabelAction::kChange, std::move(label), who,
                 request, 0, together);
  }
  // Restores the labels to their states before the events.
  std::vector<Label> take_back(const std::string& who,
                               bool undone,
                               const std::string& request,
                               const StepBack& step) {
    if (auto answered = replay.answer_to(who, request)) return *answered;
    std::vector<Label> labels;
    for (const std::int64_t number : last_step(replay, who, undone, step)) {
      if (replay.event(number).action == LabelAction::kClasses) {
        const auto before = replay.event(number).classes_before;
        const auto& shown = replay.classes().classes;
        if (const auto kind = class_in_use(replay.labels(), shown, before))
          throw LabelClassInUse(*kind);
        store_classes(shown, before, who, request, number);
        continue;
      }
      const LabelEvent event = replay.event(number);
      const Label now = replay.labels().at(event.label.id);
      const auto before = replay.before(event);
      Label label = before ? *before : now;
      if (!before) label.state = LabelState::kDeleted;
      label.version = now.version + 1;
      const LabelAction action = label.state == LabelState::kDeleted ? LabelAction::kDelete
                                 : now.state == LabelState::kDeleted ? LabelAction::kRestore
                                                                     : LabelAction::kChange;
      labels.push_back(store(action, std::move(label), who, request, number));
    }
    return labels;
  }

  mutable std::mutex mutex;
  TurnTaker turns;
  MapEventLog log;
  Map map;
  std::string file;
  LabelReplay replay;
  std::vector<std::string> pending;
  std::optional<PlainTable> pending_classes;  ///< the table, if a pending event changes it
};

LabelStore::LabelStore(const std::filesystem::path& map) : impl_(std::make_unique<Impl>(map)) {}
LabelStore::~LabelStore() = default;

const Map& LabelStore::map() const { return impl_->map; }

std::vector<Label> LabelStore::labels(bool deleted) const {
  const std::scoped_lock lock(impl_->mutex);
  return impl_->replay.active(deleted);
}

std::optional<Label> LabelStore::find(std::int64_t id) const {
  const std::scoped_lock lock(impl_->mutex);
  const auto found = impl_->replay.labels().find(id);
  return found == impl_->replay.labels().end() ? std::nullopt : std::optional(found->second);
}

std::vector<LabelEvent> LabelStore::events(std::int64_t after) const {
  const std::scoped_lock lock(impl_->mutex);
  const auto& all = impl_->replay.events();
  const auto first = std::clamp<std::int64_t>(after, 0, static_cast<std::int64_t>(all.size()));
  return {all.begin() + first, all.end()};
}

Label LabelStore::create(const Label& label, const std::string& who, const std::string& request) {
  check_new_label(label, "label");
  const auto work = [&]() -> std::vector<Label> {
    if (auto answered = impl_->replay.answer_to(who, request)) return *answered;
    check_label_anchor(impl_->map, label, impl_->file);
    return {impl_->store_new(label, who, request, false)};
  };
  return impl_->run(work).front();
}

Label LabelStore::change(const Label& label, const std::string& who, const std::string& request) {
  check_new_label(label, "label");
  const auto work = [&]() -> std::vector<Label> {
    if (auto answered = impl_->replay.answer_to(who, request)) return *answered;
    return {impl_->store_change(label, who, request, false)};
  };
  return impl_->run(work).front();
}

Label LabelStore::remove(std::int64_t id,
                         std::int64_t version,
                         const std::string& who,
                         const std::string& request) {
  const auto work = [&]() -> std::vector<Label> {
    if (auto answered = impl_->replay.answer_to(who, request)) return *answered;
    Label label = impl_->at_version(id, version);
    label.state = LabelState::kDeleted;
    ++label.version;
    return {impl_->store(LabelAction::kDelete, std::move(label), who, request)};
  };
  return impl_->run(work).front();
}

std::vector<Label> LabelStore::create_all(const std::vector<Label>& labels,
                                          const std::string& who,
                                          const std::string& request,
                                          const std::vector<Label>& changed) {
  for (std::size_t i = 0; i < labels.size(); ++i)
    check_new_label(labels[i], "label " + std::to_string(i + 1));
  for (const Label& label : changed) check_new_label(label, "label");
  const auto work = [&] {
    if (auto answered = impl_->replay.answer_to(who, request)) return *answered;
    std::vector<Label> stored;
    for (const Label& label : labels) check_label_anchor(impl_->map, label, impl_->file);
    for (const Label& label : labels) stored.push_back(impl_->store_new(label, who, request, true));
    for (const Label& label : changed)
      stored.push_back(impl_->store_change(label, who, request, true));
    return stored;
  };
  return impl_->run(work);
}

std::vector<Label> LabelStore::undo(const std::string& who,
                                    const std::string& request,
                                    const StepBack& step) {
  return impl_->run([&] { return impl_->take_back(who, false, request, step); });
}

std::vector<Label> LabelStore::redo(const std::string& who,
                                    const std::string& request,
                                    const StepBack& step) {
  return impl_->run([&] { return impl_->take_back(who, true, request, step); });
}

std::string LabelStore::taken_by(const std::string& who, const std::string& request) const {
  const std::scoped_lock lock(impl_->mutex);
  return impl_->replay.taken_by(who, request);
}

LabelClassList LabelStore::set_classes(const std::vector<LabelClass>& before,
                                       const LabelClassList& wanted,
                                       const std::string& request) {
  check_label_classes(wanted.classes);
  const auto work = [&]() -> std::vector<Label> {
    if (impl_->replay.answer_to(wanted.who, request)) return {};
    const LabelClassList& known = impl_->replay.classes();
    if (known.version != wanted.version) throw LabelConflict(standing(known));
    const auto& labels = impl_->replay.labels();
    const auto shown =
        with_kinds(known.version == 0 ? before : known.classes, kinds_in_use(labels));
    if (const auto kind = class_in_use(labels, shown, wanted.classes)) throw LabelClassInUse(*kind);
    impl_->store_classes(shown, wanted.classes, wanted.who, request);
    return {};
  };
  (void)impl_->run(work);
  return classes();
}

LabelClassList LabelStore::classes() const {
  const std::scoped_lock lock(impl_->mutex);
  return impl_->replay.classes();
}

void LabelStore::write_table(const PlainTable& table) {
  const std::scoped_lock lock(impl_->mutex);
  impl_->log.write_table(table);
}

}  // namespace roadbook
