#include <cstddef>
#include <limits>

#include "base/error.hpp"
#include "mapping/store/map_file_codec.hpp"
#include "mapping/store/map_file_names.hpp"
#include "mapping/store/map_file_tables.hpp"

namespace roadbook {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

/// Reads the rows of one table in the order of their ids; checks each value.
class Rows {
 public:
  Rows(const SqlDatabase& database, std::string table)
      : file_(database.file().string()),
        table_(std::move(table)),
        statement_(database.prepare("SELECT * FROM " + table_ + " ORDER BY rowid")) {}

  bool next() {
    ++row_;
    return statement_.step();
  }
  [[nodiscard]] std::int64_t row() const { return row_; }

  [[nodiscard]] std::int64_t int64(int column) const { return statement_.integer(column); }
  [[nodiscard]] int integer(int column) const {
    const std::int64_t value = statement_.integer(column);
    if (value < std::numeric_limits<int>::min() || value > std::numeric_limits<int>::max())
      fail(column, std::to_string(value), "a 32-bit integer");
    return static_cast<int>(value);
  }
  /// An index into something of `size` elements.
  [[nodiscard]] int index(int column, std::size_t size) const {
    const int value = integer(column);
    if (value < 0 || static_cast<std::size_t>(value) >= size)
      fail(column, std::to_string(value), "an index below " + std::to_string(size));
    return value;
  }
  /// The row's own id: rows count from 0 without gaps.
  void require_id() const {
    if (int64(0) != row_) fail(0, std::to_string(int64(0)), std::to_string(row_));
  }
  [[nodiscard]] double real(int column) const { return statement_.real(column); }
  [[nodiscard]] std::optional<double> real_or_null(int column) const {
    if (is_null(column)) return std::nullopt;
    return real(column);
  }
  [[nodiscard]] bool is_null(int column) const { return statement_.type(column) == SQLITE_NULL; }
  [[nodiscard]] int columns() const { return statement_.columns(); }
  [[nodiscard]] bool boolean(int column) const { return integer(column) != 0; }
  [[nodiscard]] std::string text(int column) const { return statement_.text(column); }
  [[nodiscard]] std::string_view blob(int column) const { return statement_.bytes(column); }

  template <typename Matrix>
  void matrix(int column, Matrix& m) const {
    if (!unpack_matrix(blob(column), m)) fail_size(column);
  }
  template <typename Matrix>
  void covariance(int column, Matrix& m) const {
    m = unknown_covariance<Matrix>();
    if (!is_null(column)) matrix(column, m);
  }
  [[nodiscard]] Eigen::Isometry3d pose(int column) const {
    Eigen::Matrix<double, 3, 4> m;
    matrix(column, m);
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = m.leftCols<3>();
    T.translation() = m.col(3);
    return T;
  }
  [[noreturn]] void fail_size(int column) const {
    fail(column, std::to_string(blob(column).size()) + " bytes", "another size");
  }
  [[noreturn]] void fail(int column, const std::string& got, const std::string& want) const {
    const std::string field =
        table_ + " row " + std::to_string(row_) + " " + statement_.column_name(column);
    throw BadInput(Problem{Severity::kError, file_, 0, field, got, want});
  }

