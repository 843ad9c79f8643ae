#include "sim/world/car_model.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/world/paint.hpp"

namespace roadbook {
namespace {

constexpr double kCarTexel = 0.01;
constexpr double kRearBulge = 0.02;  // of the bumper beyond the body's length [m]
constexpr double kSill = 0.22;       // lower edge of the body [m]

/// Outline of the body from the rear bumper over the roof to the front: (x, z).
struct Profile {
  std::vector<Eigen::Vector2d> nodes;
  double belt_m = 0.9;  ///< lower edge of the windows
};

Profile profile_of(const CarShape& s) {
  const double rear = s.front_m - s.length_m;
  const double belt = 0.62 * s.height_m;
  const double hood = rear + (1.0 - s.bonnet) * s.length_m;
  const double tail = rear + s.boot * s.length_m;
  Profile p;
  p.belt_m = belt;
  p.nodes = {{rear, kSill},
             {rear - kRearBulge, 0.55 * belt},
             {rear + 0.02, belt},
             {tail + 0.04, belt + 0.03},
             {tail + 0.45, s.height_m - 0.05},
             {tail + 0.9, s.height_m},
             {hood - 1.1, s.height_m - 0.02},
             {hood - 0.85, s.height_m - 0.08},
             {hood, belt + 0.05},
             {s.front_m - 0.25, belt - 0.12},
             {s.front_m, 0.5 * belt + 0.1},
             {s.front_m, kSill}};
  return p;
}

double half_width(const CarShape& s, const Profile& p, double z) {
  const double over = std::clamp((z - p.belt_m) / (s.height_m - p.belt_m), 0.0, 1.0);
  const double under = std::clamp((0.45 - z) / 0.25, 0.0, 1.0);
  return 0.5 * s.width_m * (1.0 - 0.22 * over - 0.03 * under);
}

/// z of the outline over x.
double roof_over(const Profile& p, double x) {
  for (std::size_t i = 3; i + 2 < p.nodes.size(); ++i)
    if (x <= p.nodes[i].x()) {
      const auto& a = p.nodes[i - 1];
      const auto& b = p.nodes[i];
      return a.y() + (b.y() - a.y()) * std::clamp((x - a.x()) / (b.x() - a.x()), 0.0, 1.0);
    }
  const auto& a = p.nodes[p.nodes.size() - 3];
  const auto& b = p.nodes[p.nodes.size() - 2];
  return a.y() + (b.y() - a.y()) * std::clamp((x - a.x()) / (b.x() - a.x() + 1e-9), 0.0, 1.0);
}

void add_grain(cv::Mat& image, double sigma, Random& random) {
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      auto& t = image.at<std::uint8_t>(y, x);
      t = cv::saturate_cast<std::uint8_t>(t + sigma * random.normal());
    }
}

/// The side as seen from outside: x along, z up; texel (0, 0) at the rear bumper and the ground.
Canvas paint_side(const CarShape& s, const Profile& p, Random& random) {
  const double rear = s.front_m - s.length_m - 0.05;
  Canvas c{cv::Mat(static_cast<int>((s.height_m + 0.1) / kCarTexel),
                   static_cast<int>((s.length_m + 0.1) / kCarTexel), CV_8UC1, cv::Scalar(s.paint)),
           {rear, 0.0},
           kCarTexel};
  fill_convex(c, strip({rear, 0.3}, {s.front_m, 0.3}, 0.2), 0.55 * s.paint, 0.8, 0.05);  // dirt
  fill_convex(c, strip({rear, 0.62}, {s.front_m, 0.62}, 0.05), 0.35 * s.paint + 20,
              1.0);  // rubber strip
  // Windows, one for every door, following the roof.
  const double front_end = p.nodes[8].x() - 0.12;
  const double back_end = p.nodes[3].x() + 0.25;
  const double middle = 0.48 * front_end + 0.52 * back_end;
  const auto window = [&](double a, double b) {
    Polygon glass{{a, p.belt_m + 0.03}, {b, p.belt_m + 0.03}};
    glass.push_back({b - 0.02, std::max(p.belt_m + 0.06, roof_over(p, b - 0.02) - 0.09)});
    glass.push_back({a + 0.02, std::max(p.belt_m + 0.06, roof_over(p, a + 0.02) - 0.09)});
    fill_convex(c, glass, 28 + 20 * random.uniform(), 1.0);
    fill_convex(
        c,
        strip(glass[0] + Eigen::Vector2d(0.1, 0.05), glass[2] - Eigen::Vector2d(0.2, 0.05), 0.09),
        90, 0.6);
  };
  window(back_end, middle - 0.05);
  window(middle + 0.05, front_end);
  const double sheet = s.paint > 80 ? 0.35 * s.paint : s.paint + 45;
  for (const double x : {back_end + 0.25, middle, front_end - 0.02})
    fill_convex(c, strip({x, 0.3}, {x, p.belt_m}, 0.02), sheet, 1.0);
  for (const double x : {middle - 0.25, front_end - 1.0})
    fill_convex(c, strip({x, p.belt_m - 0.13}, {x + 0.18, p.belt_m - 0.13}, 0.035),
                s.paint > 128 ? 40 : 200, 1.0);
  fill_convex(c, rectangle({s.front_m - 0.2, 0.5 * p.belt_m + 0.22}, 0.0, {0.36, 0.16}), 225, 1.0);
  fill_convex(c, rectangle({s.front_m - s.length_m + 0.12, p.belt_m - 0.12}, 0.0, {0.24, 0.3}), 70,
              1.0);
  add_grain(c.image, 2.5, random);
  return c;
}

/// Bonnet, screens, roof and ends unrolled: u along the outline, v across.
Canvas paint_top(const CarShape& s, const Profile& p, Random& random) {
  std::vector<double> along{0.0};
  for (std::size_t i = 1; i < p.nodes.size(); ++i)
    along.push_back(along.back() + (p.nodes[i] - p.nodes[i - 1]).norm());
  const double half = 0.5 * s.width_m;
  Canvas c{cv::Mat(static_cast<int>(s.width_m / kCarTexel),
                   static_cast<int>(along.back() / kCarTexel), CV_8UC1, cv::Scalar(s.paint)),
           {0.0, -half},
           kCarTexel};
  const auto across = [&](double from, double to, double width, double value) {
    fill_convex(c, strip({from, 0.0}, {to, 0.0}, width), value, 1.0);
  };
  across(along[3] + 0.05, along[4] - 0.03, 1.25, 30);  // rear window
  across(along[7] + 0.04, along[8] - 0.05, 1.35, 34);  // windscreen
  fill_convex(c, strip({along[7] + 0.1, -0.3}, {along[8] - 0.1, 0.4}, 0.12), 95, 0.6);
  across(along[8] + 0.02, along[8] + 0.06, 1.4, 20);  // gap at the bonnet
  for (const double side : {-1.0, 1.0}) {
    fill_convex(c, rectangle({along[1] + 0.05, side * (half - 0.2)}, 0.0, {0.3, 0.26}), 75, 1.0);
    fill_convex(c, rectangle({along[1] + 0.05, side * (half - 0.2)}, 0.0, {0.1, 0.2}), 170, 1.0);
    fill_convex(c, rectangle({along[10] - 0.12, side * (half - 0.24)}, 0.0, {0.2, 0.36}), 235, 1.0);
    fill_convex(c, rectangle({along[10] - 0.12, side * (half - 0.2)}, 0.0, {0.1, 0.1}), 90, 1.0);
  }
  fill_convex(c, rectangle({along[10] + 0.05, 0.0}, 0.0, {0.14, 0.9}), 25, 1.0);  // grille
  const double turn = 0.5 * std::numbers::pi;
  for (const auto& [place, heading] :
       {std::pair{along[0] + 0.32, -turn}, std::pair{along[11] - 0.2, turn}}) {
    fill_convex(c, rectangle({place, 0.0}, 0.0, {0.12, 0.52}), 235, 1.0);
    draw_text(c, s.plate, {place, 0.0}, heading, 0.075, 15, 1.0);
  }
  fill_convex(c, strip({0.0, 0.0}, {0.16, 0.0}, s.width_m), 35, 0.9);  // rear bumper's lower part
  add_grain(c.image, 2.5, random);
  return c;
}

Canvas paint_wheel(Random& random) {
  Canvas c{cv::Mat(64, 64, CV_8UC1, cv::Scalar(22)), {-0.32, -0.32}, kCarTexel};
  const auto disc = [&](double radius, double value) {
    Polygon circle;
    for (int i = 0; i < 20; ++i) {
      const double a = i * std::numbers::pi / 10.0;
      circle.push_back(radius * Eigen::Vector2d(std::cos(a), std::sin(a)));
    }
    fill_convex(c, circle, value, 1.0);
  };
  disc(0.21, 150);
  for (int i = 0; i < 5; ++i) {
    const double a = i * 2.0 * std::numbers::pi / 5.0;
    fill_convex(c, rectangle(0.12 * Eigen::Vector2d(std::cos(a), std::sin(a)), a, {0.08, 0.07}), 35,
                1.0);
  }
  disc(0.035, 60);
  add_grain(c.image, 3.0, random);
  return c;
}

void add_sides(const CarShape& s,
               const Profile& p,
               const Canvas& side,
               int texture,
               SurfaceClass kind,
               Mesh& mesh) {
  std::vector<double> xs;
  for (std::size_t i = 2; i + 1 < p.nodes.size(); ++i) xs.push_back(p.nodes[i].x());
  for (const double left : {1.0, -1.0}) {
    const auto at = [&](double x, double z) {
      return Eigen::Vector3d(x, left * half_width(s, p, z), z);
    };
    const auto uv = [&](const Eigen::Vector3d& v) { return side.texel({v.x(), v.z()}); };
    bool same = false;
    const auto band = [&](auto low, auto high, double light) {
      same = false;
      for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
        const Eigen::Vector3d a = at(xs[i], low(xs[i])), b = at(xs[i + 1], low(xs[i + 1]));
        const Eigen::Vector3d d = at(xs[i], high(xs[i])), e = at(xs[i + 1], high(xs[i + 1]));
        mesh.add_triangle({a, b, e}, {uv(a), uv(b), uv(e)}, texture, kCarTexel, kind, light, same);
        same = true;
        mesh.add_triangle({a, e, d}, {uv(a), uv(e), uv(d)}, texture, kCarTexel, kind, light, same);
      }
    };
    const auto roof = [&](double x) { return roof_over(p, x); };
    const auto belt = [&](double x) { return std::min(p.belt_m, roof_over(p, x)); };
    band([](double) { return kSill; }, belt, left > 0 ? 0.95 : 0.85);
    band(belt, roof, left > 0 ? 1.05 : 0.95);
  }
}

