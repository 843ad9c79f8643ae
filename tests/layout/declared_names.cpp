#include "tests/layout/declared_names.hpp"

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <span>
#include <string_view>

namespace roadbook::test {
namespace {

using Tokens = std::span<const std::string>;

bool is_one_of(const std::string& token, std::initializer_list<std::string_view> words) {
  return std::find(words.begin(), words.end(), token) != words.end();
}

bool contains(Tokens tokens, const std::string& word) {
  return std::find(tokens.begin(), tokens.end(), word) != tokens.end();
}

bool is_name(const std::string& t) {
  return std::isalpha(static_cast<unsigned char>(t[0])) != 0 || t[0] == '_';
}

bool is_constant(const std::string& t) {
  return t.size() > 1 && t[0] == 'k' && std::isupper(static_cast<unsigned char>(t[1])) != 0;
}

bool is_type_word(const std::string& t) {
  return is_one_of(t, {"struct", "class", "enum", "union"});
}

bool opens(const std::string& t) { return is_one_of(t, {"(", "[", "{"}); }
bool closes(const std::string& t) { return is_one_of(t, {")", "]", "}"}); }

// One past the bracket that closes the one at `from`.
std::size_t past_bracket(Tokens all, std::size_t from) {
  int depth = 0;
  for (std::size_t i = from; i < all.size(); ++i) {
    depth += opens(all[i]) ? 1 : closes(all[i]) ? -1 : 0;
    if (depth == 0) return i + 1;
  }
  return all.size();
}

std::string joined(Tokens tokens) {
  std::string text;
  for (const std::string& t : tokens) text += t + " ";
  return text;
}

// A statement without the text in brackets (angle brackets too, up to a value) and without
// specifiers.
std::vector<std::string> outline_of(Tokens statement) {
  std::vector<std::string> kept;
  int angles = 0;
  bool value = false;
  for (std::size_t i = 0; i < statement.size(); ++i) {
    const std::string& t = statement[i];
    value = value || t == "=";
    if (!value && t == "<") ++angles;
    if (angles == 0 && !is_one_of(t, {"template", "static", "inline", "constexpr", "const"}))
      if (t != "[" || !kept.empty()) kept.push_back(t);  // not of attributes
    if (!value && t == ">") --angles;
    if (opens(t)) i = past_bracket(statement, i) - 1;
  }
  return kept;
}

struct Declaration {
  std::vector<std::string> names;  // that matter here
  std::string harmless;            // the text, where another of the same text does no harm
  bool function = false;
};

// Declares a function or variables; false for qualified names (defined outside of their class),
// operators and calls of macros.
Declaration functions_and_variables(const std::vector<std::string>& line) {
  if (is_one_of(line[0], {"static_assert", "extern", "friend", "typedef"})) return {};
  std::size_t at = 1;
  while (at < line.size() && !is_one_of(line[at], {"(", "=", "["})) ++at;
  const bool qualified = at >= 2 && line[at - 2] == "::";
  if (at == 1 || qualified || !is_name(line[at - 1]) || contains(line, "operator")) return {};
  Declaration found{{line[at - 1]}, "", at < line.size() && line[at] == "("};
  for (std::size_t i = at; !found.function && i + 2 < line.size(); ++i)
    if (line[i] == "," && is_name(line[i + 1]) && line[i + 2] == "=")
      found.names.push_back(line[i + 1]);
  return found;
}

// Of a statement up to its `;` or its body.
Declaration declaration_of(Tokens statement, bool body) {
  const std::vector<std::string> line = outline_of(statement);
  if (line.size() < 2) return {};
  if (line[0] == "using" || line[0] == "namespace") {
    if (line[1] == "namespace") return {};
    const bool alias = line.size() > 2 && line[2] == "=";
    return {{alias ? line[1] : line.back()}, joined(statement), false};
  }
  if (is_type_word(line[0])) {
    const std::size_t at = is_type_word(line[1]) ? 2 : 1;
    const std::string next = at + 1 < line.size() ? line[at + 1] : "";
    if (next == "::" || at >= line.size()) return {};
    if (next.empty() || next == "final" || next == ":")
      return {{line[at]}, body ? "" : joined(statement), false};
  }
  return functions_and_variables(line);
}

class Reader {
 public:
  explicit Reader(Tokens all) : all_(all) {}

  DeclaredNames read() {
    while (at_ < all_.size()) {
      const std::size_t from = at_;
      while (at_ < all_.size() && !is_one_of(all_[at_], {";", "{", "}"}))
        at_ = opens(all_[at_]) ? past_bracket(all_, at_) : at_ + 1;
      if (at_ >= all_.size()) break;
      const Tokens statement = all_.subspan(from, at_ - from);
      if (all_[at_] == "}") {
        if (!spaces_.empty()) spaces_.pop_back();
        ++at_;
      } else if (all_[at_] == "{" && contains(statement, "namespace")) {
        spaces_.push_back(joined(statement.subspan(1)));
        ++at_;
      } else {
        note(statement);
        skip_rest(statement);
      }
    }
    return names_;
  }

 private:
  void note(Tokens statement) {
    const Declaration found = declaration_of(statement, all_[at_] == "{");
    std::string space;
    for (const std::string& s : spaces_) space += s;
    const bool own = std::find(spaces_.begin(), spaces_.end(), "") != spaces_.end();
    for (const std::string& name : found.names) {
      if (own) names_.own.try_emplace(space + name, found.harmless);
      // A forward declaration of what another file shares is that.
      const bool forward = is_type_word(statement[0]) && !found.harmless.empty();
      if (!own && !found.function && !forward) names_.shared.insert(space + name);
    }
  }

  // Past a body and past the `;` behind a type or a value.
  void skip_rest(Tokens statement) {
    if (all_[at_] == "{") {
      const std::size_t past = past_bracket(all_, at_);
      add_local(past, !statement.empty() && is_type_word(statement[0]));
      at_ = past;
    }
    while (contains(statement, "=") && at_ < all_.size() && all_[at_] != ";")
      at_ = opens(all_[at_]) ? past_bracket(all_, at_) : at_ + 1;
    if (at_ < all_.size() && all_[at_] == ";") ++at_;
  }

  // Constants of the body from here: a type before them, a value behind. Of a class those of its
  // functions: members shadow nothing.
  void add_local(std::size_t past, bool of_class) {
    int depth = 1;
    for (std::size_t i = at_ + 1; i + 1 < past; ++i) {
      const std::string& before = all_[i - 1];
      depth += all_[i] == "{" ? 1 : all_[i] == "}" ? -1 : 0;
      if (depth > (of_class ? 1 : 0) && is_constant(all_[i]) &&
          is_one_of(all_[i + 1], {"=", "{", "["}) && before != "return" &&
          (is_name(before) || is_one_of(before, {">", "*", "&"})))
        names_.local.insert(all_[i]);
    }
  }

  Tokens all_;
  std::size_t at_ = 0;
  std::vector<std::string> spaces_;  // that are open; the anonymous one has no name
  DeclaredNames names_;
};

}  // namespace

DeclaredNames declared_names(const std::string& text) {
  const std::vector<std::string> tokens = cpp_tokens(text);
  return Reader(tokens).read();
}

}  // namespace roadbook::test