 private:
  std::string file_;
  std::string table_;
  SqlStatement statement_;
  std::int64_t row_ = -1;
};

void read_sensors(const SqlDatabase& database, Map& map) {
  for (Rows rows(database, "cameras"); rows.next();) {
    auto& cameras =
        map.sessions[static_cast<std::size_t>(rows.index(1, map.sessions.size()))].rig.cameras;
    if (rows.int64(2) != static_cast<std::int64_t>(cameras.size()))
      rows.fail(2, rows.text(2), std::to_string(cameras.size()));
    MountedCamera mounted;
    mounted.name = rows.text(3);
    const auto model = camera_model_from(rows.text(4));
    if (!model) rows.fail(4, rows.text(4), "a known camera model");
    mounted.camera.model = *model;
    mounted.camera.width = rows.integer(5);
    mounted.camera.height = rows.integer(6);
    mounted.camera.max_angle_rad = rows.real(7);
    mounted.time_offset_s = rows.real(8);
    Eigen::Matrix<double, Camera::kMaxParameters, 1> parameters;
    rows.matrix(9, parameters);
    for (Eigen::Index i = 0; i < parameters.size(); ++i)
      mounted.camera.parameters[static_cast<std::size_t>(i)] = parameters[i];
    mounted.T_vehicle_camera = rows.pose(10);
    if (rows.columns() > 12) {  // of earlier programs: at the stamp, as they took it
      mounted.exposed_after_s = rows.real_or_null(11).value_or(0.0);
      mounted.rolling_shutter_s = rows.real_or_null(12).value_or(0.0);
    }
    cameras.push_back(std::move(mounted));
  }
  for (Rows rows(database, "wheel_models"); rows.next();) {
    std::array<double, kWheelValues> values{};
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = rows.real(static_cast<int>(i) + 1);
    map.sessions[static_cast<std::size_t>(rows.index(0, map.sessions.size()))].wheels =
        wheel_model_from(values);
  }
}

// Maps of earlier programs know nothing of the vehicle.
void read_vehicles(const SqlDatabase& database, Map& map) {
  if (database.value("SELECT count(*) FROM sqlite_master WHERE type = 'table' AND "
                     "name = 'vehicles'") == "0")
    return;
  for (Rows rows(database, "vehicles"); rows.next();) {
    Session& session = map.sessions[static_cast<std::size_t>(rows.index(0, map.sessions.size()))];
    const auto source = vehicle_source_from(rows.text(1));
    if (!source) rows.fail(1, rows.text(1), "none, measured, file or option");
    session.vehicle_source = *source;
    VehicleValues values;
    for (std::size_t i = 0; i < values.size(); ++i) {
      values[i] = rows.real_or_null(static_cast<int>(i) + 2);
      if (values[i] && !(*values[i] >= 0.0 && *values[i] <= 100.0))
        rows.fail(static_cast<int>(i) + 2, std::to_string(*values[i]), "0 to 100");
    }
    session.vehicle = vehicle_from(values);
  }
}

// Earlier programs wrote zero for unknown; their tables do not allow NULL.
bool zero_means_unknown(const SqlDatabase& database, const std::string& table) {
  return database.value("SELECT \"notnull\" FROM pragma_table_info('" + table +
                        "') WHERE name = 'covariance'") == "1";
}

// The first keyframe is exact if it holds the gauge of others that are known.
void forget_zeros(Map& map) {
  for (Session& s : map.sessions)
    for (double* sigma : {&s.wheel_scale_sigma, &s.scale_sigma})
      if (*sigma == 0.0) *sigma = kUnknown;
  bool any = false;
  for (Keyframe& k : map.keyframes) {
    if (!k.covariance.isZero(0.0))
      any = true;
    else if (&k != &map.keyframes.front())
      k.covariance = unknown_covariance<Matrix6d>();
  }
  if (!any && !map.keyframes.empty())
    map.keyframes.front().covariance = unknown_covariance<Matrix6d>();
  for (Landmark& l : map.landmarks)
    if (l.covariance.isZero(0.0)) l.covariance = unknown_covariance<Eigen::Matrix3d>();
}

void read_poses(const SqlDatabase& database, Map& map) {
  for (Rows rows(database, "map_frames"); rows.next();) {
    rows.require_id();
    map.map_frames.push_back({rows.pose(1)});
  }
  for (Rows rows(database, "keyframes"); rows.next();) {
    rows.require_id();
    Keyframe k;
    k.session = rows.index(1, map.sessions.size());
    k.t_ns = rows.int64(2);
    k.drive_frame = rows.integer(3);
    k.map_frame = rows.index(4, map.map_frames.size());
    k.T_frame_vehicle = rows.pose(5);
    rows.covariance(6, k.covariance);
    k.travelled_m = rows.real(7);
    k.reversing = rows.boolean(8);
    k.after_gap = rows.boolean(9);
    if (rows.columns() > 10) k.piece = rows.integer(10);  // maps of earlier programs have one piece
    if (k.piece < 0) rows.fail(10, std::to_string(k.piece), "a piece from 0");
    map.keyframes.push_back(k);
  }
}

// Tables of schema version 2 are missing in earlier files.
bool has_table_named(const SqlDatabase& database, const std::string& table) {
  return database.value("SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = '" +
                        table + "'") == "1";
}

void read_motions(const SqlDatabase& database, Map& map) {
  if (!has_table_named(database, "keyframe_motions")) return;
  for (Rows rows(database, "keyframe_motions"); rows.next();) {
    PlanarMotion wheels;
    rows.matrix(1, wheels.motion);
    rows.matrix(2, wheels.covariance);
    wheels.distance_m = rows.real(3);
    wheels.reversing = rows.boolean(4);
    map.keyframes[static_cast<std::size_t>(rows.index(0, map.keyframes.size()))].wheels = wheels;
  }
}

void read_corners(const SqlDatabase& database, Map& map) {
  if (!has_table_named(database, "keyframe_corners")) return;
  constexpr std::size_t kBytes = 2 * sizeof(float) + std::tuple_size_v<Descriptor>;
  for (Rows rows(database, "keyframe_corners"); rows.next();) {
    LoneCorner corner;
    corner.keyframe = rows.index(1, map.keyframes.size());
    const Keyframe& keyframe = map.keyframes[static_cast<std::size_t>(corner.keyframe)];
    const Session& session = map.sessions[static_cast<std::size_t>(keyframe.session)];
    corner.camera = rows.index(2, session.rig.cameras.size());
    const std::string_view data = rows.blob(4);
    if (data.size() % kBytes != 0 ||
        static_cast<std::int64_t>(data.size() / kBytes) != rows.int64(3))
      rows.fail_size(4);
    for (std::size_t at = 0; at < data.size(); at += kBytes) {
      corner.pixel = {unpack<float>(data, at), unpack<float>(data, at + sizeof(float))};
      std::memcpy(corner.descriptor.data(), data.data() + at + 2 * sizeof(float),
                  corner.descriptor.size());
      map.corners.push_back(corner);
    }
  }
}

void read_landmark_sessions(const SqlDatabase& database, Map& map) {
  if (!has_table_named(database, "landmark_sessions")) return;
  for (Rows rows(database, "landmark_sessions"); rows.next();) {
    LandmarkSession s;
    s.landmark = rows.index(1, map.landmarks.size());
    s.session = rows.index(2, map.sessions.size());
    s.expected = rows.integer(3);
    s.seen = rows.integer(4);
    if (!rows.is_null(5)) s.last_ns = rows.int64(5);
    map.landmark_sessions.push_back(s);
  }
}

void read_landmarks(const SqlDatabase& database, Map& map) {
  for (Rows rows(database, "landmarks"); rows.next();) {
    rows.require_id();
    Landmark l;
    l.map_frame = rows.index(1, map.map_frames.size());
    l.p_frame = {rows.real(2), rows.real(3), rows.real(4)};
    rows.covariance(5, l.covariance);
    l.ground = rows.boolean(6);
    map.landmarks.push_back(l);
  }
  std::size_t count = 0;
  for (Rows rows(database, "descriptors"); rows.next(); ++count) {
    Landmark& landmark =
        map.landmarks[static_cast<std::size_t>(rows.index(0, map.landmarks.size()))];
    const std::string_view data = rows.blob(1);
    if (data.size() != landmark.descriptor.size()) rows.fail_size(1);
    std::memcpy(landmark.descriptor.data(), data.data(), data.size());
  }
  if (count != map.landmarks.size())
    throw BadInput(Problem{Severity::kError, database.file().string(), 0, "descriptors",
                           std::to_string(count) + " rows", std::to_string(map.landmarks.size())});
}

void read_observations(const SqlDatabase& database, Map& map) {
  for (Rows rows(database, "observations"); rows.next();) {
    Observation o;
    o.keyframe = rows.index(1, map.keyframes.size());
    const Keyframe& keyframe = map.keyframes[static_cast<std::size_t>(o.keyframe)];
    const Session& session = map.sessions[static_cast<std::size_t>(keyframe.session)];
    o.camera = rows.index(2, session.rig.cameras.size());
    const std::string_view data = rows.blob(4);
    if (data.size() % kObservationBytes != 0 ||
        static_cast<std::int64_t>(data.size() / kObservationBytes) != rows.int64(3))
      rows.fail_size(4);
    for (std::size_t at = 0; at < data.size(); at += kObservationBytes) {
      o.landmark = unpack<std::int32_t>(data, at);
      if (o.landmark < 0 || static_cast<std::size_t>(o.landmark) >= map.landmarks.size())
        rows.fail(4, "landmark " + std::to_string(o.landmark), "a landmark of the map");
      o.pixel = {unpack<float>(data, at + 4), unpack<float>(data, at + 8)};
      o.sigma_px = unpack<float>(data, at + 12);
      map.observations.push_back(o);
    }
  }
}

void read_loops(const SqlDatabase& database, Map& map) {
  for (Rows rows(database, "loops"); rows.next();) {
    LoopEdge loop;
    loop.from = rows.index(1, map.keyframes.size());
    loop.to = rows.index(2, map.keyframes.size());
    loop.T_from_to = rows.pose(3);
    rows.matrix(4, loop.information);
    loop.inliers = rows.integer(5);
    loop.accepted = rows.boolean(6);
    loop.weight = rows.real(7);
    loop.reason = rows.text(8);
    map.loops.push_back(std::move(loop));
  }
}

}  // namespace

