#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace roadbook::test {

/// Words, "::", comparisons and single signs of a C++ file. Comments and lines of the preprocessor
/// are nothing, a string is the one sign `"`.
[[nodiscard]] std::vector<std::string> cpp_tokens(const std::string& text);

/// What a file declares at the level of namespaces, read without a compiler: good for the way this
/// project is written, not for all of the language. Names stand behind the named namespaces about
/// them: "roadbook sim Layout".
struct DeclaredNames {
  /// In anonymous namespaces. To each alias, using-declaration and forward declaration its text:
  /// equal ones do each other no harm. To others nothing.
  std::map<std::string, std::string> own;
  /// Types and constants elsewhere. Not functions: they may differ by their parameters.
  std::set<std::string> shared;
  /// Constants within functions (`kName`, without namespaces): they shadow one of `own`.
  std::set<std::string> local;
};

[[nodiscard]] DeclaredNames declared_names(const std::string& text);

}  // namespace roadbook::test
