#include "mapping/pipeline/checkpoint_blobs.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include "base/error.hpp"

namespace roadbook {
namespace {

constexpr std::size_t kKeyframesPerChunk = 256;

class Writer {
 public:
  template <typename T>
  void value(const T& x) {
    static_assert(std::is_trivially_copyable_v<T>);
    bytes_.append(reinterpret_cast<const char*>(&x), sizeof x);
  }
  template <typename T>
  void values(const std::vector<T>& list) {
    value<std::uint64_t>(list.size());
    bytes_.append(reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T));
  }
  template <typename Derived>
  void matrix(const Eigen::DenseBase<Derived>& m) {
    for (int c = 0; c < m.cols(); ++c)
      for (int r = 0; r < m.rows(); ++r) value<double>(m.derived()(r, c));
  }
  void text(const std::string& s) {
    value<std::uint64_t>(s.size());
    bytes_ += s;
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  template <typename T>
  T value() {
    T x{};
    copy(&x, sizeof x);
    return x;
  }
  template <typename T>
  std::vector<T> values() {
    std::vector<T> list(value<std::uint64_t>());
    copy(list.data(), list.size() * sizeof(T));
    return list;
  }
  template <typename Matrix>
  void matrix(Matrix& m) {
    for (int c = 0; c < m.cols(); ++c)
      for (int r = 0; r < m.rows(); ++r) m(r, c) = value<double>();
  }
  std::string text() {
    std::string s(value<std::uint64_t>(), '\0');
    copy(s.data(), s.size());
    return s;
  }

 private:
  void copy(void* to, std::size_t size) {
    ROADBOOK_ASSERT(size <= bytes_.size());
    if (size > 0) std::memcpy(to, bytes_.data(), size);
    bytes_.remove_prefix(size);
  }
  std::string_view bytes_;
};

void write_keyframe(Writer& w, const VoKeyframe& k) {
  w.value<std::uint64_t>(k.frame);
  w.value(k.t_ns);
  w.matrix(k.T_odom_vehicle.matrix());
  w.value<std::uint8_t>(k.wheels ? 1 : 0);
  if (k.wheels) {
    w.matrix(k.wheels->motion);
    w.matrix(k.wheels->covariance);
    w.value(k.wheels->distance_m);
    w.value<std::uint8_t>(k.wheels->reversing ? 1 : 0);
  }
  w.matrix(k.information);
  w.value(k.inliers);
  w.value<std::uint8_t>(k.ground_log_scale ? 1 : 0);
  w.value(k.ground_log_scale.value_or(0.0));
  w.value(k.travelled_m);
  w.value<std::uint8_t>(k.reversing ? 1 : 0);
  w.value<std::uint8_t>(k.after_gap ? 1 : 0);
  w.value<std::uint64_t>(k.features.size());
  for (std::size_t c = 0; c < k.features.size(); ++c) {
    std::vector<float> pixels;
    for (const auto& p : k.features[c].pixels) pixels.insert(pixels.end(), {p.x(), p.y()});
    w.values(pixels);
    w.values(k.features[c].descriptors);
    w.values(k.tracks[c]);
  }
}

VoKeyframe read_keyframe(Reader& r) {
  VoKeyframe k;
  k.frame = r.value<std::uint64_t>();
  k.t_ns = r.value<std::int64_t>();
  r.matrix(k.T_odom_vehicle.matrix());
  if (r.value<std::uint8_t>()) {
    k.wheels.emplace();
    r.matrix(k.wheels->motion);
    r.matrix(k.wheels->covariance);
    k.wheels->distance_m = r.value<double>();
    k.wheels->reversing = r.value<std::uint8_t>() != 0;
  }
  r.matrix(k.information);
  k.inliers = r.value<int>();
  const bool saw_ground = r.value<std::uint8_t>() != 0;
  const auto log_scale = r.value<double>();
  if (saw_ground) k.ground_log_scale = log_scale;
  k.travelled_m = r.value<double>();
  k.reversing = r.value<std::uint8_t>() != 0;
  k.after_gap = r.value<std::uint8_t>() != 0;
  const auto cameras = r.value<std::uint64_t>();
  k.features.resize(cameras);
  k.tracks.resize(cameras);
  for (std::size_t c = 0; c < cameras; ++c) {
    const auto pixels = r.values<float>();
    for (std::size_t i = 0; i + 1 < pixels.size(); i += 2)
      k.features[c].pixels.emplace_back(pixels[i], pixels[i + 1]);
    k.features[c].descriptors = r.values<Descriptor>();
    k.tracks[c] = r.values<int>();
  }
  return k;
}

}  // namespace

std::size_t keyframe_chunks(const VoResult& odometry) {
  return (odometry.keyframes.size() + kKeyframesPerChunk - 1) / kKeyframesPerChunk;
}

std::string keyframes_to_blob(const VoResult& odometry, std::size_t chunk) {
  const std::size_t begin = chunk * kKeyframesPerChunk;
  const std::size_t end = std::min(odometry.keyframes.size(), begin + kKeyframesPerChunk);
  Writer w;
  w.value<std::uint64_t>(end - begin);
  for (std::size_t k = begin; k < end; ++k) write_keyframe(w, odometry.keyframes[k]);
  return w.take();
}

std::string tracks_to_blob(const VoResult& odometry) {
  Writer w;
  w.value<std::uint64_t>(odometry.tracks.size());
  for (const auto& track : odometry.tracks) {
    w.value(track.camera);
    w.values(track.observations);
    w.value<std::uint8_t>(track.p_odom ? 1 : 0);
    if (track.p_odom) w.matrix(*track.p_odom);
  }
  w.value<std::uint8_t>(odometry.uses_wheels ? 1 : 0);
  w.value<std::uint64_t>(odometry.doubts.size());
  for (const auto& doubt : odometry.doubts) {
    w.text(doubt.sensor);
    w.value(doubt.t_begin_ns);
    w.value(doubt.t_end_ns);
    w.text(doubt.got);
    w.text(doubt.want);
  }
  return w.take();
}

void append_keyframes(std::string_view blob, VoResult& odometry) {
  Reader r(blob);
  const auto count = r.value<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) odometry.keyframes.push_back(read_keyframe(r));
}

