#pragma once

#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "apps/label_server/http/event_hub.hpp"
#include "apps/label_server/label_answers.hpp"
#include "apps/label_server/label_entry.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_store.hpp"
#include "semantics/oriented_box.hpp"
#include "workflows/labels/label_boxes.hpp"
#include "workflows/labels/people_images.hpp"

namespace roadbook {

/// The labels as pages read and change them. The service stores each change first and then sends it
/// to all pages. Safe to use from several threads. Bodies and answers are JSON as in
/// label_wire.hpp. The methods throw the exceptions of the store, and RequestError.
class LabelService {
 public:
  /// `store`, `hub` and `images` (in which people are shown) must outlive the service.
  LabelService(LabelStore* store,
               EventHub* hub,
               const PeopleImages* images,
               std::vector<LabelClass> classes);

  /// All active labels, by id.
  [[nodiscard]] std::string list() const;
  /// Creates one label. With a field `labels`, creates all of its labels or none.
  [[nodiscard]] nlohmann::json create(const nlohmann::json& body);
  /// Fields that the body lacks stay as they are.
  [[nodiscard]] nlohmann::json change(std::int64_t id, const nlohmann::json& body);
  [[nodiscard]] nlohmann::json remove(std::int64_t id, const nlohmann::json& body);
  /// Undoes (or redoes) the last step of the user `who`, or `count` changes. Returns the labels
  /// that changed. `last` names the request that the page considers the last one of `who`, or it is
  /// the prefix of the names of the page's requests.
  [[nodiscard]] nlohmann::json undo(const nlohmann::json& body);
  [[nodiscard]] nlohmann::json redo(const nlohmann::json& body);
  /// The last `count` events, newest first: who did what when.
  [[nodiscard]] nlohmann::json history(std::size_t count) const;

  /// Returns the boxes from which a detector learns.
  [[nodiscard]] LabelBoxes boxes(const std::string& kind) const;

  /// Return the answers about objects of a class on the ground, and about windows of images, by id.
  [[nodiscard]] std::vector<LabelAnswer> answers(const std::string& kind) const;
  [[nodiscard]] std::vector<LabelAnswer> answers_in_images(const std::string& kind) const;
  /// Active labels of things on the ground, by id.
  [[nodiscard]] std::vector<Label> ground_labels() const;
  /// Active labels of windows in images, by id.
  [[nodiscard]] std::vector<Label> image_labels() const;
  /// Returns {classes, version, who}: the classes of the map, and one class for each other kind of
  /// its labels.
  [[nodiscard]] nlohmann::json classes() const;
  /// Replaces the classes if their version is the one in `body`. A class that has labels stays.
  /// Returns the classes after the change.
  [[nodiscard]] nlohmann::json set_classes(const nlohmann::json& body);
  /// Numbers of active labels on the ground by class.
  [[nodiscard]] std::map<std::string, std::size_t> counts() const;

  /// Returns all changes so far, in order.
  [[nodiscard]] std::vector<LabelEvent> events() const { return store_->events(); }
  [[nodiscard]] const Map& map() const { return store_->map(); }
  [[nodiscard]] std::optional<Label> find(std::int64_t id) const { return store_->find(id); }
  /// Returns a label that conflicts with a request (or the classes, if the id is 0): the current
  /// version and the version sent.
  [[nodiscard]] nlohmann::json conflict(const Label& current, const nlohmann::json& sent) const;

 private:
  /// Sends the changed labels to the pages. The answer names the request that was undone or redone.
  [[nodiscard]] nlohmann::json step_told(const nlohmann::json& body,
                                         const std::vector<Label>& labels);
  [[nodiscard]] Label read(const nlohmann::json& body,
                           const std::vector<Label>& together,
                           const Label* previous = nullptr) const;
  /// Sends the label to the pages, with the name of the request that has changed it.
  nlohmann::json told(const Label& label, const std::string& request);
  nlohmann::json with_classes(nlohmann::json answer);
  [[nodiscard]] LabelClassList shown_classes() const;
  [[nodiscard]] std::vector<Label> active(bool (*wanted)(const Label&)) const;
  nlohmann::json all_told(const std::vector<Label>& labels, const std::string& request);

  LabelStore* store_;
  EventHub* hub_;
  const PeopleImages* images_;
  mutable std::mutex mutex_;
  std::map<std::int64_t, LabelEntry> entries_;
  LabelClassList classes_;
};

}  // namespace roadbook
