#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "exchange/export_formats.hpp"
#include "exchange/geo_origin.hpp"
#include "exchange/output_file.hpp"
#include "exchange/stored_paths.hpp"
#include "mapping/map_layers_gdal.hpp"
#include "roadnet/lane_layout.hpp"

// Lanelet2's OSM file. Lanelets that follow each other share the nodes of their bounds: that is how
// its routing knows. Bounds are half the swept width beside the centre: where vehicles went, not
// what is painted.

namespace roadbook {
namespace {

constexpr double kSagitta_m = 0.003;  // of a bound's chords
constexpr double kMostBent = 0.9;     // of the radius of a bend, that a bound lies inside it

struct Side {
  std::int64_t left = 0;
  std::int64_t right = 0;
};

class Osm {
 public:
  explicit Osm(const ToDegrees& to_degrees) : to_degrees_(to_degrees) {}

  std::int64_t node(const Eigen::Vector2d& p, double height_m) {
    const Eigen::Vector2d degrees = to_degrees_(p);
    const std::int64_t id = ++last_;
    nodes_ += "  <node id=\"" + std::to_string(id) + "\" version=\"1\" visible=\"true\" lat=\"" +
              fixed_text(degrees.y(), 11) + "\" lon=\"" + fixed_text(degrees.x(), 11) + "\">" +
              tag("ele", fixed_text(height_m, 4)) + tag("local_x", fixed_text(p.x(), 4)) +
              tag("local_y", fixed_text(p.y(), 4)) + "</node>\n";
    return id;
  }
  std::int64_t way(const std::vector<std::int64_t>& nodes) {
    const std::int64_t id = ++last_;
    ways_ += "  <way id=\"" + std::to_string(id) + "\" version=\"1\" visible=\"true\">";
    for (const std::int64_t n : nodes) ways_ += "<nd ref=\"" + std::to_string(n) + "\"/>";
    ways_ += tag("type", "virtual") + "</way>\n";
    return id;
  }
  void lanelet(std::uint64_t id, std::int64_t left, std::int64_t right, bool one_way, bool turn) {
    relations_ += "  <relation id=\"" + std::to_string(id) +
                  "\" version=\"1\" visible=\"true\"><member type=\"way\" ref=\"" +
                  std::to_string(left) + "\" role=\"left\"/><member type=\"way\" ref=\"" +
                  std::to_string(right) + "\" role=\"right\"/>" + tag("type", "lanelet") +
                  tag("subtype", "road") + tag("location", "private") +
                  tag("one_way", one_way ? "yes" : "no") +
                  (turn ? tag("roadbook:part", "intersection") : tag("roadbook:part", "lane")) +
                  "</relation>\n";
  }
  [[nodiscard]] std::string text() const {
    return "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<osm version=\"0.6\" "
           "generator=\"roadbook\">\n" +
           nodes_ + ways_ + relations_ + "</osm>\n";
  }

 private:
  static std::string tag(const std::string& key, const std::string& value) {
    return "<tag k=\"" + key + "\" v=\"" + value + "\"/>";
  }