void add_shell(const CarShape& s,
               const Profile& p,
               const Canvas& top,
               int texture,
               SurfaceClass kind,
               Mesh& mesh) {
  double along = 0.0;
  for (std::size_t i = 0; i + 1 < p.nodes.size(); ++i) {
    const Eigen::Vector2d a = p.nodes[i], b = p.nodes[i + 1];
    const double next = along + (b - a).norm();
    const double wa = half_width(s, p, a.y()), wb = half_width(s, p, b.y());
    const Eigen::Vector3d al(a.x(), wa, a.y()), ar(a.x(), -wa, a.y()), bl(b.x(), wb, b.y()),
        br(b.x(), -wb, b.y());
    const Eigen::Vector2d ual = top.texel({along, wa}), uar = top.texel({along, -wa});
    const Eigen::Vector2d ubl = top.texel({next, wb}), ubr = top.texel({next, -wb});
    const double up = std::abs(b.x() - a.x()) / (b - a).norm();
    const double light = 0.75 + 0.35 * up;
    mesh.add_triangle({ar, al, bl}, {uar, ual, ubl}, texture, kCarTexel, kind, light, false);
    mesh.add_triangle({ar, bl, br}, {uar, ubl, ubr}, texture, kCarTexel, kind, light, true);
    along = next;
  }
}

