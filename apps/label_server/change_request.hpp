#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "semantics/labels/label_store.hpp"

namespace roadbook {

// These functions read the general fields in the body of a change request: the user, the name of
// the request, and the state from which the change starts. All throw RequestError 422.

[[nodiscard]] std::string who_of(const nlohmann::json& body);
/// Empty if the body has no name.
[[nodiscard]] std::string request_name(const nlohmann::json& body);

/// Reads `count`, `last` and `passed` of an undo or redo step, where they are given.
[[nodiscard]] StepBack step_of(const nlohmann::json& body);

/// Two copies of a map file that were labelled separately can both have this version number of a
/// label. A request is unambiguous if it also gives the time of the version (`when`). Returns
/// whether the request means another version than the one made at `t_ns`.
[[nodiscard]] bool is_of_another_history(const nlohmann::json& body,
                                         std::int64_t version,
                                         std::int64_t t_ns);

}  // namespace roadbook
