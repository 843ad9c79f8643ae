#include "diagnosis/streams/observations.hpp"

namespace roadbook {

std::string_view stream_of(Channel channel) {
  switch (channel) {
    case Channel::kWheelDistance:
    case Channel::kWheelHeading:
      return "wheels0";
    case Channel::kSteering:
      return "steering0";
    case Channel::kGyro:
      return "imu0";
    default:
      return "poses";
  }
}

std::string_view name_of(Channel channel) {
  constexpr std::array<std::string_view, kChannels> kNames{
      "distance", "heading", "angle", "yaw_rate", "along", "across", "heading"};
  return kNames[index_of(channel)];
}

std::size_t Observations::rows(Channel channel) const {
  switch (channel) {
    case Channel::kWheelDistance:
      return wheels.empty() ? 0 : wheels.size() - 1;
    case Channel::kWheelHeading:
      return wheels.empty() || wheels_read != WheelsRead::kBoth ? 0 : wheels.size() - 1;
    case Channel::kSteering:
      return steering.size();
    case Channel::kGyro:
      return gyro.size();
    case Channel::kPoseHeading:
      return poses_have_heading ? poses.size() : 0;
    default:
      return poses.size();
  }
}

std::array<std::size_t, kChannels + 1> Observations::offsets() const {
  std::array<std::size_t, kChannels + 1> first{};
  for (std::size_t c = 0; c < kChannels; ++c)
    first[c + 1] = first[c] + rows(static_cast<Channel>(c));
  return first;
}

}  // namespace roadbook
