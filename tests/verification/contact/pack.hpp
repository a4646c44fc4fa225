// A few spheres between static planes, by leapfrog steps: all pairs are tested, each evaluated once.
#pragma once

#include <vector>

#include "verification/contact/leapfrog.hpp"

namespace scree {

struct Plane {
  Vec3 point, normal;  // normal: unit, into the free side
};

template <class Law>
class Pack {
 public:
  Pack(const Law& law, std::vector<Grain> grains, std::vector<Plane> planes, Vec3 gravity, Real h)
      : grains(std::move(grains)), planes(std::move(planes)), law_(law), gravity_(gravity), h_(h) {
    const std::size_t n = this->grains.size();
    of_pair_.resize(n * n), of_plane_.resize(n * this->planes.size()), rates_.resize(n);
  }

  std::vector<Grain> grains;
  std::vector<Plane> planes;

  const ContactOutcome& of_pair(std::size_t i, std::size_t j) const {
    return of_pair_[i * grains.size() + j];
  }
  const ContactOutcome& of_plane(std::size_t i, std::size_t plane) const {
    return of_plane_[i * planes.size() + plane];
  }

  void step() {
    for (Grain& g : grains) g.position += h_ * g.velocity;
    std::vector<Vec3> force(grains.size()), torque(grains.size());
    for (std::size_t i = 0; i < grains.size(); ++i) {
      force[i] += grains[i].mass * gravity_;
      for (std::size_t k = 0; k < planes.size(); ++k) {
        ContactOutcome& out = of_plane_[i * planes.size() + k];
        out = law_.respond(against_plane(i, planes[k]), out.history);
        force[i] += out.load.force, torque[i] += out.load.torque_i;
      }
      for (std::size_t j = 0; j < i; ++j) {
        ContactOutcome& out = of_pair_[i * grains.size() + j];
        out = law_.respond(between(i, j), out.history);
        force[i] += out.load.force, force[j] -= out.load.force;
        torque[i] += out.load.torque_i, torque[j] += out.load.torque_j;
      }
    }
    for (std::size_t i = 0; i < grains.size(); ++i) {
      Grain& g = grains[i];
      rates_[i] = {(1 / g.mass) * force[i], (1 / g.inertia) * torque[i]};
      g.velocity += h_ * rates_[i].acceleration, g.spin += h_ * rates_[i].spin_up;
    }
  }

 private:
  Vec3 predicted(std::size_t i) const { return grains[i].velocity + (h_ / 2) * rates_[i].acceleration; }
  MovingPair against_plane(std::size_t i, const Plane& plane) const {
    const Grain& g = grains[i];
    const ContactGeometry geometry = plane_pair(g.position, g.radius, plane.point, plane.normal);
    return {{geometry, predicted(i), {g.radius, kInfinity, g.mass, kInfinity}},
            face_motion(geometry, plane.normal, h_ * g.velocity, g.partner(), {}, h_)};
  }
  MovingPair between(std::size_t i, std::size_t j) const {
    const Grain &a = grains[i], &b = grains[j];
    const ContactGeometry geometry = sphere_pair(a.position - b.position, a.radius + b.radius);
    return {{geometry, predicted(i) - predicted(j), {a.radius, b.radius, a.mass, b.mass}},
            sphere_motion(geometry, h_ * (a.velocity - b.velocity), a.partner(), b.partner(), h_)};
  }

  Law law_;
  Vec3 gravity_;  // [m/s^2]
  Real h_;        // [s]
  std::vector<ContactOutcome> of_pair_, of_plane_;
  std::vector<GrainRates> rates_;
};

}  // namespace scree
