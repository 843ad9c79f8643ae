#include "exchange/export/xml_elements.hpp"

#include <sstream>
#include <string_view>

#include "base/utf8.hpp"

namespace roadbook {
namespace {

std::size_t level_of(pugi::xml_node node) {
  std::size_t level = 0;
  for (; node.parent() && node.parent().type() != pugi::node_document; node = node.parent())
    ++level;
  return level;
}

std::string line_start(std::size_t level) { return "\n" + std::string(2 * level, ' '); }

void break_before_end_tags(pugi::xml_node node) {
  const pugi::xml_node first = node.first_child();
  const std::string_view text = first.value();
  const bool lines = first.type() == pugi::node_pcdata && (text.empty() || text[0] == '\n');
  for (const pugi::xml_node child : node.children())
    if (child.type() == pugi::node_element) break_before_end_tags(child);
  if (lines) node.append_child(pugi::node_pcdata).set_value(line_start(level_of(node)).c_str());
}

}  // namespace

std::string xml_characters(const std::string& text) {
  const bool utf8 = utf8_characters(text).has_value();
  std::string result;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    const bool control = byte < 0x20U && byte != '\t' && byte != '\n' && byte != '\r';
    if (control || (byte >= 0x80U && !utf8)) continue;
    const std::string_view three = std::string_view(text).substr(i, 3);
    if (three == "\xEF\xBF\xBE" || three == "\xEF\xBF\xBF")
      i += 2;
    else
      result += text[i];
  }
  return result;
}

void add_attributes(pugi::xml_node node, XmlAttributes attributes) {
  for (const auto& [name, value] : attributes)
    node.append_attribute(name).set_value(xml_characters(value).c_str());
}

pugi::xml_node append_element(pugi::xml_node parent, const char* name, XmlAttributes attributes) {
  const pugi::xml_node node = parent.append_child(name);
  add_attributes(node, attributes);
  return node;
}

pugi::xml_node append_text(pugi::xml_node parent, const char* name, const std::string& text) {
  const pugi::xml_node node = parent.append_child(name);
  node.text().set(xml_characters(text).c_str());
  return node;
}

pugi::xml_node append_line(pugi::xml_node parent, const char* name, XmlAttributes attributes) {
  break_line(parent);
  return append_element(parent, name, attributes);
}

void break_line(pugi::xml_node parent) {
  parent.append_child(pugi::node_pcdata).set_value(line_start(level_of(parent) + 1).c_str());
}

pugi::xml_node append_place(pugi::xml_node parent) {
  return parent.append_child(pugi::node_pcdata);
}

pugi::xml_node insert_line(pugi::xml_node place, const char* name, XmlAttributes attributes) {
  pugi::xml_node parent = place.parent();
  parent.insert_child_before(pugi::node_pcdata, place)
      .set_value(line_start(level_of(parent) + 1).c_str());
  const pugi::xml_node node = parent.insert_child_before(name, place);
  add_attributes(node, attributes);
  return node;
}

std::string xml_text(pugi::xml_document& document) {
  break_before_end_tags(document.document_element());
  std::ostringstream text;
  text << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
  document.save(text, "", pugi::format_raw | pugi::format_no_declaration, pugi::encoding_utf8);
  text << '\n';
  return text.str();
}

}  // namespace roadbook
