#pragma once

#include <initializer_list>
#include <pugixml.hpp>
#include <string>
#include <utility>

namespace roadbook {

// Elements of an XML file, which pugixml escapes and writes. These functions add line breaks: a
// file of a hundred thousand elements is readable with one line for each node, lane or object.

using XmlAttributes = std::initializer_list<std::pair<const char*, std::string>>;

/// Returns `text` without the characters that XML 1.0 forbids: control characters other than tab,
/// line feed and carriage return, U+FFFE and U+FFFF. If `text` is not UTF-8, the bytes beyond ASCII
/// are left out too.
[[nodiscard]] std::string xml_characters(const std::string& text);

/// Appends attributes to an element.
void add_attributes(pugi::xml_node node, XmlAttributes attributes);
/// Appends an element to `parent`, on the same line.
pugi::xml_node append_element(pugi::xml_node parent,
                              const char* name,
                              XmlAttributes attributes = {});
/// Appends an element that contains `text`, on the same line.
pugi::xml_node append_text(pugi::xml_node parent, const char* name, const std::string& text);
/// Appends an element on a new line, indented by two spaces for each level.
pugi::xml_node append_line(pugi::xml_node parent, const char* name, XmlAttributes attributes = {});
/// Starts a new line in `parent` for the elements that follow.
void break_line(pugi::xml_node parent);

/// Appends an empty place, before which `insert_line` inserts elements in the order of the calls. A
/// parent with several places keeps its elements in groups.
pugi::xml_node append_place(pugi::xml_node parent);
pugi::xml_node insert_line(pugi::xml_node place, const char* name, XmlAttributes attributes = {});

/// Returns the file: XML declaration, then the top-level element. The end tag of an element whose
/// children begin on a new line begins on a new line, too.
[[nodiscard]] std::string xml_text(pugi::xml_document& document);

}  // namespace roadbook
