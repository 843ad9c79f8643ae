#include "diagnosis/streams/drive_session.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>

#include "base/error.hpp"

namespace roadbook {
namespace {

// First and last stamp [ns]; the first is larger than the last if nothing is recorded.
struct RecordedTime {
  std::int64_t first = std::numeric_limits<std::int64_t>::max();
  std::int64_t last = std::numeric_limits<std::int64_t>::min();

  void add(std::int64_t t_ns) {
    first = std::min(first, t_ns);
    last = std::max(last, t_ns);
  }
  [[nodiscard]] bool spans(const Session& s) const {
    return first <= s.t_begin_ns && last >= s.t_end_ns;
  }
};

// The times of a session are those of the images.
RecordedTime recorded_time(const Drive& drive) {
  RecordedTime time;
  if (const std::size_t frames = drive.frame_count(); frames > 0) {
    time.add(drive.frame_stamp_ns(0));
    time.add(drive.frame_stamp_ns(frames - 1));
    return time;
  }
  drive.for_each_imu_reading([&](const ImuReading& r) { time.add(r.t_ns); });
  if (drive.wheel_model())
    drive.for_each_wheel_reading([&](const WheelReading& r) { time.add(r.t_ns); });
  return time;
}

}  // namespace

std::optional<int> find_session(const Map& map, const Drive& drive) {
  const std::string digest = drive.digest();
  int named = -1;
  for (std::size_t s = 0; s < map.sessions.size(); ++s) {
    if (map.sessions[s].drive_digest == digest) return static_cast<int>(s);
    if (map.sessions[s].name == drive.name()) named = named == -1 ? static_cast<int>(s) : -2;
  }
  if (named < 0 || !recorded_time(drive).spans(map.sessions[static_cast<std::size_t>(named)]))
    return std::nullopt;
  return named;
}

int session_of(const Map& map, const Drive& drive, const std::filesystem::path& file) {
  if (const auto session = find_session(map, drive)) return *session;
  std::string names;
  for (const Session& s : map.sessions) names += (names.empty() ? "" : ", ") + s.name;
  Problem problem;
  problem.file = file.string();
  problem.field = "sessions";
  problem.got = names;
  problem.want = "a session of the drive " + drive.name();
  throw BadInput(problem);
}

}  // namespace roadbook
