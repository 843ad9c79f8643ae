#pragma once

#include <string>
#include <vector>

#include "diagnosis/inference/cause_problem.hpp"

namespace roadbook {

/// Channels whose innovations scatter less than this have the least noise level; their
/// autocorrelation needs no cause.
inline constexpr double kBelieved = 0.8;

/// Omnibus checks of one channel's innovations: are they white noise?
struct ChannelCheck {
  std::string stream;
  std::string channel;
  std::size_t rows = 0;
  double mean_z = 0.0;       ///< mean over its standard error
  double scale = 0.0;        ///< root mean square
  double whiteness_p = 1.0;  ///< Ljung-Box, 20 lags, or the channel's own test
  double kurtosis_excess = 0.0;
  double tails_p = 1.0;  ///< of the kurtosis
};

/// One check for each channel with at least 40 usable innovations. Innovations that depend on the
/// unknowns more than on the noise (variance of `kVague` or more) are left out.
[[nodiscard]] std::vector<ChannelCheck> check_innovations(const Innovations& innovations,
                                                          const std::vector<ChannelName>& channels);

/// Ljung-Box Q over `lags` autocorrelations; chi-squared with as many degrees of freedom.
[[nodiscard]] double ljung_box(const std::vector<double>& values, int lags);

}  // namespace roadbook
