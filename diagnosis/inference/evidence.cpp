#include "diagnosis/inference/evidence.hpp"

#include <algorithm>
#include <cmath>

namespace roadbook {
namespace {

constexpr std::size_t kBins = 24;

}  // namespace

std::vector<EvidenceBin> evidence_bins(std::vector<EvidenceValue> before,
                                       std::vector<EvidenceValue> after) {
  std::vector<EvidenceBin> bins;
  if (before.empty() || after.empty()) return bins;
  std::sort(before.begin(), before.end());
  std::sort(after.begin(), after.end());
  for (std::size_t b = 0; b < kBins; ++b) {
    EvidenceBin bin;
    const auto mean = [b](const auto& values, double& x) {
      const std::size_t from = b * values.size() / kBins;
      const std::size_t to = (b + 1) * values.size() / kBins;
      double sum = 0.0;
      x = 0.0;
      for (std::size_t i = from; i < to; ++i) {
        x += values[i].first / static_cast<double>(to - from);
        sum += values[i].second / static_cast<double>(to - from);
      }
      return sum;
    };
    double unused = 0.0;
    bin.before = mean(before, unused);
    bin.after = mean(after, bin.x);
    bin.rows = after.size() / kBins;
    if (bin.rows == 0) break;
    bin.sigma = 1.0 / std::sqrt(static_cast<double>(bin.rows));
    bins.push_back(bin);
  }
  return bins;
}

}  // namespace roadbook
