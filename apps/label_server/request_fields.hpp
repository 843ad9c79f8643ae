#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>

namespace roadbook {

// The JSON body of a request: its fields, and the answer if one of them is wrong.

/// A request that the server cannot fulfil. The answer is {"error": what(), ...details} with this
/// status.
class RequestError : public std::runtime_error {
 public:
  RequestError(int status, const std::string& message)
      : std::runtime_error(message), status_(status) {}
  [[nodiscard]] int status() const { return status_; }

 private:
  int status_;
};

/// Throws RequestError 422: "field: got ..., want ...".
[[noreturn]] void refuse_field(const std::string& field,
                               const std::string& got,
                               const std::string& want);

/// A JSON object of at most 8 levels. Throws RequestError 400.
[[nodiscard]] nlohmann::json parse_body(const std::string& body);

// The functions below read fields of an object. They throw RequestError 422 with the name of the
// field if it is missing or has another type.

/// A value of any type.
[[nodiscard]] const nlohmann::json& required_field(const nlohmann::json& body, const char* name);
[[nodiscard]] double number_field(const nlohmann::json& body, const char* name);
[[nodiscard]] std::int64_t integer_field(const nlohmann::json& body, const char* name);
[[nodiscard]] bool flag_field(const nlohmann::json& body, const char* name);
/// Reads a pair of numbers from `corners`.
[[nodiscard]] Eigen::Vector2d point_field(const nlohmann::json& value);
/// Reads at most `longest` characters of printable text.
[[nodiscard]] std::string text_field(const nlohmann::json& body,
                                     const char* name,
                                     std::size_t longest = 64);

}  // namespace roadbook
