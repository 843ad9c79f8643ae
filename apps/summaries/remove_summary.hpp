#pragma once

#include <string>

#include "apps/console.hpp"
#include "workflows/removed_session.hpp"

namespace roadbook {

/// Prints what the removal of `session` left and took.
void print_removal(const Console& console, const RemoveResult& result, const std::string& session);

}  // namespace roadbook
