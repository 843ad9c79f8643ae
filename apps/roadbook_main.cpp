#include <string>
#include <vector>

#include "apps/verb.hpp"

int main(int count, char** words) {
  return static_cast<int>(
      roadbook::run_roadbook(std::vector<std::string>(words + (count > 0 ? 1 : 0), words + count)));
}
