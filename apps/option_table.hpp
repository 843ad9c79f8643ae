#pragma once

#include <string>

#include "apps/verb.hpp"

namespace roadbook {

/// The options of `verb` as a Markdown table, without those that all verbs share. Part of
/// docs/reference/command_line.md; a test compares.
[[nodiscard]] std::string option_table(const Verb& verb);

/// `page` with the table of each verb between its marks `<!-- options of VERB -->` and `<!-- end
/// -->` replaced by the program's own.
[[nodiscard]] std::string with_option_tables(const std::string& page);

}  // namespace roadbook
