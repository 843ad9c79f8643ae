#include "apps/user_name.hpp"

#include <cstdlib>

#include "base/error.hpp"
#include "semantics/label_classes.hpp"

namespace roadbook {

std::string user_name(const std::string& given) {
  if (!given.empty()) {
    if (const auto wrong = wrong_kind(given)) throw InvalidOption("--who", *wrong, kKindWanted);
    return given;
  }
  const char* const name = std::getenv("USER");
  return name != nullptr && !wrong_kind(name) ? name : "labeller";
}

}  // namespace roadbook