void append_tracks(std::string_view blob, VoResult& odometry) {
  Reader r(blob);
  const auto count = r.value<std::uint64_t>();
  for (std::uint64_t i = 0; i < count; ++i) {
    Track track;
    track.camera = r.value<int>();
    track.observations = r.values<TrackObservation>();
    if (r.value<std::uint8_t>()) {
      track.p_odom.emplace();
      r.matrix(*track.p_odom);
    }
    odometry.tracks.push_back(std::move(track));
  }
  odometry.uses_wheels = r.value<std::uint8_t>() != 0;
  const auto doubts = r.value<std::uint64_t>();
  for (std::uint64_t i = 0; i < doubts; ++i) {
    SensorDoubt doubt;
    doubt.sensor = r.text();
    doubt.t_begin_ns = r.value<std::int64_t>();
    doubt.t_end_ns = r.value<std::int64_t>();
    doubt.got = r.text();
    doubt.want = r.text();
    odometry.doubts.push_back(std::move(doubt));
  }
}

std::string loops_to_blob(const std::vector<LoopClosure>& loops) {
  Writer w;
  w.value<std::uint64_t>(loops.size());
  for (const auto& loop : loops) {
    w.value(loop.edge.from);
    w.value(loop.edge.to);
    w.matrix(loop.edge.T_from_to.matrix());
    w.matrix(loop.edge.information);
    w.value(loop.edge.inliers);
    w.value<std::uint8_t>(loop.edge.accepted ? 1 : 0);
    w.value(loop.edge.weight);
    w.text(loop.edge.reason);
    w.values(loop.matches);
    w.value(loop.log_scale);
    w.value(loop.log_scale_sigma);
  }
  return w.take();
}

std::vector<LoopClosure> loops_from_blob(std::string_view blob) {
  Reader r(blob);
  std::vector<LoopClosure> loops(r.value<std::uint64_t>());
  for (auto& loop : loops) {
    loop.edge.from = r.value<int>();
    loop.edge.to = r.value<int>();
    r.matrix(loop.edge.T_from_to.matrix());
    r.matrix(loop.edge.information);
    loop.edge.inliers = r.value<int>();
    loop.edge.accepted = r.value<std::uint8_t>() != 0;
    loop.edge.weight = r.value<double>();
    loop.edge.reason = r.text();
    loop.matches = r.values<FeatureMatch>();
    loop.log_scale = r.value<double>();
    loop.log_scale_sigma = r.value<double>();
  }
  return loops;
}

}  // namespace roadbook
