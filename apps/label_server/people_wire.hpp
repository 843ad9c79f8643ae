#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "workflows/labels/people_images.hpp"

namespace roadbook {

// Windows of images in the form that the page uses: pixels of the feet and the head, together with
// the stored form (semantics/people/person_camera.hpp).

/// Returns {session, t_ns, camera}. `t_ns` is text, because stamps exceed the precision of numbers
/// in a browser.
[[nodiscard]] nlohmann::json image_to_wire(const LabelAnchor& image);
/// Throws RequestError 422 with the name of the field.
[[nodiscard]] LabelAnchor image_from_wire(const nlohmann::json& body);

/// Returns {azimuth, foot_slope, size, foot: [u, v], head: [u, v], outline: [[u, v], ...]}. Each
/// edge of the outline is a line of many points, because a fisheye lens bends it.
[[nodiscard]] nlohmann::json box_to_wire(const MountedCamera& mounted, const PersonBox& box);

/// Reads a label {shape: "upright", session, t_ns, camera, foot, head} (or azimuth, foot_slope,
/// size instead of pixels) or {shape: "image", ...}. The second form declares that the image shows
/// no person except in the `known` windows. A changed label stays in the image of `previous`.
/// Throws RequestError 422.
[[nodiscard]] Label window_from_wire(const PeopleImages& images,
                                     const nlohmann::json& body,
                                     const std::vector<PersonBox>& known,
                                     const Label* previous = nullptr);
/// Returns whether the body is for `window_from_wire`.
[[nodiscard]] bool is_window_on_wire(const nlohmann::json& body);

}  // namespace roadbook
