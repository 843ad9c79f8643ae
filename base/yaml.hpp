#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.hpp"

namespace roadbook {

// Reading YAML mappings strictly: calibrations, options, scenarios.
//
// The reader gathers every fault with file, line and field, and continues: wrong types, numbers
// that are not finite, doubled keys, missing keys, and unknown keys (the message names the nearest
// known key). A caller asks for every key that it knows and then calls `finish` once:
//
//   YamlMap yaml = YamlMap::load("options.yaml");
//   yaml.read("spacing_m", options.spacing_m);       // keeps the default where the key is absent
//   yaml.require("radius_m", model.radius_m);        // absence is a fault
//   if (auto noise = yaml.map("noise")) noise->read("sigma_px", options.sigma_px);
//   yaml.finish();                                    // throws BadInput with all the faults

/// Allowed interval of a number, bounds included.
struct Range {
  double min = -std::numeric_limits<double>::infinity();
  double max = std::numeric_limits<double>::infinity();
};

/// One mapping of a YAML file. Copies share their state; not for concurrent use.
class YamlMap {
 public:
  /// Throws BadInput for a file that cannot be read, is no regular file, is not UTF-8 or not YAML,
  /// is not a mapping, or has text after its one document. An empty file is an empty mapping.
  /// OpenCV's `%YAML:1.0` first line and `!!opencv-matrix` tags are accepted.
  static YamlMap load(const std::filesystem::path& file);
  /// The same from text; messages give `name` as the file.
  static YamlMap parse(const std::string& text, const std::string& name);

  /// Reads `key` into `value` if the key exists and its value is valid; returns whether it did. An
  /// invalid value is a fault and leaves `value` unchanged. Digits in quotes are not a number.
  bool read(std::string_view key, double& value, const Range& range = {});
  bool read(std::string_view key, int& value, const Range& range = {});
  bool read(std::string_view key, std::int64_t& value, const Range& range = {});
  bool read(std::string_view key, std::uint64_t& value);
  bool read(std::string_view key, bool& value);
  bool read(std::string_view key, std::string& value);
  bool read(std::string_view key, std::vector<double>& value);
  bool read(std::string_view key, std::vector<std::string>& value);
  /// Lists of lists of numbers: matrices row by row, polygons.
  bool read(std::string_view key, std::vector<std::vector<double>>& value);
  /// The same; sets `value` to empty if the key has no value or `null`.
  bool read(std::string_view key, std::optional<double>& value, const Range& range = {});

  /// `read`, and a fault where the key is absent.
  template <typename Value, typename... Rest>
  bool require(std::string_view key, Value& value, const Rest&... rest) {
    if (!has(key)) return missing(key);
    return read(key, value, rest...);
  }

  /// A list of exactly `count` numbers, else a fault.
  bool read_list(std::string_view key, std::size_t count, std::vector<double>& value);

  /// The mapping under `key`; empty where absent, or (a fault) not a mapping.
  [[nodiscard]] std::optional<YamlMap> map(std::string_view key);
  /// The list of mappings under `key`.
  [[nodiscard]] std::vector<YamlMap> maps(std::string_view key);

  /// Accepts a key and ignores its value.
  void ignore(std::string_view key);
  [[nodiscard]] bool has(std::string_view key) const;
  /// Whether `key` is there and holds a mapping: for keys that accept several forms.
  [[nodiscard]] bool is_map(std::string_view key) const;
  /// All keys in file order, for mappings with free names.
  [[nodiscard]] std::vector<std::string> keys() const;

  /// Adds a fault that the caller found, at the line of `key`.
  void report(std::string_view key, const std::string& got, const std::string& want);
  /// Line of `key`'s value (1-based); of the mapping itself where the key is absent.
  [[nodiscard]] std::int64_t line(std::string_view key = {}) const;
  [[nodiscard]] const std::string& file() const;

  /// Faults so far in the whole file.
  [[nodiscard]] const std::vector<Problem>& problems() const;
  /// Adds a fault for each unknown key of the whole file and returns all faults. For callers that
  /// gather faults over several files.
  [[nodiscard]] std::vector<Problem> finish_problems();
  /// The same; throws BadInput if there are any.
  void finish();

 private:
  struct Document;
  struct State;
  explicit YamlMap(std::shared_ptr<State> state) : state_(std::move(state)) {}
  bool missing(std::string_view key);
  std::shared_ptr<State> state_;
};

/// Throws BadInput, naming the line, for a text that is not UTF-8, holds control characters or goes
/// on behind one YAML document: the parser would drop the rest.
void require_one_yaml_document(std::string_view text, const std::string& name);

}  // namespace roadbook
