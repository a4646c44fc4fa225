// Oblique impact of a particle on the disc or sphere of a body, with spins, or on a particle in its place.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "verification/friction/particle_decks.hpp"

namespace scree {

// The partner of the particle: a body, or another particle.
struct Partner {
  Vec3 position, velocity;
  Real spin, radius, mass, inertia;  // spin: about z [rad/s]
  Vec3 offset{};                     // of the shape in the body's frame [m]
};

struct Meeting {
  int dimension;
  Grain grain;
  Partner partner;
  std::string law;
  Real step, end;
  int substeps = 1;
  std::string sides{};
  Real half = 2;  // half width of the domain [m]
  std::string integrator = "particles = \"velocity-verlet\"\n";
  std::vector<std::string> settings{};  // as on the command line

  std::string vector(Vec3 a) const { return dimension == 3 ? toml(a) : fmt::format("[{}, {}]", a.x, a.y); }
  std::string spin(Vec3 w) const { return dimension == 3 ? toml(w) : fmt::format("[{}]", w.z); }
  std::string setup() const {
    return fmt::format(
               "[space]\ndimension = {}\nmin = {}\nmax = {}\n{}[time]\nend = {}\nstep = {}\n[integrator]\n"
               "{}substeps = {}\n[[contact.pairs]]\n{}",
               dimension, vector(-half * Vec3{1, 1, 1}), vector(half * Vec3{1, 1, 1}), sides, end, step,
               integrator, substeps, law) +
           particle("grain", grain.position, grain.velocity, grain.spin, grain.radius, grain.mass);
  }
  std::string particle(const char* name, Vec3 position, Vec3 velocity, Vec3 w, Real radius, Real mass) const {
    return fmt::format(
        "[[particles]]\nname = \"{}\"\nkind = \"list\"\npositions = [{}]\nvelocity = {}\n"
        "angular_velocity = {}\nradius = {}\nmass = {}\n",
        name, vector(position), vector(velocity), spin(w), radius, mass);
  }
  Model with_body() const {
    return model_of(
        setup() + fmt::format("[[bodies]]\nname = \"partner\"\nposition = {}\nvelocity = {}\n"
                              "angular_velocity = {}\nmass = {}\ninertia = {}\n"
                              "shapes = [{{ radius = {}, offset = {} }}]\n",
                              vector(partner.position), vector(partner.velocity), partner.spin, partner.mass,
                              partner.inertia, partner.radius, vector(partner.offset)),
        settings);
  }
  Model with_particle() const {
    return model_of(setup() + particle("partner", partner.position, partner.velocity, {0, 0, partner.spin},
                                       partner.radius, partner.mass),
                    settings);
  }
};

inline const std::string kUndamped = "stiffness = 1e6\nfriction = 0.3\ntangential_stiffness = 8e5\n";
inline constexpr Real kContactTime = 2.3e-3;  // of 1 kg against as much [s]

// Momentum and angular momentum about the origin of particle and body.
struct Momenta {
  Vec3 linear, angular;
};
inline Momenta momenta(SimulationRun& run, const Partner& partner) {
  const ParticleLedger particles = run.particle_ledger();
  const std::vector<Real>&q = run.bodies().position, &v = run.bodies().velocity;
  const Vec3 of_body = partner.mass * Vec3{v[0], v[1], 0};
  return {particles.momentum + of_body,
          particles.angular_momentum + cross({q[0], q[1], 0}, of_body) + Vec3{0, 0, partner.inertia * v[2]}};
}

// Two equal discs in an oblique impact, or a disc and one off the centre of its body.
inline Meeting disc_meeting(Real steps, int substeps, Real phase, Vec3 offset) {
  constexpr Real R = 0.05;
  const Vec3 normal{0.8, 0.6, 0};
  const Real h = kContactTime / steps;
  Meeting out{2,
              {.velocity = {-1.5, 0.4, 0}, .spin = {0, 0, 20}, .radius = R, .mass = 1},
              {-offset, {0.5, 0.1, 0}, 12, R, 1, R * R / 2, offset},
              kUndamped,
              h,
              2 * kContactTime};
  out.substeps = substeps;
  const Vec3 towards =
      out.grain.velocity - out.partner.velocity - out.partner.spin * Vec3{-offset.y, offset.x};
  out.grain.position = 2 * R * normal - (phase + 0.5) * h * dot(towards, normal) * normal;
  return out;
}

inline Real difference(const Particle& p, const Particle& q, Real radius) {
  return std::max(norm(p.velocity - q.velocity), radius * norm(p.angular_velocity - q.angular_velocity));
}

// A body so heavy that its velocity hardly changes: its centre moves and rotates like a particle's. The
// motion of a particle with friction on it, against that on an equally heavy particle.
inline constexpr const char* kHeavyLaws[] = {
    "stiffness = 1e5\ndamping = 30.0\nfriction = 0.4\ntangential_stiffness = 8e4\n"
    "tangential_damping_ratio = 0.2\n",
    "stiffness = 1e5\nfriction = 5.0\ntangential_stiffness = 8e4\n"};
struct HeavyMeeting {
  Real apart = 0, turned = 0;  // largest difference of both particles, and of the spin of one [m/s], [rad/s]
  Real loss_on_body = 0, loss_on_particle = 0;  // dissipated [J]

  HeavyMeeting(int dimension, const char* law, Real step, const std::string& integrator = {}) {
    const Real z = dimension == 3 ? 0.02 : 0;
    Meeting meeting{dimension,
                    {.position = {0.15, 0.15, z},
                     .velocity = {-1.5, -1, 10 * z},
                     .spin = {200 * z, -500 * z, 30},
                     .radius = 0.05,
                     .mass = 1},
                    {{0, 0, 0}, {0.3, -0.2, 0}, 15, 0.1, 1e15, 1e13},
                    law,
                    step,
                    0.08};
    if (!integrator.empty()) meeting.integrator = integrator;
    SimulationRun on_body(meeting.with_body()), on_particle(meeting.with_particle());
    for (int part = 1; part <= 40; ++part) {
      for (SimulationRun* run : {&on_body, &on_particle}) run->run_until(part * meeting.end / 40);
      const Particle p = on_body.particles().at(0), q = on_particle.particles().at(0);
      apart = std::max(apart, difference(p, q, meeting.grain.radius));
      turned = std::max(turned, norm(q.angular_velocity - meeting.grain.spin));
    }
    loss_on_body = on_body.particle_ledger().contact_loss;
    loss_on_particle = on_particle.particle_ledger().contact_loss;
  }
};

}  // namespace scree
