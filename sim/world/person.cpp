#include "sim/world/person.hpp"

#include <cmath>
#include <numbers>
#include <vector>

namespace roadbook {
namespace {

constexpr int kSides = 10;
constexpr double kPersonTexel = 0.01;

/// Width of a limb at a share of its length.
struct Ring {
  double at;
  double width;
};

struct Limb {
  Eigen::Isometry3d T;   ///< foot of the limb, z along it
  Eigen::Vector3d size;  ///< widest depth and breadth, length
  std::vector<Ring> rings;
  int texture;
};

/// A closed stack of rings; one surface, lit from above, ahead and the left.
void add_limb(const Limb& limb, Mesh& mesh) {
  const auto point = [&](const Ring& ring, int side) {
    const double a = 2.0 * std::numbers::pi * side / kSides;
    return Eigen::Vector3d(limb.T * Eigen::Vector3d(0.5 * ring.width * limb.size.x() * std::cos(a),
                                                    0.5 * ring.width * limb.size.y() * std::sin(a),
                                                    ring.at * limb.size.z()));
  };
  const double around = std::numbers::pi * 0.5 * (limb.size.x() + limb.size.y()) / kPersonTexel;
  const auto texel = [&](const Ring& ring, int side) {
    return Eigen::Vector2d(around * side / kSides, ring.at * limb.size.z() / kPersonTexel);
  };
  const Eigen::Vector3d to_light = Eigen::Vector3d(0.4, 0.3, 0.85).normalized();
  bool same = false;
  const auto add = [&](const Ring& a, int i, const Ring& b, int j, const Ring& c, int k) {
    const std::array<Eigen::Vector3d, 3> p{point(a, i), point(b, j), point(c, k)};
    const Eigen::Vector3d n = (p[1] - p[0]).cross(p[2] - p[0]);
    if (n.norm() < 1e-9) return;
    const double light = 0.78 + 0.3 * n.normalized().dot(to_light);
    mesh.add_triangle(p, {texel(a, i), texel(b, j), texel(c, k)}, limb.texture, kPersonTexel,
                      SurfaceClass::kPedestrian, light, same);
    same = true;
  };
  std::vector<Ring> rings = limb.rings;
  rings.insert(rings.begin(), {rings.front().at, 0.0});
  rings.push_back({rings.back().at, 0.0});
  for (std::size_t r = 1; r < rings.size(); ++r)
    for (int side = 0; side < kSides; ++side) {
      add(rings[r - 1], side, rings[r - 1], side + 1, rings[r], side + 1);
      add(rings[r - 1], side, rings[r], side + 1, rings[r], side);
    }
}

}  // namespace

Mesh make_person(double height_m, double phase, int cloth_texture, int skin_texture) {
  static const std::vector<Ring> kLeg{
      {0.0, 0.6}, {0.06, 0.65}, {0.45, 0.75}, {0.95, 1.1}, {1.0, 0.9}};
  static const std::vector<Ring> kArm{{0.0, 0.6}, {0.1, 0.75}, {0.9, 1.05}, {1.0, 0.7}};
  static const std::vector<Ring> kTrunk{{0.0, 0.85}, {0.3, 0.82}, {0.75, 1.02},
                                        {0.9, 0.95}, {0.97, 0.6}, {1.0, 0.3}};
  static const std::vector<Ring> kHead{{0.0, 0.45}, {0.15, 0.75}, {0.45, 0.97}, {0.65, 1.0},
                                       {0.85, 0.8}, {0.96, 0.45}, {1.0, 0.1}};
  static const std::vector<Ring> kBlock{{0.0, 1.0}, {0.7, 1.0}, {1.0, 0.6}};
  Mesh mesh;
  const double k = height_m / 1.75;
  // Hangs from (x, y, top) and swings about it.
  const auto limb = [&](const Eigen::Vector2d& at, double top, double swing,
                        const Eigen::Vector3d& size, const std::vector<Ring>& rings, int texture) {
    Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
    T.linear() = Eigen::AngleAxisd(swing, Eigen::Vector3d::UnitY()).toRotationMatrix();
    T.translation() =
        Eigen::Vector3d(at.x() * k, at.y() * k, top * k) - T.linear().col(2) * size.z() * k;
    add_limb({T, size * k, rings, texture}, mesh);
  };
  const double swing = 0.42 * std::sin(phase);
  const int shirt = cloth_texture;
  const int trousers = cloth_texture + 1;
  for (const double side : {1.0, -1.0}) {
    limb({0.0, 0.09 * side}, 0.9, side * swing, {0.17, 0.16, 0.86}, kLeg, trousers);
    const double foot_x = 0.05 - 0.86 * std::sin(side * swing);
    const double foot_top = 0.98 - 0.88 * std::cos(swing);
    limb({foot_x, 0.09 * side}, foot_top, 0.0, {0.27, 0.1, 0.1}, kBlock, trousers);
    limb({0.0, 0.24 * side}, 1.42, -0.8 * side * swing, {0.1, 0.1, 0.56}, kArm, shirt);
    limb({0.48 * std::sin(0.8 * side * swing), 0.24 * side}, 1.42 - 0.54 * std::cos(0.8 * swing),
         0.0, {0.1, 0.06, 0.12}, kBlock, skin_texture);
  }
  limb({0.0, 0.0}, 1.47, 0.0, {0.25, 0.43, 0.66}, kTrunk, shirt);
  limb({0.0, 0.0}, 1.56, 0.0, {0.11, 0.11, 0.12}, {{0.0, 1.0}, {1.0, 1.0}}, skin_texture);
  limb({0.01, 0.0}, 1.75, 0.0, {0.21, 0.17, 0.25}, kHead, skin_texture);
  return mesh;
}

}  // namespace roadbook
