#pragma once

#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_store.hpp"

namespace roadbook {

// Labels as the page sees them: in coordinates of the map of today, metres and radians. What is
// stored hangs on a vehicle pose (semantics/labels/labels.hpp); these functions go between the two.

/// A request that cannot be met: its answer is {"error": what(), ...details} with that status.
class RequestError : public std::runtime_error {
 public:
  RequestError(int status, const std::string& message)
      : std::runtime_error(message), status_(status) {}
  [[nodiscard]] int status() const { return status_; }

 private:
  int status_;
};

/// Throws RequestError 422: "field: got ..., want ...".
[[noreturn]] void refuse_field(const std::string& field,
                               const std::string& got,
                               const std::string& want);

/// A JSON object of at most 8 levels. Throws RequestError 400.
[[nodiscard]] nlohmann::json parse_body(const std::string& body);

// Fields of an object; throw RequestError 422 naming the field where it is missing or of another
// kind.
[[nodiscard]] double number_field(const nlohmann::json& body, const char* name);
[[nodiscard]] std::int64_t integer_field(const nlohmann::json& body, const char* name);
[[nodiscard]] bool flag_field(const nlohmann::json& body, const char* name);
/// A pair of numbers, of `corners`.
[[nodiscard]] Eigen::Vector2d point_field(const nlohmann::json& value);
/// At most `longest` characters of printable text.
[[nodiscard]] std::string text_field(const nlohmann::json& body,
                                     const char* name,
                                     std::size_t longest = 64);

/// {classes, version, who, when}.
[[nodiscard]] nlohmann::json classes_to_wire(const LabelClassList& list);
/// Fields `classes`, a list of {kind, title, colour, shape}, `version` (that they replace) and
/// `who`. Throws RequestError 422.
[[nodiscard]] LabelClassList classes_from_wire(const nlohmann::json& body);

/// Class, source, score, note. Throws RequestError 422.
void read_label_fields(const nlohmann::json& body, Label* label);

/// `moved_m` where it has moved farther since a person saw it than its covariance told.
[[nodiscard]] nlohmann::json label_to_wire(const Map& map, const Label& label);

/// A label with the fields of `body` in place of its own; feet and head, where they are given, in
/// place of the angles of a window.
[[nodiscard]] nlohmann::json changed_on_wire(const Map& map,
                                             const Label& label,
                                             const nlohmann::json& body);

/// Whether a change is about the shape or place of a label.
[[nodiscard]] bool tells_shape(const nlohmann::json& body);

/// A label with the class, source, score and note that `body` gives; where it is stays as stored,
/// also where the map of today has no place for it. Throws RequestError 422.
[[nodiscard]] Label with_fields(const Map& map, Label label, const nlohmann::json& body);

/// A box {shape: "box", x, y, heading, length, width} or polygon {shape: "polygon", corners: [[x,
/// y], ...]} hung on the image that shows it best. `previous` keeps its image where the middle
/// moved by less than a metre: the view beside the map stays while a label is nudged. A new shape
/// is a hand's work and as exact as one that was drawn, and so is one that was found and is told to
/// be `shaped` by a hand before it was accepted. With `pose` it was drawn on an earlier state of
/// the map (moved_place.hpp). Throws RequestError 422.
[[nodiscard]] Label label_from_wire(const Map& map,
                                    const nlohmann::json& body,
                                    const Label* previous = nullptr);

}  // namespace roadbook
