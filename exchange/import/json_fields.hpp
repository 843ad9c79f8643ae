#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/error.hpp"

namespace roadbook {

// JSON files of other programs, read strictly.

/// Reads a JSON file in UTF-8 (with or without a byte order mark). Throws BadInput with the line
/// and the path of the value ("annotations[3].score") for faults: NaN and infinity as Python writes
/// them, a number beyond 1.8e308, a superfluous comma, an early end, UTF-16, a key that occurs
/// twice in one object (readers differ in the one they take), more than 64 levels.
/// `content`: what the file should hold, for messages.
[[nodiscard]] nlohmann::json read_json_file(const std::filesystem::path& file,
                                            const std::string& content = "labels");

/// Reads the fields of a file's objects and gathers their faults.
class JsonFields {
 public:
  using Json = nlohmann::json;
  using Is = bool (*)(const Json&);

  explicit JsonFields(std::string file) : file_(std::move(file)) {}

  [[nodiscard]] const std::string& file() const { return file_; }
  [[nodiscard]] const std::vector<Problem>& problems() const { return problems_; }
  void fault(const std::string& field, const std::string& got, const std::string& want);
  void add(const std::vector<Problem>& problems);

  /// The field `name` of the object at `where`; null and a fault where it is missing or not what
  /// `is` accepts.
  Json required(
      const Json& object, const std::string& where, const char* name, Is is, const char* want);
  /// The same of a field that may be missing or null.
  Json optional(
      const Json& object, const std::string& where, const char* name, Is is, const char* want);
  /// A list under `name` of the file's own object; empty and a fault where the list is missing.
  Json list(const Json& object, const char* name);

 private:
  std::string file_;
  std::vector<Problem> problems_;
};

/// The first 60 characters of a value, for messages.
[[nodiscard]] std::string shown(const nlohmann::json& value);

/// A whole number that 64 bits hold; 4.0 is one, as tables write their columns.
[[nodiscard]] bool is_whole(const nlohmann::json& value);
[[nodiscard]] bool is_number(const nlohmann::json& value);
[[nodiscard]] bool is_share(const nlohmann::json& value);  ///< a number from 0 to 1
[[nodiscard]] bool is_text(const nlohmann::json& value);
[[nodiscard]] bool is_numbers(const nlohmann::json& value);  ///< a list of numbers
/// True, a number other than 0, or such a number in text: how programs write a flag.
[[nodiscard]] bool is_flag_set(const nlohmann::json& value);

}  // namespace roadbook
