#include "apps/label_server/change_request.hpp"

#include <nlohmann/json.hpp>
#include <utility>
#include <vector>

#include "apps/label_server/label_wire.hpp"

namespace roadbook {
namespace {

using Json = nlohmann::json;

constexpr std::int64_t kMostUndone = 1000;
constexpr std::size_t kMostPassed = 1000;

// Reads the labels of the steps that the user knows to be blocked and that undo shall skip.
std::vector<std::pair<std::int64_t, std::int64_t>> passed_of(const Json& body) {
  std::vector<std::pair<std::int64_t, std::int64_t>> passed;
  if (!body.contains("passed")) return passed;
  const Json& list = body.at("passed");
  if (!list.is_array() || list.size() > kMostPassed)
    throw RequestError(422, "passed: got another type or length, want a list of at most " +
                                std::to_string(kMostPassed) + " objects {id, version}");
  for (const Json& one : list) {
    if (!one.is_object())
      throw RequestError(422, "passed: got another type in the list, want objects {id, version}");
    passed.emplace_back(integer_field(one, "id"), integer_field(one, "version"));
  }
  return passed;
}

}  // namespace

std::string who_of(const Json& body) {
  const std::string who = text_field(body, "who");
  if (who.empty()) throw RequestError(422, "who: got nothing, want a user name");
  return who;
}

std::string request_name(const Json& body) {
  return body.contains("request") ? text_field(body, "request") : std::string();
}

StepBack step_of(const Json& body) {
  const std::int64_t count = body.contains("count") ? integer_field(body, "count") : 0;
  if (count < 0 || count > kMostUndone)
    throw RequestError(422, "count: got " + std::to_string(count) + ", want 0 to 1000");
  return {static_cast<std::size_t>(count),
          body.contains("last") ? text_field(body, "last") : std::string(), passed_of(body)};
}

bool is_of_another_history(const Json& body, std::int64_t version, std::int64_t t_ns) {
  return body.contains("when") && integer_field(body, "version") == version &&
         text_field(body, "when") != utc_text(t_ns);
}

}  // namespace roadbook
