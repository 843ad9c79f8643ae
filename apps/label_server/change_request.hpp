#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "semantics/labels/label_store.hpp"

namespace roadbook {

// What the body of a change says beside what is changed: who asks for it, under which name, from
// what it begins. All throw RequestError 422.

[[nodiscard]] std::string who_of(const nlohmann::json& body);
/// Empty where it has none.
[[nodiscard]] std::string request_name(const nlohmann::json& body);

/// `count`, `last` and `passed` of a step back, each where it is given.
[[nodiscard]] StepBack step_of(const nlohmann::json& body);

/// Files that were copied and labelled apart may each have that version of a label: whoever names
/// (`when`) also when it was made means one of them. Whether it is another than the one made at
/// `t_ns`.
[[nodiscard]] bool is_of_another_history(const nlohmann::json& body,
                                         std::int64_t version,
                                         std::int64_t t_ns);

}  // namespace roadbook
