#include "exchange/export/nav2/mask_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "base/error.hpp"
#include "base/random.hpp"

namespace roadbook {
namespace {

TEST(MaskGrid, ACellSizeThatThePlaceIsTooLargeForIsRefusedWithOneThatFits) {
  try {
    (void)MaskGrid({0.0, 0.0}, {3000.0, 2000.0}, 0.1);
    FAIL();
  } catch (const InvalidOption& error) {
    EXPECT_NE(std::string(error.what()).find("at least 0.22"), std::string::npos) << error.what();
  }
}

// Compares random rings with a slow reference: a ring touches a cell if at least one of many points
// of the cell lies inside the ring.
TEST(MaskGrid, RingsMarkEveryCellThatTheyTouchAndNoOther) {
  Random random(3, "rings");
  for (int round = 0; round < 200; ++round) {
    std::vector<Eigen::Vector2d> ring;
    const double angle = random.uniform(0.0, 6.28);
    for (int i = 0; i < 5; ++i) {
      const double a = angle + 6.2832 * i / 5.0;
      ring.emplace_back(Eigen::Vector2d(2.0, 2.0) +
                        random.uniform(0.2, 1.8) * Eigen::Vector2d(std::cos(a), std::sin(a)));
    }
    MaskGrid grid({0.0, 0.0}, {4.0, 4.0}, 0.25);
    grid.mark(ring, 1);
    const auto inside = [&](const Eigen::Vector2d& p) {
      bool in = false;
      for (std::size_t i = 0, j = 4; i < 5; j = i++)
        if ((ring[i].y() > p.y()) != (ring[j].y() > p.y()) &&
            p.x() <
                (ring[j].x() - ring[i].x()) * (p.y() - ring[i].y()) / (ring[j].y() - ring[i].y()) +
                    ring[i].x())
          in = !in;
      return in;
    };
    for (int row = 0; row < 16; ++row)
      for (int column = 0; column < 16; ++column) {
        int touched = 0;
        for (int k = 0; k < 400; ++k)
          touched +=
              inside(grid.centre(column, row) + 0.25 * Eigen::Vector2d((k % 20 + 0.5) / 20.0 - 0.5,
                                                                       (k / 20 + 0.5) / 20.0 - 0.5))
                  ? 1
                  : 0;
        const bool marked = grid.cells()[grid.index(column, row)] != 0;
        if (touched > 0) {
          EXPECT_TRUE(marked) << round << " " << column << " " << row;
        }
        if (marked && touched == 0) {  // the ring covers only a thin part, so an edge is near
          double nearest = INFINITY;
          for (std::size_t i = 0; i < 5; ++i)
            for (int k = 0; k <= 400; ++k)
              nearest = std::min(nearest, ((ring[i] + (ring[(i + 1) % 5] - ring[i]) * k / 400.0) -
                                           grid.centre(column, row))
                                              .cwiseAbs()
                                              .maxCoeff());
          EXPECT_LT(nearest, 0.125 + 0.01) << round << " " << column << " " << row;
        }
      }
  }
}

}  // namespace
}  // namespace roadbook
