#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "apps/label_server/label_fields.hpp"
#include "apps/label_server/request_fields.hpp"
#include "semantics/labels/label_classes.hpp"
#include "semantics/labels/label_store.hpp"

namespace roadbook {

// Labels in the form that the page uses: coordinates of the current map in metres and radians. A
// stored label is relative to a vehicle pose (semantics/labels/labels.hpp). These functions convert
// between the two forms.

/// {classes, version, who, when}.
[[nodiscard]] nlohmann::json classes_to_wire(const LabelClassList& list);
/// Reads the fields `classes` (a list of {kind, title, colour, shape}), `version` (the version to
/// replace) and `who`. Throws RequestError 422.
[[nodiscard]] LabelClassList classes_from_wire(const nlohmann::json& body);

/// The result has `moved_m` if the label has moved farther since a user saw it than its covariance
/// predicts.
[[nodiscard]] nlohmann::json label_to_wire(const Map& map, const Label& label);

/// Returns a label in which the fields of `body` replace the label's fields. If `body` has feet and
/// head, these replace the angles of a window.
[[nodiscard]] nlohmann::json changed_on_wire(const Map& map,
                                             const Label& label,
                                             const nlohmann::json& body);

/// Returns whether a change concerns the shape or place of a label.
[[nodiscard]] bool tells_shape(const nlohmann::json& body);

/// Returns a label with the class, source, score and note that `body` gives. The stored place does
/// not change, even if the current map has no place for the label. Throws RequestError 422.
[[nodiscard]] Label with_fields(const Map& map, Label label, const nlohmann::json& body);

/// Reads a box {shape: "box", x, y, heading, length, width} or a polygon {shape: "polygon",
/// corners: [[x, y], ...]} and anchors it to the image that shows it best. The label keeps the
/// image of `previous` if its middle has moved by less than one metre. Then the camera view does
/// not change while the user adjusts the label. A new shape has the accuracy of a drawn shape. So
/// does a hypothesis that a user has corrected before accepting it (`shaped`). If `body` has
/// `pose`, the shape was drawn on an earlier state of the map (moved_place.hpp). Throws
/// RequestError 422.
[[nodiscard]] Label label_from_wire(const Map& map,
                                    const nlohmann::json& body,
                                    const Label* previous = nullptr);

}  // namespace roadbook
