#include "diagnosis/numerics/givens.hpp"

#include <cmath>

#include "base/error.hpp"
#include "base/target_clones.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kBlock = kTailBlock;

// Spelt out, since the compiler unrolls short loops before it would vectorise them.
using Lanes = double __attribute__((vector_size(32), aligned(8), may_alias));
constexpr std::size_t kLanes = 4;
static_assert(kBlock == 2 * kLanes);

}  // namespace

void triangularise(double* left,
                   std::size_t rows,
                   std::size_t width,
                   std::size_t columns,
                   std::vector<Rotation>& done) {
  done.clear();
  for (std::size_t column = 0; column < columns; ++column) {
    double* a = left + column * width;
    for (std::size_t row = column + 1; row < rows; ++row) {
      double* b = left + row * width;
      const double y = b[column];
      if (y == 0.0) continue;
      const double length = std::sqrt(a[column] * a[column] + y * y);
      const Rotation r{column, row, a[column] / length, y / length};
      for (std::size_t i = column; i < width; ++i) {
        const double u = a[i];
        const double v = b[i];
        a[i] = r.c * u + r.s * v;
        b[i] = r.c * v - r.s * u;
      }
      b[column] = 0.0;
      done.push_back(r);
    }
  }
}

// Most of diagnosis' time is spent in the next two. No fused multiply-add: the same bits on every
// processor.
ROADBOOK_CLONES void rotate_tails(double* const* tails,
                                  std::size_t rows,
                                  std::size_t length,
                                  const std::vector<Rotation>& rotations) {
  ROADBOOK_ASSERT(rows <= kMostTails && length % kBlock == 0);
  Lanes block[kMostTails][2];
  for (std::size_t at = 0; at < length; at += kBlock) {
    for (std::size_t i = 0; i < rows; ++i) {
      const auto* from = reinterpret_cast<const Lanes*>(tails[i] + at);
      block[i][0] = from[0];
      block[i][1] = from[1];
    }
    for (const Rotation& r : rotations) {
      Lanes* a = block[r.a];
      Lanes* b = block[r.b];
      const Lanes u0 = a[0], u1 = a[1], v0 = b[0], v1 = b[1];
      a[0] = r.c * u0 + r.s * v0;
      a[1] = r.c * u1 + r.s * v1;
      b[0] = r.c * v0 - r.s * u0;
      b[1] = r.c * v1 - r.s * u1;
    }
    for (std::size_t i = 0; i < rows; ++i) {
      auto* to = reinterpret_cast<Lanes*>(tails[i] + at);
      to[0] = block[i][0];
      to[1] = block[i][1];
    }
  }
}

ROADBOOK_CLONES void multiply_tails(double* const* tails,
                                    std::size_t rows,
                                    std::size_t length,
                                    const double* Q) {
  ROADBOOK_ASSERT(rows <= kMostTails && length % kBlock == 0);
  Lanes block[kMostTails][2];
  for (std::size_t at = 0; at < length; at += kBlock) {
    for (std::size_t i = 0; i < rows; ++i) {
      const auto* from = reinterpret_cast<const Lanes*>(tails[i] + at);
      block[i][0] = from[0];
      block[i][1] = from[1];
    }
    for (std::size_t i = 0; i < rows; ++i) {
      const double* q = Q + i * rows;
      Lanes sum0 = q[0] * block[0][0];
      Lanes sum1 = q[0] * block[0][1];
      for (std::size_t k = 1; k < rows; ++k) {
        sum0 += q[k] * block[k][0];
        sum1 += q[k] * block[k][1];
      }
      auto* to = reinterpret_cast<Lanes*>(tails[i] + at);
      to[0] = sum0;
      to[1] = sum1;
    }
  }
}

void product_of(const std::vector<Rotation>& rotations,
                std::size_t rows,
                std::size_t kept,
                std::vector<double>& Q) {
  const std::size_t gone = rows - kept;
  std::vector<double> all(rows * kept, 0.0);
  for (std::size_t i = 0; i < kept; ++i) all[(gone + i) * kept + i] = 1.0;
  for (const Rotation& r : rotations)
    for (std::size_t k = 0; k < kept; ++k) {
      double& a = all[r.a * kept + k];
      double& b = all[r.b * kept + k];
      const double u = a;
      a = r.c * u + r.s * b;
      b = r.c * b - r.s * u;
    }
  Q.assign(all.begin() + static_cast<std::ptrdiff_t>(gone * kept), all.end());
}

ROADBOOK_CLONES void rotate_tail(double* __restrict tail,
                                 double* __restrict others,
                                 std::size_t stride,
                                 std::size_t count,
                                 std::size_t length,
                                 const double* c,
                                 const double* s) {
  ROADBOOK_ASSERT(length % kBlock == 0);
  for (std::size_t at = 0; at < length; at += kBlock) {
    auto* row = reinterpret_cast<Lanes*>(tail + at);
    Lanes v0 = row[0], v1 = row[1];
    for (std::size_t i = 0; i < count; ++i) {
      auto* a = reinterpret_cast<Lanes*>(others + i * stride + at);
      const Lanes u0 = a[0], u1 = a[1];
      a[0] = c[i] * u0 + s[i] * v0;
      a[1] = c[i] * u1 + s[i] * v1;
      v0 = c[i] * v0 - s[i] * u0;
      v1 = c[i] * v1 - s[i] * u1;
    }
    row[0] = v0;
    row[1] = v1;
  }
}

}  // namespace roadbook