  const ToDegrees& to_degrees_;
  std::int64_t last_ = 0;
  std::string nodes_, ways_, relations_;
};

// Places along a curve whose chords, half a width beside it, stay within the sagitta.
std::vector<double> places(const PathCurve& curve, double begin_m, double end_m, double half_m) {
  std::vector<double> s{begin_m};
  while (s.back() < end_m) {
    const double kappa = std::abs(curve.at(s.back()).curvature);
    // Of the two bounds the inner one is bent more.
    const double bent = kappa / std::max(1.0 - kappa * half_m, 1.0 - kMostBent);
    const double chord = std::sqrt(8.0 * kSagitta_m / std::max(bent, 1e-3));
    s.push_back(std::min(end_m, s.back() + std::clamp(chord, 0.1, 2.0)));
  }
  if (s.size() > 2 && s.back() - s[s.size() - 2] < 0.05) s.erase(s.end() - 2);
  return s;
}

Side nodes_beside(Osm& osm, const PathPoint& p, double half_m) {
  const double left = p.curvature > 0.0 ? std::min(half_m, kMostBent / p.curvature) : half_m;
  const double right = p.curvature < 0.0 ? std::min(half_m, -kMostBent / p.curvature) : half_m;
  return {osm.node(p.position + left * p.left(), p.height_m),
          osm.node(p.position - right * p.left(), p.height_m)};
}

void add_lanelet(Osm& osm,
                 std::uint64_t id,
                 const PathCurve& curve,
                 double begin_m,
                 double end_m,
                 double half_m,
                 const Side* first,
                 const Side* last,
                 bool one_way,
                 bool turn) {
  std::vector<std::int64_t> left;
  std::vector<std::int64_t> right;
  const auto s = places(curve, begin_m, end_m, half_m);
  for (std::size_t i = 0; i < s.size(); ++i) {
    const Side* given = i == 0 ? first : i + 1 == s.size() ? last : nullptr;
    const Side side = given != nullptr ? *given : nodes_beside(osm, curve.at(s[i]), half_m);
    left.push_back(side.left);
    right.push_back(side.right);
  }
  const std::int64_t l = osm.way(left);
  const std::int64_t r = osm.way(right);
  osm.lanelet(id, l, r, one_way, turn);
}

Side turned(const Side& side) { return {side.right, side.left}; }

// Ids of lanes are kept; those of turns follow from the two lanes they join.
std::uint64_t turn_id(std::uint64_t a, std::uint64_t b, std::set<std::uint64_t>& used) {
  std::uint64_t id = (a * 0x9E3779B97F4A7C15U) ^ (b * 0xBF58476D1CE4E5B9U);
  id = std::max<std::uint64_t>((id ^ (id >> 29U)) >> 11U, 1U);  // 53 bits, as the lanes' ids
  while (!used.insert(id).second) ++id;
  return id;
}

std::string osm_text(const LaneLayout& layout, const ToDegrees& to_degrees) {
  Osm osm(to_degrees);
  std::vector<std::pair<Side, Side>> ends;
  std::set<std::uint64_t> used;
  for (const LanePiece& piece : layout.pieces) {
    const double half = 0.5 * piece.width_m;
    const Side first = nodes_beside(osm, piece.curve.at(piece.s_begin_m), half);
    const bool ring = piece.curve.closed();
    const Side last = ring ? first : nodes_beside(osm, piece.curve.at(piece.s_end_m), half);
    ends.emplace_back(first, last);
    used.insert(piece.id);
    add_lanelet(osm, piece.id, piece.curve, piece.s_begin_m, piece.s_end_m, half, &first, &last,
                !piece.both_ways, false);
  }
  for (const Connector& turn : layout.connectors) {
    // Left and right as seen when driving out of the first lane and into the second.
    const auto& a = ends[static_cast<std::size_t>(turn.from.piece)];
    const auto& b = ends[static_cast<std::size_t>(turn.to.piece)];
    const Side first = turn.from.at_end ? a.second : turned(a.first);
    const Side last = turn.to.at_end ? turned(b.second) : b.first;
    const std::uint64_t id =
        turn_id(layout.pieces[static_cast<std::size_t>(turn.from.piece)].id,
                layout.pieces[static_cast<std::size_t>(turn.to.piece)].id, used);
    add_lanelet(osm, id, turn.curve, 0.0, turn.curve.length_m(), 0.5 * turn.width_m, &first, &last,
                !turn.both_ways, true);
  }
  return osm.text();
}

}  // namespace

Paths export_lanelet2(const std::filesystem::path& map,
                      const std::filesystem::path& out,
                      const ExportOptions& options) {
  const StoredPaths stored = load_paths(map);
  const GeoOrigin origin = require_origin(map, options, "Lanelet2 is in degrees");
  const GdalScope scope;
  const ToDegrees to_degrees(origin);
  write_text_file(out, osm_text(lay_out(stored.network, stored.paths), to_degrees));
  return {out};
}

}  // namespace roadbook
