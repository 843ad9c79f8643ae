#pragma once

#include <string>
#include <vector>

namespace roadbook {

// Parts of the report's page.

/// Escapes "&", "<", ">" and quotes for use in HTML.
[[nodiscard]] std::string escaped(const std::string& text);

using HtmlRow = std::vector<std::string>;

[[nodiscard]] std::string html_table(const HtmlRow& head, const std::vector<HtmlRow>& rows);
[[nodiscard]] std::string html_section(const std::string& title, const std::string& body);
/// `caption` is HTML.
[[nodiscard]] std::string html_figure(const std::string& svg, const std::string& caption);
/// Draws a stroke of the style sheet's class with its name, for legends.
[[nodiscard]] std::string html_key(const std::string& css_class, const std::string& name);

/// Returns "data:image/...;base64,..." for an encoded picture.
[[nodiscard]] std::string data_uri(const std::string& mime_type,
                                   const std::vector<unsigned char>& bytes);

}  // namespace roadbook
