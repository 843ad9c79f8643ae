#include "diagnosis/streams/normal_equations.hpp"

namespace roadbook {

// Processes many rows of one channel at a time, as a matrix product.
Normal normal_equations(const Innovations& in, std::size_t count) {
  constexpr Eigen::Index kRows = 64;
  const auto n = static_cast<Eigen::Index>(count);
  Normal normal{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n), 0.0, {}};
  std::array<Eigen::MatrixXd, kChannels> waiting;
  std::array<Eigen::Index, kChannels> filled{};
  const auto add = [&](std::size_t c) {
    if (filled[c] > 0 && n > 0)
      normal.by_channel[c].selfadjointView<Eigen::Lower>().rankUpdate(
          waiting[c].leftCols(filled[c]));
    filled[c] = 0;
  };
  for (std::size_t c = 0; c < kChannels; ++c) {
    normal.by_channel[c] = Eigen::MatrixXd::Zero(n, n);
    waiting[c].resize(n, kRows);
  }
  for (std::size_t i = 0; i < in.of.size(); ++i) {
    const double e = in.row(i)[0];
    const Eigen::Map<const Eigen::VectorXd> s(in.row(i) + 1, n);
    const std::size_t c = in.of[i].channel;
    normal.u += e * s;
    normal.squares += e * e;
    waiting[c].col(filled[c]++) = s;
    if (filled[c] == kRows) add(c);
  }
  for (std::size_t c = 0; c < kChannels; ++c) {
    add(c);
    normal.by_channel[c] = Eigen::MatrixXd(normal.by_channel[c].selfadjointView<Eigen::Lower>());
    normal.F += normal.by_channel[c];
  }
  return normal;
}

}  // namespace roadbook