void add_wheels(
    const CarShape& s, const Canvas& wheel, int texture, SurfaceClass kind, Mesh& mesh) {
  for (const double x : {0.0, s.wheelbase_m})
    for (const double left : {1.0, -1.0}) {
      const Eigen::Vector3d centre(x, left * (0.5 * s.width_m + 0.01), 0.31);
      bool same = false;
      for (int i = 0; i < 16; ++i) {
        const double a = i * std::numbers::pi / 8.0, b = (i + 1) * std::numbers::pi / 8.0;
        const auto rim = [&](double t) {
          return Eigen::Vector2d(0.31 * std::cos(t), 0.31 * std::sin(t));
        };
        const Eigen::Vector2d ra = rim(a), rb = rim(b);
        mesh.add_triangle({centre, centre + Eigen::Vector3d(ra.x(), 0, ra.y()),
                           centre + Eigen::Vector3d(rb.x(), 0, rb.y())},
                          {wheel.texel({0, 0}), wheel.texel(ra), wheel.texel(rb)}, texture,
                          kCarTexel, kind, 1.0, same);
        same = true;
      }
      Eigen::Isometry3d at = Eigen::Isometry3d::Identity();
      at.translation() = Eigen::Vector3d(x, left * (0.5 * s.width_m - 0.1), 0.0);
      mesh.add_box(at, {0.42, 0.2, 0.5}, texture, 0.05, kind, 0.35);
    }
}

}  // namespace

