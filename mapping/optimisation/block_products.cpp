#include "mapping/optimisation/block_products.hpp"

#include "base/target_clones.hpp"

namespace roadbook {
namespace {

// Spelt out, since the compiler unrolls short loops before it would vectorise them.
using Four = double __attribute__((vector_size(32), aligned(8), may_alias));
using Two = double __attribute__((vector_size(16), aligned(8), may_alias));
constexpr std::size_t kSide = 6;

// C -= A B^T of 6 x kInner blocks.
template <std::size_t kInner>
[[gnu::always_inline]] inline void subtract_outer(const double* A, const double* B, double* C) {
  Four upper[kInner];
  Two lower[kInner];
  for (std::size_t k = 0; k < kInner; ++k) {
    upper[k] = *reinterpret_cast<const Four*>(A + kSide * k);
    lower[k] = *reinterpret_cast<const Two*>(A + kSide * k + 4);
  }
  for (std::size_t c = 0; c < kSide; ++c) {
    Four u = upper[0] * B[c];
    Two l = lower[0] * B[c];
    for (std::size_t k = 1; k < kInner; ++k) {
      u += upper[k] * B[c + kSide * k];
      l += lower[k] * B[c + kSide * k];
    }
    *reinterpret_cast<Four*>(C + kSide * c) -= u;
    *reinterpret_cast<Two*>(C + kSide * c + 4) -= l;
  }
}

}  // namespace

ROADBOOK_CLONES void subtract_column(const ColumnUpdate& update) {
  constexpr std::size_t kBlock = kSide * kSide;
  for (std::size_t p = 0; p < update.count; ++p)
    subtract_outer<kSide>(
        update.L_jk + kBlock * p, update.L_jk,
        update.blocks + kBlock * update.place[static_cast<std::size_t>(update.rows[p])]);
}

ROADBOOK_CLONES void subtract_outer_63(const double* A, const double* B, double* C) {
  subtract_outer<3>(A, B, C);
}

}  // namespace roadbook
