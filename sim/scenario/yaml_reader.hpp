#pragma once

#include <yaml-cpp/yaml.h>

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace roadbook {

// Strict reading of a scenario file: every fault is a BadInput with file, line and field. Unknown
// keys are faults too; the message names the nearest known key.

class YamlReader {
 public:
  /// Throws BadInput if `text` is not YAML. `file` is what error lines name.
  static YamlReader parse(const std::string& text, const std::string& file);

  /// Throws BadInput unless this is a mapping with no other keys than these.
  void only(const std::vector<std::string>& keys) const;

  [[nodiscard]] bool has(const std::string& key) const;
  /// Child that must be there.
  [[nodiscard]] YamlReader at(const std::string& key) const;
  /// Child that may be there.
  [[nodiscard]] std::optional<YamlReader> find(const std::string& key) const;
  /// Items of the list under `key`; empty if there is no such key.
  [[nodiscard]] std::vector<YamlReader> items(const std::string& key) const;
  [[nodiscard]] std::vector<YamlReader> items() const;
  [[nodiscard]] bool is_list() const { return node_.IsSequence(); }
  /// Copy of this mapping; the keys of `other` replace its keys.
  [[nodiscard]] YamlReader overridden_by(const YamlReader& other) const;
  [[nodiscard]] std::vector<std::string> keys() const;

  /// Finite number in [low, high].
  [[nodiscard]] double number(double low, double high) const;
  [[nodiscard]] int integer(int low, int high) const;
  [[nodiscard]] bool boolean() const;
  [[nodiscard]] std::string text() const;
  [[nodiscard]] Eigen::Vector2d point() const;
  /// One of `names`, as its index.
  [[nodiscard]] std::size_t choice(const std::vector<std::string>& names) const;

  /// The same of a child, with the value to take if it is not there.
  [[nodiscard]] double number(const std::string& key,
                              double fallback,
                              double low,
                              double high) const;
  [[nodiscard]] int integer(const std::string& key, int fallback, int low, int high) const;
  [[nodiscard]] std::string text(const std::string& key, const std::string& fallback) const;

  /// Throws BadInput at this place.
  [[noreturn]] void fail(const std::string& got, const std::string& want) const;

 private:
  YamlReader(YAML::Node node, std::string file, std::string field)
      : node_(std::move(node)), file_(std::move(file)), field_(std::move(field)) {}
  [[nodiscard]] std::string scalar(const std::string& want) const;

  YAML::Node node_;
  std::string file_;
  std::string field_;
};

}  // namespace roadbook
