#include "diagnosis/motion/interval_jacobian.hpp"

#include <cmath>

namespace roadbook {

HatIntegrals hat_integrals(double step_s, double tau_s) {
  const double second = 0.5 * tau_s * tau_s / step_s;
  return {tau_s - second, second};
}

IntervalJacobian interval_jacobian(const Trajectory& trajectory, std::size_t j, double tau_s) {
  IntervalJacobian d;
  d.state = trajectory.after(j, tau_s);
  const double h = trajectory.step_s();
  d.hats = hat_integrals(h, tau_s);
  d.x_by_heading = -(d.state.y - trajectory.y[j]);
  d.y_by_heading = d.state.x - trajectory.x[j];
  // Two points of Gauss: derivatives need no more than the fit's own step.
  for (const double node : {0.2113248654051871, 0.7886751345948129}) {
    const double tau = node * tau_s;
    const double weight = 0.5 * tau_s;
    const double u = tau / h;
    const HatIntegrals turned = hat_integrals(h, tau);
    const double psi = trajectory.heading[j] + turned.first * trajectory.yaw_rate[j] +
                       turned.second * trajectory.yaw_rate[j + 1];
    const double v = (1.0 - u) * trajectory.speed[j] + u * trajectory.speed[j + 1];
    const double c = weight * std::cos(psi);
    const double s = weight * std::sin(psi);
    d.x[0] += c * (1.0 - u);
    d.y[0] += s * (1.0 - u);
    d.x[1] -= s * v * turned.first;
    d.y[1] += c * v * turned.first;
    d.x[2] += c * u;
    d.y[2] += s * u;
    d.x[3] -= s * v * turned.second;
    d.y[3] += c * v * turned.second;
  }
  return d;
}

}  // namespace roadbook
