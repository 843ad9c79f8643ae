#pragma once

#include <cstddef>
#include <vector>

namespace roadbook {

// Givens rotations of rows that consist of a short left part, in which entries are made 0, and a
// long tail of right-hand sides. The left part decides; the tails follow in one go afterwards, a
// few columns of all rows at a time, so that they stay in registers and the nearest cache.

/// Of the rows a and b: a becomes c a + s b, b becomes c b - s a.
struct Rotation {
  std::size_t a = 0, b = 0;
  double c = 1.0, s = 0.0;
};

/// Makes the entries below the diagonal of the first `columns` columns 0; `left` holds `rows` rows
/// of `width`. The rotations done stand in `done`.
void triangularise(double* left,
                   std::size_t rows,
                   std::size_t width,
                   std::size_t columns,
                   std::vector<Rotation>& done);

/// Tails are a multiple of this long.
inline constexpr std::size_t kTailBlock = 8;
inline constexpr std::size_t kMostTails = 12;

/// Applies rotations to tails of `length`; at most `kMostTails` of them.
void rotate_tails(double* const* tails,
                  std::size_t rows,
                  std::size_t length,
                  const std::vector<Rotation>& rotations);

/// The same for rows that depend only on the last columns (the first are 0) and whose first columns
/// are not needed later. The tails of the last `rows` rows are multiplied by Q. `Q` is row-major.
void multiply_tails(double* const* tails, std::size_t rows, std::size_t length, const double* Q);

/// Q of the last `kept` rows after `rotations` by the last `kept` rows before them.
void product_of(const std::vector<Rotation>& rotations,
                std::size_t rows,
                std::size_t kept,
                std::vector<double>& Q);

/// One row against `count` others `stride` apart, which stay; c, s of each.
void rotate_tail(double* tail,
                 double* others,
                 std::size_t stride,
                 std::size_t count,
                 std::size_t length,
                 const double* c,
                 const double* s);

}  // namespace roadbook
