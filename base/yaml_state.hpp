/// \file
/// The data behind a YamlMap: the document, its mappings and their nodes. For yaml*.cpp alone, so
/// that nothing else sees yaml-cpp.

#pragma once

#include <yaml-cpp/yaml.h>

#include <cstdint>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/yaml.hpp"

namespace roadbook {

struct YamlMap::Document {
  std::string file;
  std::vector<Problem> problems;
  std::vector<std::shared_ptr<State>> maps;  ///< every mapping returned; `finish` checks their keys
};

struct YamlMap::State {
  Document* document = nullptr;  ///< kept alive by every YamlMap handed out
  std::string path;              ///< "wheels." before the field's name; "" at the top
  std::int64_t line = 0;
  std::vector<std::pair<std::string, YAML::Node>> entries;
  std::set<std::string, std::less<>> asked;

  void fault(std::string_view key, std::int64_t at, std::string got, std::string want) const {
    document->problems.push_back({Severity::kError, document->file, at, path + std::string(key),
                                  std::move(got), std::move(want)});
  }
  [[nodiscard]] const YAML::Node* find(std::string_view key) const {
    for (const auto& [name, node] : entries)
      if (name == key) return &node;
    return nullptr;
  }
  /// Takes the entries of a mapping node; doubled keys and keys that are no plain words are faults.
  void fill(const YAML::Node& node);
  const YAML::Node* ask(std::string_view key) {
    asked.emplace(key);
    return find(key);
  }
};

inline std::int64_t line_of(const YAML::Node& node) { return node.Mark().line + 1; }

/// Text of a node for an error line.
std::string shown(const YAML::Node& node);

}  // namespace roadbook