CarShape own_car_shape() {
  CarShape own;
  own.paint = 185.0;
  own.plate = "BS VC 2013";
  return own;
}

VehicleMeasures vehicle_measures(const VehicleSpec& vehicle) {
  const CarShape own = own_car_shape();
  VehicleMeasures measures;
  measures.length_m = own.length_m + kRearBulge;
  measures.width_m = own.width_m;
  measures.height_m = own.height_m;
  // Not 0.7699999999999996: a millimetre is finer than any car is built.
  measures.rear_overhang_m = std::round(1e3 * (*measures.length_m - own.front_m)) / 1e3;
  if (vehicle.wheelbase_m <= own.front_m) measures.wheelbase_m = vehicle.wheelbase_m;
  if (vehicle.track_width_m <= own.width_m) measures.track_width_m = vehicle.track_width_m;
  return measures;
}

CarShape car_shape(int model, Random& random) {
  static constexpr double kPaints[] = {40, 205, 95, 150, 60, 225, 120, 30, 175};
  CarShape s;
  s.length_m = 3.9 + 0.1 * model;
  s.width_m = 1.70 + 0.015 * model;
  s.height_m = model % 4 == 3 ? 1.75 : 1.44 + 0.01 * model;
  s.boot = model % 3 == 1 ? 0.13 : 0.02;
  s.bonnet = model % 4 == 3 ? 0.2 : 0.27;
  s.paint = kPaints[model % 9];
  s.wheelbase_m = 0.61 * s.length_m;
  s.front_m = s.wheelbase_m + 0.21 * s.length_m;
  s.plate = "ZH " + std::to_string(100000 + random.below(900000));
  return s;
}

Mesh make_car(const CarShape& s,
              SurfaceClass kind,
              std::vector<Texture>& textures,
              Random& random) {
  const Profile profile = profile_of(s);
  const Canvas side = paint_side(s, profile, random);
  const Canvas top = paint_top(s, profile, random);
  const Canvas wheel = paint_wheel(random);
  const int first = static_cast<int>(textures.size());
  for (const Canvas* c : {&side, &top, &wheel}) textures.emplace_back(c->image.clone(), false);
  Mesh mesh;
  add_sides(s, profile, side, first, kind, mesh);
  add_shell(s, profile, top, first + 1, kind, mesh);
  add_wheels(s, wheel, first + 2, kind, mesh);
  return mesh;
}

}  // namespace roadbook
