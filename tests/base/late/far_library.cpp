#include "tests/base/late/far_library.hpp"

#include <stdexcept>

namespace far {

Sums sums(int a,
          double b,
          long c,
          float d,
          int e,
          double f,
          int g,
          int h,
          double i,
          const char* j,
          int k,
          double l,
          double m,
          double n,
          double o,
          double p,
          double q) {
  return {b + static_cast<double>(d) + f + i + l + m + n + o + p + q, a + c + e + g + h + k, j};
}

void refuse(const std::string& reason) { throw std::domain_error(reason); }

Counter::Counter(int start) : count_(new int(start)) {}
Counter::~Counter() { delete count_; }
int Counter::next() { return ++*count_; }

}  // namespace far
