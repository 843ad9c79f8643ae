#include "mapping/optimisation/block_products.hpp"

#include <algorithm>

#include "base/target_clones.hpp"

namespace roadbook {
namespace {

// Spelt out, since the compiler unrolls short loops before it would vectorise them.
using Four = double __attribute__((vector_size(32), aligned(8), may_alias));
using Two = double __attribute__((vector_size(16), aligned(8), may_alias));
constexpr std::size_t kSide = 6;

// The columns of a block of six rows, each in two vectors.
template <std::size_t kColumns>
struct Columns {
  Four upper[kColumns];
  Two lower[kColumns];

  [[gnu::always_inline]] inline explicit Columns(const double* A) {
#pragma GCC unroll 6
    for (std::size_t k = 0; k < kColumns; ++k) {
      upper[k] = *reinterpret_cast<const Four*>(A + kSide * k);
      lower[k] = *reinterpret_cast<const Two*>(A + kSide * k + 4);
    }
  }
};

// C -= A B^T of 6 x 3 blocks.
[[gnu::always_inline]] inline void subtract_outer(const double* A, const double* B, double* C) {
  constexpr std::size_t kInner = 3;
  const Columns<kInner> a(A);
  for (std::size_t c = 0; c < kSide; ++c) {
    Four u = a.upper[0] * B[c];
    Two l = a.lower[0] * B[c];
#pragma GCC unroll 6
    for (std::size_t k = 1; k < kInner; ++k) {
      u += a.upper[k] * B[c + kSide * k];
      l += a.lower[k] * B[c + kSide * k];
    }
    *reinterpret_cast<Four*>(C + kSide * c) -= u;
    *reinterpret_cast<Two*>(C + kSide * c + 4) -= l;
  }
}

// C += A B for a 6x6 block A and rows B and C of `width` such blocks.
[[gnu::always_inline]] inline void add_product(const double* A,
                                               const double* B,
                                               std::size_t width,
                                               double* C) {
  const Columns<kSide> a(A);
  for (std::size_t c = 0; c < kSide * width; ++c) {
    const double* b = B + kSide * c;
    Four u = a.upper[0] * b[0];
    Two l = a.lower[0] * b[0];
#pragma GCC unroll 6
    for (std::size_t k = 1; k < kSide; ++k) {
      u += a.upper[k] * b[k];
      l += a.lower[k] * b[k];
    }
    *reinterpret_cast<Four*>(C + kSide * c) += u;
    *reinterpret_cast<Two*>(C + kSide * c + 4) += l;
  }
}

// C -= A B of a 6x6 block A, or of its transpose, and six rows.
template <bool kTransposed>
[[gnu::always_inline]] inline void subtract_rows(const double* A,
                                                 const double* B,
                                                 std::size_t columns,
                                                 double* C) {
  const auto a = [A](std::size_t row, std::size_t k) {
    return kTransposed ? A[k + kSide * row] : A[row + kSide * k];
  };
  std::size_t c = 0;
  for (; c + 4 <= columns; c += 4) {
    Four b[kSide];
#pragma GCC unroll 6
    for (std::size_t k = 0; k < kSide; ++k)
      b[k] = *reinterpret_cast<const Four*>(B + columns * k + c);
    for (std::size_t row = 0; row < kSide; ++row) {
      Four sum = a(row, 0) * b[0];
#pragma GCC unroll 6
      for (std::size_t k = 1; k < kSide; ++k) sum += a(row, k) * b[k];
      *reinterpret_cast<Four*>(C + columns * row + c) -= sum;
    }
  }
  for (; c < columns; ++c)
    for (std::size_t row = 0; row < kSide; ++row) {
      double sum = a(row, 0) * B[c];
      for (std::size_t k = 1; k < kSide; ++k) sum += a(row, k) * B[columns * k + c];
      C[columns * row + c] -= sum;
    }
}

// C -= the sum over the columns k of a panel of its block in row i times that in row j, transposed.
[[gnu::always_inline]] inline void subtract_from_one(const PanelUpdate& update,
                                                     std::size_t i,
                                                     std::size_t j,
                                                     double* C) {
  Four upper[kSide] = {};
  Two lower[kSide] = {};
  for (std::size_t k = 0; k < update.width; ++k) {
    const double* A = update.source[k] + kSide * kSide * (update.first + i);
    const double* B = update.source[k] + kSide * kSide * (update.first + j);
    for (std::size_t t = 0; t < kSide; ++t, A += kSide, B += kSide) {
      const Four u = *reinterpret_cast<const Four*>(A);
      const Two l = *reinterpret_cast<const Two*>(A + 4);
#pragma GCC unroll 6
      for (std::size_t c = 0; c < kSide; ++c) {
        upper[c] += u * B[c];
        lower[c] += l * B[c];
      }
    }
  }
#pragma GCC unroll 6
  for (std::size_t c = 0; c < kSide; ++c) {
    *reinterpret_cast<Four*>(C + kSide * c) -= upper[c];
    *reinterpret_cast<Two*>(C + kSide * c + 4) -= lower[c];
  }
}

// The same for rows i and i + 1, whose last two values share a vector: half of the columns at once.
[[gnu::always_inline]] inline void subtract_from_two(
    const PanelUpdate& update, std::size_t i, std::size_t j, double* C, double* D) {
  constexpr std::size_t kHalf = 3;
  for (std::size_t half = 0; half < kSide; half += kHalf) {
    Four first[kHalf] = {}, second[kHalf] = {}, ends[kHalf] = {};
    for (std::size_t k = 0; k < update.width; ++k) {
      const double* A = update.source[k] + kSide * kSide * (update.first + i);
      const double* B = update.source[k] + kSide * kSide * (update.first + j) + half;
      for (std::size_t t = 0; t < kSide; ++t, A += kSide, B += kSide) {
        const double* next = A + kSide * kSide;
        const Four u = *reinterpret_cast<const Four*>(A);
        const Four v = *reinterpret_cast<const Four*>(next);
        const Four w = {A[4], A[5], next[4], next[5]};
#pragma GCC unroll 3
        for (std::size_t c = 0; c < kHalf; ++c) {
          first[c] += u * B[c];
          second[c] += v * B[c];
          ends[c] += w * B[c];
        }
      }
    }
#pragma GCC unroll 3
    for (std::size_t c = 0; c < kHalf; ++c) {
      double* one = C + kSide * (half + c);
      double* two = D + kSide * (half + c);
      *reinterpret_cast<Four*>(one) -= first[c];
      *reinterpret_cast<Four*>(two) -= second[c];
      one[4] -= ends[c][0];
      one[5] -= ends[c][1];
      two[4] -= ends[c][2];
      two[5] -= ends[c][3];
    }
  }
}

}  // namespace

ROADBOOK_CLONES void subtract_panel(const PanelUpdate& update) {
  constexpr std::size_t kBlock = kSide * kSide;
  for (std::size_t i = 0; i < update.count;) {
    const bool pair = i + 1 < update.count && i + 1 >= update.targets;
    const std::size_t targets = std::min(update.targets, i + 1);
    for (std::size_t j = 0; j < targets; ++j) {
      double* C = update.target[update.place[j]];
      double* first = C + kBlock * update.place[i];
      if (pair)
        subtract_from_two(update, i, j, first, C + kBlock * update.place[i + 1]);
      else
        subtract_from_one(update, i, j, first);
    }
    i += pair ? 2 : 1;
  }
}

ROADBOOK_CLONES void add_symmetric(const SymmetricProduct& product) {
  add_product(product.Z, product.l_k, product.width, product.sum_i);
  if (product.l_i == nullptr) return;
  double transposed[kSide * kSide];
  for (std::size_t c = 0; c < kSide; ++c)
    for (std::size_t r = 0; r < kSide; ++r) transposed[c + kSide * r] = product.Z[r + kSide * c];
  add_product(transposed, product.l_i, product.width, product.sum_k);
}

ROADBOOK_CLONES void subtract_outer_63(const double* A, const double* B, double* C) {
  subtract_outer(A, B, C);
}

ROADBOOK_CLONES void subtract_product(const double* A,
                                      const double* B,
                                      std::size_t columns,
                                      double* C) {
  subtract_rows<false>(A, B, columns, C);
}

ROADBOOK_CLONES void subtract_transposed_product(const double* A,
                                                 const double* B,
                                                 std::size_t columns,
                                                 double* C) {
  subtract_rows<true>(A, B, columns, C);
}

}  // namespace roadbook
