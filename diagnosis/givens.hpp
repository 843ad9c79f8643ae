#pragma once

#include <cstddef>

namespace roadbook {

/// Rotates the rows a and b, from `from` to `to`, so that b[from] becomes 0. Returns the cosine
/// (1: nothing to do; 0: the rows changed places).
double rotate_rows(double* a, double* b, std::size_t from, std::size_t to);

}  // namespace roadbook
