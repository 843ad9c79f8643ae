#include "diagnosis/check_notes.hpp"

#include <algorithm>

namespace roadbook {
namespace {

void add_channel(const std::string& stream, const std::string& channel, std::string& list) {
  list += (list.empty() ? "" : ", ") + stream + " (" + channel + ")";
}

}  // namespace

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
    notes.push_back("no checks of " + unchecked +
                    ": what is left of readings that the fit follows shows its freedom, not their "
                    "noise, and fewer than 40 of them are foretold by the others");
  if (!quiet.empty())
    notes.push_back("checks: " + quiet +
                    " scatter by less than 1: poses count as 5 mm and 0.5 mrad uncertain at least");
  return notes;
}

}  // namespace roadbook
