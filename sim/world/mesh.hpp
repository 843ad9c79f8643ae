#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

namespace roadbook {

/// Class of a surface: the values of class-index images.
enum class SurfaceClass : std::uint8_t {
  kVoid = 0,  ///< outside the lens
  kRoad = 1,
  kMarking = 2,
  kCrossing = 3,
  kGravel = 4,
  kWater = 5,
  kWall = 6,
  kPillar = 7,
  kCar = 8,
  kPedestrian = 9,
  kCeiling = 10,
  kBuilding = 11,
  kSky = 12,
  kOwnCar = 13,
  kGrass = 14,
};

/// Texture index of the painted ground, which is coloured by x and y of the place.
constexpr int kGroundTexture = -1;

/// A textured triangle. `uv` are texels of `texture`.
struct Triangle {
  std::array<Eigen::Vector3f, 3> corner;
  std::array<Eigen::Vector2f, 3> uv;
  int texture = 0;
  float texel_m = 0.01F;
  float light = 1.0F;   ///< factor on the texture, as displayed
  float lift_m = 0.0F;  ///< of the ground: height of its storey, whose ceiling it mirrors
  SurfaceClass kind = SurfaceClass::kWall;
  Eigen::Vector3f normal = Eigen::Vector3f::UnitZ();  ///< unit; set when a scene takes the triangle
  std::uint32_t surface = 0;  ///< the same for all triangles of one even face
};

struct Mesh {
  std::vector<Triangle> triangles;
  std::uint32_t surfaces = 0;

  /// Parallelogram with corner `origin`; texel (0, 0) + `first` lies there, u along `u_edge`.
  void add_quad(const Eigen::Vector3d& origin,
                const Eigen::Vector3d& u_edge,
                const Eigen::Vector3d& v_edge,
                int texture,
                double texel_m,
                SurfaceClass kind,
                double light = 1.0,
                const Eigen::Vector2d& first = Eigen::Vector2d::Zero());
  /// One triangle with texels given; shares the surface of the last one if `same_surface`.
  void add_triangle(const std::array<Eigen::Vector3d, 3>& corner,
                    const std::array<Eigen::Vector2d, 3>& uv_texel,
                    int texture,
                    double texel_m,
                    SurfaceClass kind,
                    double light,
                    bool same_surface);
  /// Upright sides (and top) of a box standing at `at` (bottom centre).
  void add_box(const Eigen::Isometry3d& at,
               const Eigen::Vector3d& size,
               int texture,
               double texel_m,
               SurfaceClass kind,
               double light = 1.0);
  /// All of `other`, moved by `T`.
  void add(const Mesh& other, const Eigen::Isometry3d& T);
};

}  // namespace roadbook
