#include "sim/world/mesh.hpp"

namespace roadbook {

void Mesh::add_triangle(const std::array<Eigen::Vector3d, 3>& corner,
                        const std::array<Eigen::Vector2d, 3>& uv_texel,
                        int texture,
                        double texel_m,
                        SurfaceClass kind,
                        double light,
                        bool same_surface) {
  if (!same_surface || surfaces == 0) ++surfaces;
  Triangle t;
  for (std::size_t i = 0; i < 3; ++i) {
    t.corner[i] = corner[i].cast<float>();
    t.uv[i] = uv_texel[i].cast<float>();
  }
  t.texture = texture;
  t.texel_m = static_cast<float>(texel_m);
  t.light = static_cast<float>(light);
  t.kind = kind;
  t.surface = surfaces;
  triangles.push_back(t);
}

void Mesh::add_quad(const Eigen::Vector3d& origin,
                    const Eigen::Vector3d& u_edge,
                    const Eigen::Vector3d& v_edge,
                    int texture,
                    double texel_m,
                    SurfaceClass kind,
                    double light,
                    const Eigen::Vector2d& first) {
  // Texel centres lie half a texel inside.
  const Eigen::Vector2d t00 = first - Eigen::Vector2d::Constant(0.5);
  const Eigen::Vector2d u(u_edge.norm() / texel_m, 0.0);
  const Eigen::Vector2d v(0.0, v_edge.norm() / texel_m);
  add_triangle({origin, origin + u_edge, origin + u_edge + v_edge}, {t00, t00 + u, t00 + u + v},
               texture, texel_m, kind, light, false);
  add_triangle({origin, origin + u_edge + v_edge, origin + v_edge}, {t00, t00 + u + v, t00 + v},
               texture, texel_m, kind, light, true);
}

void Mesh::add_box(const Eigen::Isometry3d& at,
                   const Eigen::Vector3d& size,
                   int texture,
                   double texel_m,
                   SurfaceClass kind,
                   double light) {
  const Eigen::Vector3d x = at.linear().col(0) * size.x();
  const Eigen::Vector3d y = at.linear().col(1) * size.y();
  const Eigen::Vector3d z = at.linear().col(2) * size.z();
  const Eigen::Vector3d o = at.translation() - 0.5 * x - 0.5 * y;
  // Faces of different brightness, as if light came from ahead and the left.
  add_quad(o, x, z, texture, texel_m, kind, 0.82 * light);
  add_quad(o + x, y, z, texture, texel_m, kind, 1.0 * light);
  add_quad(o + x + y, -x, z, texture, texel_m, kind, 0.93 * light);
  add_quad(o + y, -y, z, texture, texel_m, kind, 0.74 * light);
  add_quad(o + z, x, y, texture, texel_m, kind, 1.1 * light);
  add_quad(o + y, x, -y, texture, texel_m, kind, 0.4 * light);
}

void Mesh::add(const Mesh& other, const Eigen::Isometry3d& T) {
  const Eigen::Matrix3f R = T.linear().cast<float>();
  const Eigen::Vector3f p = T.translation().cast<float>();
  for (Triangle t : other.triangles) {
    for (auto& corner : t.corner) corner = R * corner + p;
    t.surface += surfaces;
    triangles.push_back(t);
  }
  surfaces += other.surfaces;
}

}  // namespace roadbook
