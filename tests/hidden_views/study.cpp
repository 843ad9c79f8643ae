#include <cstdio>
#include <ctime>
#include <cstdlib>
#include "diagnosis/view_fit.hpp"
#include "mapping/map_file.hpp"
#include "tests/hidden_views/view_injector.hpp"
using namespace roadbook;
using namespace roadbook::test;
static double now() { timespec t{}; clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t); return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec); }
int main(int argc, char** argv) {
  HiddenViewOptions o;
  o.length_m = std::atof(argv[1]);
  o.seed = std::strtoull(argv[2], nullptr, 10);
  for (int i = 3; i + 1 < argc; i += 2) o.secret[argv[i]] = std::atof(argv[i + 1]);
  const std::filesystem::path folder = "/tmp/views_study";
  std::filesystem::create_directories(folder);
  double t = now();
  auto lap = [&](const char* what) { std::printf("%-10s %.2f s\n", what, now() - t); t = now(); };
  write_hidden_views(o, folder);
  lap("write");
  const Map map = load_map(folder / "map.gpkg");
  lap("load");
  const Drive drive = Drive::open(folder / "drive");
  ViewData data = view_data(map, 0, drive);
  lap("data");
  std::printf("keyframes %zu, landmarks %zu of %zu, views %zu of %zu, motions %zu\n", data.bundle.poses.size(), data.bundle.points.size(), map.landmarks.size(), data.bundle.observations.size(), map.observations.size(), data.bundle.motions.size());
  ViewBasis basis; basis.cameras = data.bundle.cameras.size();
  const ViewFit fit = fit_views(std::move(data), basis, {});
  lap("fit");
  for (double s : fit.noise.pixel) std::printf("px %.3f ", s);
  for (double s : fit.noise.motion) std::printf("m %.3f ", s);
  std::printf("ground %.4f; out", fit.noise.ground_m);
  for (auto n : fit.outliers) std::printf(" %zu", n);
  std::printf(" %s\n", fit.message.c_str());
  ViewSystem system(fit.data, basis);
  ViewPoint point = fit.point;
  system.linearise(point, fit.noise);
  lap("linearise");
  const ViewSides sides = system.all_sides();
  lap("sides");
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(sides.count, sides.count);
  ViewPanel values;
  for (std::size_t k = 0; k < system.poses(); ++k) {
    system.rows(k, sides, values);
    G.selfadjointView<Eigen::Lower>().rankUpdate(values.transpose());
  }
  lap("gram");
  std::printf("rows %zu, residual %.4f\n", system.row_count(), G(0,0) / static_cast<double>(system.row_count()));
  for (const ViewCause& c : view_causes(fit.data, basis)) {
    double u = 0, F = 0;
    for (auto ci : c.columns) { const auto i = static_cast<Eigen::Index>(ci); u += G(1 + i, 0); for (auto cj : c.columns) { const auto j = static_cast<Eigen::Index>(cj); F += G(1 + std::max(i, j), 1 + std::min(i, j)); } }
    std::printf("%-28s z %8.2f  size %9.5f +- %.6f (tau %g)\n", c.name.c_str(), u / std::sqrt(F), u / F, 1 / std::sqrt(F), c.tau);
  }
}
