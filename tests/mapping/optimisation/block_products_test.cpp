#include "mapping/optimisation/block_products.hpp"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "base/random.hpp"

namespace roadbook {
namespace {

std::vector<double> any_values(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<double> values(count);
  for (double& v : values) v = random.normal();
  return values;
}

// Computes by the definition, with inner sums in ascending order. The result must be bit-identical,
// not only close.
void subtract_plainly(const double* A, const double* B, std::size_t inner, double* C) {
  for (std::size_t c = 0; c < 6; ++c)
    for (std::size_t r = 0; r < 6; ++r) {
      double sum = A[r] * B[c];
      for (std::size_t k = 1; k < inner; ++k) sum += A[r + 6 * k] * B[c + 6 * k];
      C[r + 6 * c] -= sum;
    }
}

TEST(BlockProducts, OuterProductsAreTheSumsInOrderToTheLastBit) {
  const std::vector<double> A = any_values(18, 1);
  const std::vector<double> B = any_values(18, 2);
  std::vector<double> C = any_values(36, 3);
  std::vector<double> expected = C;
  subtract_plainly(A.data(), B.data(), 3, expected.data());
  subtract_outer_63(A.data(), B.data(), C.data());
  EXPECT_EQ(C, expected);
}

TEST(BlockProducts, AColumnIsTakenOffTheBlocksItsRowsSay) {
  const std::vector<double> L = any_values(3 * 36, 4);  // rows 2, 5, 6 of column k
  const std::array<int, 3> rows{2, 5, 6};
  const std::array<std::size_t, 7> place{9, 9, 1, 9, 9, 3, 0};
  std::vector<double> blocks = any_values(4 * 36, 5);
  std::vector<double> expected = blocks;
  for (std::size_t i = 0; i < rows.size(); ++i)
    subtract_plainly(L.data() + 36 * i, L.data(), 6,
                     expected.data() + 36 * place[static_cast<std::size_t>(rows[i])]);
  subtract_column({L.data(), rows.data(), rows.size(), place.data(), blocks.data()});
  EXPECT_EQ(blocks, expected);
}

}  // namespace
}  // namespace roadbook
