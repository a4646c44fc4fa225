#include "mbs/energy_ledger.hpp"

#include "physics/energy.hpp"
#include "physics/time_stepping.hpp"

namespace scree {

namespace {

Vec3 translation(const std::vector<Real>& v, std::size_t body) { return {v[3 * body], v[3 * body + 1], 0}; }
Vec3 rotation(const std::vector<Real>& v, std::size_t body) { return {0, 0, v[3 * body + 2]}; }

}  // namespace

void book_step(PlanarSystem& system, const MultibodyState& start, Real t, Real h, MultibodyState& end) {
  const Powers p0 = system.powers({t, start.position, start.velocity}, start.multipliers);
  const Powers p1 = system.powers({t + h, end.position, end.velocity}, end.multipliers);
  const Real driver_work = h / 2 * (p0.drivers + p1.drivers);
  Real loss = driver_work;
  const std::vector<Real>&v0 = start.velocity, &v1 = end.velocity, &f0 = start.applied, &f1 = end.applied;
  for (std::size_t b = 0; b < system.bodies().size(); ++b) {
    const Body& body = system.bodies()[b];
    loss += integrator_loss(body.mass, translation(end.position, b) - translation(start.position, b),
                            translation(v0, b), translation(v1, b), translation(f0, b), translation(f1, b));
    loss += integrator_loss(body.inertia, rotation(end.position, b) - rotation(start.position, b),
                            rotation(v0, b), rotation(v1, b), rotation(f0, b), rotation(f1, b));
  }
  end.dissipated = start.dissipated + h / 2 * (p0.dissipated + p1.dissipated);
  end.driver_work = start.driver_work + driver_work + h / 2 * (p0.applied + p1.applied);
  end.integrator_loss = start.integrator_loss + loss;
}

MultibodyEnergies stored_energies(const PlanarSystem& system, const MultibodyState& state, Real t) {
  MultibodyEnergies energies;
  for (std::size_t b = 0; b < system.bodies().size(); ++b) {
    const Body& body = system.bodies()[b];
    energies.kinetic += kinetic_energy(body.mass, translation(state.velocity, b)) +
                        kinetic_energy(body.inertia, rotation(state.velocity, b));
    energies.gravitational +=
        gravitational_energy(body.mass, system.gravity(), translation(state.position, b));
  }
  energies.elastic = system.elastic_energy({t, state.position, state.velocity});
  return energies;
}

}  // namespace scree
