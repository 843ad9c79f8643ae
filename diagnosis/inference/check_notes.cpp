#include "diagnosis/inference/check_notes.hpp"

#include <algorithm>

namespace roadbook {
namespace {

void add_channel(const std::string& stream, const std::string& channel, std::string& list) {
  list += (list.empty() ? "" : ", ") + stream + " (" + channel + ")";
}

constexpr double kNotWhite = 1e-6;

// A channel's rows less what each has in common with the one before, by their lag-one correlation.
Innovations less_first_order(const Innovations& left, std::size_t channel) {
  Innovations whitened;
  whitened.sides = 1;
  double before = 0.0, lagged = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < left.of.size(); ++i) {
    if (left.of[i].channel != channel || left.of[i].variance >= kVague) continue;
    whitened.of.push_back(left.of[i]);
    whitened.values.push_back(left.row(i)[0]);
    lagged += before * left.row(i)[0];
    squares += left.row(i)[0] * left.row(i)[0];
    before = left.row(i)[0];
  }
  const double r = lagged / std::max(squares, 1e-300);
  for (std::size_t i = whitened.values.size(); i-- > 1;)
    whitened.values[i] -= r * whitened.values[i - 1];
  return whitened;
}

bool is_first_order(const Innovations& left,
                    const std::vector<ChannelName>& channels,
                    std::size_t channel) {
  const auto again = check_innovations(less_first_order(left, channel), channels);
  return !again.empty() && again.front().whiteness_p >= kNotWhite;
}

std::size_t channel_of(const std::vector<ChannelName>& channels, const ChannelCheck& check) {
  return static_cast<std::size_t>(std::find_if(channels.begin(), channels.end(),
                                               [&](const ChannelName& name) {
                                                 return name.stream == check.stream &&
                                                        name.channel == check.channel;
                                               }) -
                                  channels.begin());
}

}  // namespace

std::vector<std::string> autocorrelations(const std::vector<ChannelName>& channels,
                                          const Innovations& left,
                                          const std::vector<ChannelCheck>& checks,
                                          const std::vector<std::string>& correlated) {
  std::vector<std::string> found;
  for (const ChannelCheck& c : checks) {
    const std::size_t channel = channel_of(channels, c);
    // The residual is smaller than the least believable noise: no cause is missing. A channel with
    // an entry in `whiteness_p` has a test that accounts for the fit.
    if (c.whiteness_p >= kNotWhite || (c.scale <= kBelieved && !left.whiteness_p.contains(channel)))
      continue;
    const bool named =
        std::find(correlated.begin(), correlated.end(), c.stream) != correlated.end();
    if (named && is_first_order(left, channels, channel)) continue;
    found.push_back("autocorrelation in " + c.stream + " (" + c.channel + ")");
  }
  return found;
}

std::vector<std::string> check_notes(const std::vector<ChannelName>& channels,
                                     const Innovations& left,
                                     const std::vector<ChannelCheck>& checks) {
  std::vector<bool> read(channels.size(), false);
  for (const Innovation& i : left.of) read[i.channel] = true;
  std::string unchecked;
  std::string quiet;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    const ChannelName& name = channels[c];
    const auto check = std::find_if(checks.begin(), checks.end(), [&](const ChannelCheck& one) {
      return one.stream == name.stream && one.channel == name.channel;
    });
    if (check == checks.end() && read[c]) add_channel(name.stream, name.channel, unchecked);
    if (check != checks.end() && name.stream == "poses" && check->scale < kBelieved)
      add_channel(name.stream, name.channel, quiet);
  }
  std::vector<std::string> notes;
  if (!unchecked.empty())
    notes.push_back("no residual checks of " + unchecked +
                    ": fewer than 40 of their readings can be predicted from the other streams, "
                    "and the fit follows the rest, so their residuals do not show the noise");
  if (!quiet.empty())
    notes.push_back("checks: " + quiet +
                    " have a scale below 1, because the standard deviation of poses is taken as at "
                    "least 5 mm and 0.5 mrad");
  return notes;
}

}  // namespace roadbook
