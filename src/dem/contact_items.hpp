// What happens for one particle or one body shape in the contact stages. One text for the CPU and CUDA.
#pragma once

#include <cstdint>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/body_exchange.hpp"
#include "physics/contact_law.hpp"

namespace scree {

// Half space in the form the items read.
struct WallPlane {
  Vec3 point, normal;
  int material;
};

// The law of every contact: one pair of materials, or a table of them.
struct OneLaw {
  KelvinVoigt law;
  SCREE_HD const KelvinVoigt& get(int, int) const { return law; }
};

struct LawTable {
  const KelvinVoigt* laws;  // [materials * materials]
  int materials;
  SCREE_HD const KelvinVoigt& get(int i, int j) const { return laws[i * materials + j]; }
};

// Read-only views of items and neighbour list.
struct ContactViews {
  const Vec4* position;   // x, y, z, radius
  const Vec4* velocity;   // x, y, z, mass
  const int* material;
  const Index* offsets;   // neighbour list rows
  const Index* neighbors;
  const Index* wall_offsets;
  const Index* walls;
  const WallPlane* planes;
  Index first_shape;      // items from here on are shapes of bodies
};

// Wall as a partner: overlap with its plane along its normal.
SCREE_HD Overlap wall_overlap(Vec4 p, const WallPlane& wall) {
  const Real distance = dot(xyz(p) - wall.point, wall.normal);
  return {p.w - distance, distance, wall.normal};
}

// A particle's share of a contact's energies: half with another particle, all with a body's shape or a wall.
SCREE_HD Real particle_share(Index j, Index first_shape) { return j < first_shape ? Real(0.5) : Real(1); }

struct TotalForce {
  Vec3 force;       // [N], gravity included
  Real loss_power;  // the particle's share of its contacts' dissipation [W]
};

// Total force on particle i at the current positions and velocities, and its share of the dissipation.
template <class Elastic, class Laws>
struct ContactForceItem {
  ContactViews in;
  Laws laws;
  Vec3 gravity;
  Vec3* force;       // [N]
  Real* loss_power;  // [W]

  SCREE_HD void operator()(Index i) const {
    const TotalForce sum = total(i);
    force[i] = sum.force;
    loss_power[i] = sum.loss_power;
  }

  SCREE_HD TotalForce total(Index i) const {
    const Vec4 p = in.position[i], u = in.velocity[i];
    const int material = in.material[i];
    Vec3 f = u.w * gravity;
    Real loss = 0;
    for (Index k = in.offsets[i]; k < in.offsets[i + 1]; ++k) {
      const Index j = in.neighbors[k];
      const Vec4 q = in.position[j];
      const Vec3 r = xyz(p) - xyz(q);
      const Real reach = p.w + q.w;
      if (dot(r, r) >= reach * reach) continue;
      const Overlap o = sphere_overlap(r, reach);
      const Real rate = -dot(o.normal, xyz(u) - xyz(in.velocity[j]));
      const ContactForce c = contact_force<Elastic>(laws.get(material, in.material[j]), o.overlap, rate);
      f += c.force * o.normal;
      loss += particle_share(j, in.first_shape) * c.loss;
    }
    for (Index k = in.wall_offsets[i]; k < in.wall_offsets[i + 1]; ++k) {
      const WallPlane& wall = in.planes[in.walls[k]];
      const Overlap o = wall_overlap(p, wall);
      if (o.overlap <= 0) continue;
      const ContactForce c =
          contact_force<Elastic>(laws.get(material, wall.material), o.overlap, -dot(o.normal, xyz(u)));
      f += c.force * o.normal;
      loss += c.loss;
    }
    return {f, loss};
  }
};

// Newton matrix of the touching pairs: row i is sum over its entries of b (b . (x_i - x_j)), with
// b = sqrt(beta h^2 dF/dd + h gamma dF/d(d_dot)) n. Entries stand at the neighbour list's slots, packed to the front of a row.
struct ContactMatrix {
  Index* count;     // entries of row i
  Index* neighbor;  // [slots of the list]
  Vec3* b;          // [sqrt(kg)]
  Sym3* diagonal;   // sum of b b^T over the row, walls included [kg]
};

// Weights of stiffness and damping in the Newton matrix.
struct NewtonWeights {
  Real stiffness;  // beta h^2 [s^2]
  Real damping;    // h gamma [s]
};

// Force, dissipation and Newton matrix row of particle i.
template <class Elastic, class Laws>
struct ContactSystemItem {
  ContactViews in;
  Laws laws;
  Vec3 gravity;
  NewtonWeights weights;
  Vec3* force;              // [N]
  Real* loss_power;         // [W]
  Real* force_magnitude;    // sum of |F| over contacts and gravity [N]: the scale of the residual
  DampingRamp ramp;
  ContactMatrix matrix;

