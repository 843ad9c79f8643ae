#include "apps/label_server/request_fields.hpp"

#include <cmath>

#include "base/utf8.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

constexpr int kDeepest = 8;

}  // namespace

const Json& required_field(const Json& body, const char* name) {
  const auto found = body.find(name);
  if (found == body.end()) refuse_field(name, "nothing", "a value");
  return *found;
}

void refuse_field(const std::string& field, const std::string& got, const std::string& want) {
  throw RequestError(422, field + ": got " + got + ", want " + want);
}

Json parse_body(const std::string& body) {
  const auto shallow = [](int depth, Json::parse_event_t, Json&) {
    if (depth > kDeepest) throw RequestError(400, "body: got deep nesting, want at most 8 levels");
    return true;
  };
  if (!utf8_characters(body))
    throw RequestError(400, "body: got bytes that are not UTF-8, want UTF-8 text");
  try {
    Json json = Json::parse(body, shallow);
    if (!json.is_object()) throw RequestError(400, "body: got another JSON value, want an object");
    return json;
  } catch (const Json::exception& fault) {
    throw RequestError(400,
                       std::string("body: got invalid JSON, want a JSON object: ") + fault.what());
  }
}

double number_field(const Json& body, const char* name) {
  const Json& value = required_field(body, name);
  if (!value.is_number() || !(std::abs(value.get<double>()) < 1e7))
    refuse_field(name, value.dump(), "a number");
  return value.get<double>();
}

std::int64_t integer_field(const Json& body, const char* name) {
  const Json& value = required_field(body, name);
  if (!value.is_number_integer()) refuse_field(name, value.dump(), "a whole number");
  return value.get<std::int64_t>();
}

Eigen::Vector2d point_field(const Json& value) {
  if (!value.is_array() || value.size() != 2 || !value[0].is_number() || !value[1].is_number())
    refuse_field("corners", value.dump(), "pairs of numbers");
  return {value[0].get<double>(), value[1].get<double>()};
}

bool flag_field(const Json& body, const char* name) {
  const Json& value = required_field(body, name);
  if (!value.is_boolean()) refuse_field(name, value.dump(), "true or false");
  return value.get<bool>();
}

std::string text_field(const Json& body, const char* name, std::size_t longest) {
  const Json& value = required_field(body, name);
  if (!value.is_string()) refuse_field(name, value.dump(), "text");
  const auto text = value.get<std::string>();
  if (utf8_characters(text).value_or(0) > longest)
    refuse_field(name, "a longer text", "at most " + std::to_string(longest) + " characters");
  for (const char c : text)
    if (static_cast<unsigned char>(c) < 32)
      refuse_field(name, "a control character", "printable text");
  return text;
}

}  // namespace roadbook
