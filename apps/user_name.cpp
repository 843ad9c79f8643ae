#include "apps/user_name.hpp"

#include <cstdlib>

namespace roadbook {

std::string user_name() {
  const char* const name = std::getenv("USER");
  return name != nullptr && *name != '\0' ? std::string(name).substr(0, 64) : "labeller";
}

}  // namespace roadbook