std::vector<Session> read_session_table(const SqlDatabase& database) {
  std::vector<Session> sessions;
  for (Rows rows(database, "sessions"); rows.next();) {
    rows.require_id();
    Session s;
    s.name = rows.text(1);
    s.drive_digest = rows.text(2);
    s.wheel_scale = rows.real(3);
    s.wheel_scale_sigma = rows.real_or_null(4).value_or(kUnknown);
    const auto source = scale_source_from(rows.text(5));
    if (!source) rows.fail(5, rows.text(5), "wheels, camera_height or free");
    s.scale_source = *source;
    s.scale_sigma = rows.real_or_null(6).value_or(kUnknown);
    s.t_begin_ns = rows.int64(7);
    s.t_end_ns = rows.int64(8);
    if (rows.columns() > 9) s.localised_share = rows.real_or_null(9).value_or(kUnknown);
    sessions.push_back(std::move(s));
  }
  for (Rows rows(database, "session_places"); rows.next();)
    sessions[static_cast<std::size_t>(rows.index(0, sessions.size()))].drive_path = rows.text(1);
  return sessions;
}

Map read_map_tables(const SqlDatabase& database, bool with_corners) {
  Map map;
  map.sessions = read_session_table(database);
  read_sensors(database, map);
  read_vehicles(database, map);
  read_poses(database, map);
  read_landmarks(database, map);
  if (zero_means_unknown(database, "keyframes")) forget_zeros(map);
  read_observations(database, map);
  read_motions(database, map);
  if (with_corners) read_corners(database, map);
  read_landmark_sessions(database, map);
  read_loops(database, map);
  return map;
}

}  // namespace roadbook
