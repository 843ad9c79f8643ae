#include "exchange/import/json_fields.hpp"

#include <cmath>

#include "base/text.hpp"

namespace roadbook {

void JsonFields::fault(const std::string& field, const std::string& got, const std::string& want) {
  problems_.push_back({Severity::kError, file_, 0, field, got, want});
}

void JsonFields::add(const std::vector<Problem>& problems) {
  problems_.insert(problems_.end(), problems.begin(), problems.end());
}

JsonFields::Json JsonFields::required(
    const Json& object, const std::string& where, const char* name, Is is, const char* want) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  const bool missing = !object.is_object() || found == object.end();
  if (!missing && is(*found)) return *found;
  fault(where + "." + name, missing ? "nothing" : shown(*found), want);
  return nullptr;
}

JsonFields::Json JsonFields::optional(
    const Json& object, const std::string& where, const char* name, Is is, const char* want) {
  const auto found = object.is_object() ? object.find(name) : object.end();
  if (!object.is_object() || found == object.end() || found->is_null()) return nullptr;
  return required(object, where, name, is, want);
}

JsonFields::Json JsonFields::list(const Json& object, const char* name) {
  const auto found = object.find(name);
  if (found != object.end() && found->is_array()) return *found;
  fault(name, found == object.end() ? "nothing" : found->type_name(), "a list");
  return Json::array();
}

std::string shown(const nlohmann::json& value) {
  return value.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace).substr(0, 60);
}

bool is_whole(const nlohmann::json& value) {
  constexpr double kExact = 9007199254740992.0;  // 2^53: up to here doubles hold whole numbers
  if (value.is_number_unsigned())
    return value.get<std::uint64_t>() <= static_cast<std::uint64_t>(INT64_MAX);
  if (value.is_number_integer()) return true;
  if (!value.is_number_float()) return false;
  const double number = value.get<double>();
  return std::abs(number) <= kExact && number == std::floor(number);
}

bool is_number(const nlohmann::json& value) { return value.is_number(); }

bool is_share(const nlohmann::json& value) {
  return value.is_number() && value.get<double>() >= 0.0 && value.get<double>() <= 1.0;
}

bool is_text(const nlohmann::json& value) { return value.is_string(); }

bool is_numbers(const nlohmann::json& value) {
  if (!value.is_array()) return false;
  for (const nlohmann::json& number : value)
    if (!number.is_number()) return false;
  return true;
}

bool is_flag_set(const nlohmann::json& value) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number()) return value.get<double>() != 0.0;
  if (!value.is_string()) return false;
  const auto text = value.get<std::string>();
  if (text == "true" || text == "True" || text == "yes") return true;
  const auto number = parse_double(text);
  return number && *number != 0.0;
}

}  // namespace roadbook
