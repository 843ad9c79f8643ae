#include "apps/report/html.hpp"

#include "base/base64.hpp"

namespace roadbook {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

std::string html_table(const HtmlRow& head, const std::vector<HtmlRow>& rows) {
  std::string html = "<div class=\"scroll\"><table><thead><tr>";
  for (const std::string& cell : head) html += "<th>" + escaped(cell) + "</th>";
  html += "</tr></thead><tbody>";
  for (const HtmlRow& row : rows) {
    html += "<tr>";
    for (const std::string& cell : row) html += "<td>" + escaped(cell) + "</td>";
    html += "</tr>";
  }
  return html + "</tbody></table></div>\n";
}

std::string html_section(const std::string& title, const std::string& body) {
  return "<section><h2>" + escaped(title) + "</h2>\n" + body + "</section>\n";
}

std::string html_figure(const std::string& svg, const std::string& caption) {
  return "<figure>" + svg + "<figcaption>" + caption + "</figcaption></figure>\n";
}

std::string html_key(const std::string& css_class, const std::string& name) {
  return "<span class=\"key\"><svg viewBox=\"0 0 22 8\"><path class=\"" + css_class +
         "\" d=\"M1 4H21\"/></svg>" + escaped(name) + "</span> ";
}

std::string data_uri(const std::string& mime_type, const std::vector<unsigned char>& bytes) {
  return "data:" + mime_type + ";base64," +
         to_base64({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace roadbook
