#include "diagnosis/inference/checks.hpp"

#include <algorithm>
#include <cmath>

#include "diagnosis/inference/score_table.hpp"

namespace roadbook {
namespace {

constexpr int kLags = 20;

ChannelCheck check(const ChannelName& name, const std::vector<double>& e) {
  ChannelCheck c;
  c.stream = name.stream;
  c.channel = name.channel;
  c.rows = e.size();
  const auto n = static_cast<double>(e.size());
  double sum = 0.0;
  for (const double v : e) sum += v;
  double m2 = 0.0;
  double m4 = 0.0;
  for (const double v : e) {
    const double d = v - sum / n;
    m2 += d * d / n;
    m4 += d * d * d * d / n;
  }
  if (m2 <= 0.0) return c;
  c.mean_z = sum / std::sqrt(n * m2);
  c.scale = std::sqrt(m2 + sum * sum / (n * n));
  c.kurtosis_excess = m4 / (m2 * m2) - 3.0;
  c.tails_p = std::erfc(std::abs(c.kurtosis_excess) / std::sqrt(24.0 / n) / std::sqrt(2.0));
  c.whiteness_p = chi_squared_tail(ljung_box(e, kLags), kLags);
  return c;
}

}  // namespace

double ljung_box(const std::vector<double>& values, int lags) {
  const auto n = static_cast<double>(values.size());
  double sum = 0.0;
  for (const double v : values) sum += v;
  const double mean = sum / n;
  double variance = 0.0;
  for (const double v : values) variance += (v - mean) * (v - mean);
  if (variance <= 0.0) return 0.0;
  double q = 0.0;
  for (int lag = 1; lag <= lags && static_cast<std::size_t>(lag) < values.size(); ++lag) {
    double r = 0.0;
    for (std::size_t i = static_cast<std::size_t>(lag); i < values.size(); ++i)
      r += (values[i] - mean) * (values[i - static_cast<std::size_t>(lag)] - mean);
    r /= variance;
    q += r * r / (n - lag);
  }
  return n * (n + 2.0) * q;
}

std::vector<ChannelCheck> check_innovations(const Innovations& innovations,
                                            const std::vector<ChannelName>& channels) {
  std::vector<std::vector<double>> values(channels.size());
  for (std::size_t i = 0; i < innovations.of.size(); ++i)
    if (innovations.of[i].variance < kVague)
      values[innovations.of[i].channel].push_back(innovations.row(i)[0]);
  std::vector<ChannelCheck> checks;
  for (std::size_t c = 0; c < channels.size(); ++c)
    if (values[c].size() >= 2 * static_cast<std::size_t>(kLags)) {
      checks.push_back(check(channels[c], values[c]));
      if (const auto own = innovations.whiteness_p.find(c); own != innovations.whiteness_p.end())
        checks.back().whiteness_p = own->second;
    }
  return checks;
}

}  // namespace roadbook
