#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "semantics/labels/labels.hpp"

namespace roadbook {

// The fields of a label that say what it is, for labels on the ground and in images.

/// Reads `kind`: a class of at most 64 characters, or the rejection of one. Throws RequestError
/// 422.
[[nodiscard]] std::string kind_field(const nlohmann::json& body);

/// Reads class, source, score and note. Throws RequestError 422.
void read_label_fields(const nlohmann::json& body, Label* label);

}  // namespace roadbook
