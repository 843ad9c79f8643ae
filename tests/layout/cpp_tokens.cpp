#include <algorithm>
#include <cctype>

#include "tests/layout/declared_names.hpp"

namespace roadbook::test {
namespace {

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }
bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

// One past `end`, which is sought from `from`.
std::size_t past(const std::string& text, const std::string& end, std::size_t from) {
  const std::size_t at = text.find(end, from);
  return at == std::string::npos ? text.size() : at + end.size();
}

std::size_t past_preprocessor(const std::string& text, std::size_t at) {
  do at = std::min(text.find('\n', at + 1), text.size());
  while (at < text.size() && text[at - 1] == '\\');
  return at;
}

std::size_t past_raw_string(const std::string& text, std::size_t at) {
  const std::size_t open = std::min(text.find('(', at), text.size());
  return past(text, ")" + text.substr(at + 2, open - at - 2) + "\"", open);
}

std::size_t past_string(const std::string& text, std::size_t at) {
  const char quote = text[at];
  for (++at; at < text.size() && text[at] != quote; ++at)
    if (text[at] == '\\') ++at;
  return std::min(at + 1, text.size());
}

std::size_t past_word(const std::string& text, std::size_t at) {
  const bool number = is_digit(text[at]);
  while (at < text.size() && (in_word(text[at]) || (number && text[at] == '\''))) ++at;
  return at;
}

bool is_pair(const std::string& two) {
  return two == "::" || two == "==" || two == "<=" || two == ">=" || two == "!=" || two == "->";
}

bool begins_line(const std::string& text, std::size_t at) {
  while (at > 0 && text[at - 1] == ' ') --at;
  return at == 0 || text[at - 1] == '\n';
}

}  // namespace

std::vector<std::string> cpp_tokens(const std::string& text) {
  std::vector<std::string> tokens;
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    const std::string two = text.substr(at, 2);
    const std::size_t from = at;
    if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      ++at;
    } else if (two == "//") {
      at = past(text, "\n", at);
    } else if (two == "/*") {
      at = past(text, "*/", at + 2);
    } else if (c == '#' && begins_line(text, at)) {
      at = past_preprocessor(text, at);
    } else if (two == "R\"" || c == '"' || c == '\'') {
      at = c == 'R' ? past_raw_string(text, at) : past_string(text, at);
      tokens.emplace_back("\"");
    } else {
      at = in_word(c) ? past_word(text, at) : at + (is_pair(two) ? 2 : 1);
      tokens.push_back(text.substr(from, at - from));
    }
  }
  return tokens;
}

}  // namespace roadbook::test
