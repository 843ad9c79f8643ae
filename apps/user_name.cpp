#include "apps/user_name.hpp"

#include <cstdlib>

#include "base/error.hpp"
#include "semantics/labels/label_classes.hpp"

namespace roadbook {

std::string user_name(const std::string& given) {
  if (!given.empty()) {
    if (const auto wrong = wrong_name(given)) throw InvalidOption("--who", *wrong, kNameWanted);
    return given;
  }
  const char* const name = std::getenv("USER");
  return name != nullptr && !wrong_name(name) ? name : "labeller";
}

}  // namespace roadbook
