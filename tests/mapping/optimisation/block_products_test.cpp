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

// Also where the columns are no multiple of what a machine computes at once.
TEST(BlockProducts, ProductsWithRowsAreTheSumsInOrderToTheLastBit) {
  for (const std::size_t columns : {1U, 7U, 16U})
    for (const bool transposed : {false, true}) {
      const std::vector<double> A = any_values(36, 6);
      const std::vector<double> B = any_values(6 * columns, 7);
      std::vector<double> C = any_values(6 * columns, 8);
      std::vector<double> expected = C;
      for (std::size_t row = 0; row < 6; ++row)
        for (std::size_t c = 0; c < columns; ++c) {
          double sum = 0.0;
          for (std::size_t k = 0; k < 6; ++k)
            sum += (transposed ? A[k + 6 * row] : A[row + 6 * k]) * B[columns * k + c];
          expected[columns * row + c] -= sum;
        }
      (transposed ? subtract_transposed_product : subtract_product)(A.data(), B.data(), columns,
                                                                    C.data());
      EXPECT_EQ(C, expected) << columns << (transposed ? ", transposed" : "");
    }
}

// Two columns with rows 2, 5, 6. Rows 2 and 5 are columns of the target, whose rows are 2, 5, 6, 7.
TEST(BlockProducts, APanelIsTakenOffTheBlocksItsRowsSay) {
  const std::vector<double> L = any_values(2 * 3 * 36, 4);
  const std::array<const double*, 2> source{L.data(), L.data() + 3 * 36};
  const std::array<std::size_t, 3> place{0, 1, 2};
  std::vector<double> blocks = any_values(2 * 4 * 36, 5);
  std::vector<double> expected = blocks;
  const std::array<double*, 2> target{blocks.data(), blocks.data() + 4 * 36};
  for (std::size_t j = 0; j < 2; ++j)
    for (std::size_t i = j; i < 3; ++i)
      for (std::size_t c = 0; c < 6; ++c)
        for (std::size_t r = 0; r < 6; ++r) {
          double sum = 0.0;
          for (std::size_t k = 0; k < 2; ++k)
            for (std::size_t t = 0; t < 6; ++t)
              sum += source[k][36 * i + r + 6 * t] * source[k][36 * j + c + 6 * t];
          expected[4 * 36 * j + 36 * i + r + 6 * c] -= sum;
        }
  subtract_panel({source.data(), 2, 0, 2, 3, place.data(), target.data()});
  EXPECT_EQ(blocks, expected);
}

}  // namespace
}  // namespace roadbook