  SCREE_HD void operator()(Index i) const {
    const Vec4 p = in.position[i], u = in.velocity[i];
    const int material = in.material[i];
    Vec3 f = u.w * gravity;
    Real loss = 0, magnitude = norm(f);
    Index entries = 0;
    Sym3 diagonal;
    const auto add = [&](const ContactForce& c, Vec3 normal, Real share) {
      f += c.force * normal;
      magnitude += std::abs(c.force);
      loss += share * c.loss;
      return weights.stiffness * c.stiffness + weights.damping * c.damping;
    };
    for (Index k = in.offsets[i]; k < in.offsets[i + 1]; ++k) {
      const Index j = in.neighbors[k];
      const Vec4 q = in.position[j];
      const Overlap o = sphere_overlap(xyz(p) - xyz(q), p.w + q.w);
      if (o.overlap <= 0) continue;
      const Real rate = -dot(o.normal, xyz(u) - xyz(in.velocity[j]));
      const Real s = add(contact_force<Elastic>(laws.get(material, in.material[j]), o.overlap, rate, ramp), o.normal,
                         particle_share(j, in.first_shape));
      diagonal += outer(s, o.normal);
      const Index slot = in.offsets[i] + entries++;
      matrix.neighbor[slot] = j;
      matrix.b[slot] = std::sqrt(s) * o.normal;
    }
    for (Index k = in.wall_offsets[i]; k < in.wall_offsets[i + 1]; ++k) {
      const WallPlane& wall = in.planes[in.walls[k]];
      const Overlap o = wall_overlap(p, wall);
      if (o.overlap <= 0) continue;
      const Real rate = -dot(o.normal, xyz(u));
      const Real s = add(contact_force<Elastic>(laws.get(material, wall.material), o.overlap, rate, ramp), o.normal, 1);
      diagonal += outer(s, o.normal);
    }
    force[i] = f, loss_power[i] = loss, force_magnitude[i] = magnitude;
    matrix.count[i] = entries;
    matrix.diagonal[i] = diagonal;
  }
};

// What the contacts of one shape of a body sum to.
struct ShapeContact {
  Vec3 force;                // on the shape; every contact force passes through the shape's centre [N]
  Sym3 stiffness, damping;   // -d(force)/d(position), -d(force)/d(velocity) of the shape's centre [N/m], [N s/m]
  Real loss_power = 0;       // the shape's share [W]
  Real energy = 0;           // the shape's share of the contacts' elastic energy [J]
  Real pairs = 0;            // the shape's share of the number of contacts
  Index contacts = 0;
};

// Contacts of shape item i. Particles book the dissipation of their contacts with shapes, shapes among each
// other half each.
template <class Elastic, class Laws>
struct ShapeContactItem {
  ContactViews in;
  Laws laws;
  DampingRamp ramp;
  ShapeContact* out;  // [shape items], indexed from first_shape

  SCREE_HD void add(ShapeContact& sum, const KelvinVoigt& law, const Overlap& o, Real rate, Real share) const {
    const ContactForce c = contact_force<Elastic>(law, o.overlap, rate, ramp);
    sum.force += c.force * o.normal;
    sum.stiffness += outer(c.stiffness, o.normal);
    sum.damping += outer(c.damping, o.normal);
    sum.loss_power += share * c.loss;
    sum.energy += share * Elastic::energy(law, o.overlap);
    sum.pairs += share;
    ++sum.contacts;
  }

  SCREE_HD void operator()(Index shape) const {
    const Index i = in.first_shape + shape;
    const Vec4 p = in.position[i], u = in.velocity[i];
    ShapeContact sum;
    for (Index k = in.offsets[i]; k < in.offsets[i + 1]; ++k) {
      const Index j = in.neighbors[k];
      const Overlap o = sphere_overlap(xyz(p) - xyz(in.position[j]), p.w + in.position[j].w);
      if (o.overlap <= 0) continue;
      const Real rate = -dot(o.normal, xyz(u) - xyz(in.velocity[j]));
      add(sum, laws.get(in.material[i], in.material[j]), o, rate, j < in.first_shape ? 0 : Real(0.5));
    }
    for (Index k = in.wall_offsets[i]; k < in.wall_offsets[i + 1]; ++k) {
      const WallPlane& wall = in.planes[in.walls[k]];
      const Overlap o = wall_overlap(p, wall);
      if (o.overlap > 0)
        add(sum, laws.get(in.material[i], wall.material), o, -dot(o.normal, xyz(u)), 1);
    }
    out[shape] = sum;
  }
};

// Elastic energy of particle i's share of its contacts, their number, and its share of that number.
template <class Elastic, class Laws>
struct ContactEnergyItem {
  ContactViews in;
  Laws laws;
  Real* energy;     // [J]
  Index* contacts;
  Real* pairs;      // half of each contact with another particle, all of any other

  SCREE_HD void operator()(Index i) const {
    const Vec4 p = in.position[i];
    Real sum = 0, share = 0;
    Index n = 0;
    for (Index k = in.offsets[i]; k < in.offsets[i + 1]; ++k) {
      const Index j = in.neighbors[k];
      const Overlap o = sphere_overlap(xyz(p) - xyz(in.position[j]), p.w + in.position[j].w);
      if (o.overlap <= 0) continue;
      const Real own = particle_share(j, in.first_shape);
      sum += own * Elastic::energy(laws.get(in.material[i], in.material[j]), o.overlap);
      share += own;
      ++n;
    }
    for (Index k = in.wall_offsets[i]; k < in.wall_offsets[i + 1]; ++k) {
      const WallPlane& wall = in.planes[in.walls[k]];
      const Overlap o = wall_overlap(p, wall);
      if (o.overlap <= 0) continue;
      sum += Elastic::energy(laws.get(in.material[i], wall.material), o.overlap);
      share += 1;
      ++n;
    }
    energy[i] = sum;
    contacts[i] = n;
    pairs[i] = share;
  }
};

}  // namespace scree
