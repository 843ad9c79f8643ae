#pragma once

#include <string>

#include "apps/console.hpp"
#include "workflows/removed_session.hpp"

namespace roadbook {

/// Prints the result of the removal of `session`.
void print_removal(const Console& console, const RemoveResult& result, const std::string& session);

}  // namespace roadbook
