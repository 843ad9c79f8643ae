#include "diagnosis/numerics/block_scatter.hpp"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <boost/math/distributions/fisher_f.hpp>

namespace roadbook {
namespace {

struct Blocks {
  double squares = 0.0;  // of the errors
  double number = 0.0;   // of blocks that show something, as if each showed as much
};

Blocks blocks_of(const std::vector<BlockPart>& ascending, double length_s) {
  Blocks blocks;
  double left = 0.0, shown = 0.0, all = 0.0, until = -1e300;
  const auto close = [&] {
    blocks.squares += left * left;
    blocks.number += shown * shown;
    all += shown;
    left = shown = 0.0;
  };
  for (const BlockPart& p : ascending) {
    if (p.t_s > until) {
      close();
      until = p.t_s + length_s;
    }
    left += p.left;
    shown += p.shown;
  }
  close();
  blocks.number = blocks.number > 0.0 ? all * all / blocks.number : 0.0;
  return blocks;
}

template <typename Distribution>
double tail_of(const Distribution& distribution, double value) {
  return boost::math::cdf(boost::math::complement(distribution, value));
}

void sort_in_time(std::vector<BlockPart>& parts) {
  std::stable_sort(parts.begin(), parts.end(),
                   [](const BlockPart& a, const BlockPart& b) { return a.t_s < b.t_s; });
}

}  // namespace

double squares_of_blocks(std::vector<BlockPart> parts, double length_s) {
  sort_in_time(parts);
  return blocks_of(parts, length_s).squares;
}

double p_by_block_scatter(double sum, std::vector<BlockPart> parts, int freedom) {
  constexpr double kFewest = 6.0;
  if (parts.empty()) return 1.0;
  sort_in_time(parts);
  const double duration = parts.back().t_s - parts.front().t_s;
  double worst = 0.0;
  for (double length = 1.0; length == 1.0 || duration > kFewest * length; length *= 2.0) {
    const Blocks blocks = blocks_of(parts, length);
    if (!(blocks.squares > 0.0)) return 1.0;
    const double statistic = sum * sum / blocks.squares;
    if (blocks.number >= kFewest) {
      const double others = blocks.number - 1.0;
      worst = std::max(worst, tail_of(boost::math::fisher_f_distribution<double>(freedom, others),
                                      statistic * others / (blocks.number * freedom)));
    } else if (length == 1.0) {
      worst = tail_of(boost::math::chi_squared_distribution<double>(freedom), statistic);
    }
  }
  return worst;
}

}  // namespace roadbook
