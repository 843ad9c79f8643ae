#pragma once

#include <string>

// A small shared library that test_base loads late, and another one of the same functions that is
// not where the loader looks.

namespace far {

struct Sums {
  double reals;
  long whole;
  std::string text;  // too large for registers: the caller passes the place of the result
};

/// More arguments than there are registers, of both kinds.
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
          double q);
[[noreturn]] void refuse(const std::string& reason);

class Counter {
 public:
  explicit Counter(int start);
  ~Counter();
  int next();

 private:
  int* count_;
};

}  // namespace far

namespace gone {
int answer(double value);
}
