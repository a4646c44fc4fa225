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

// Where a neighbour list keeps the entries of its rows: one row after the other in the serial backend,
// another type of the same form on a GPU.
struct PackedRows {
  const Index* offsets;  // [items + 1]
  const Index* neighbors;

  // Slot of the row's first entry, and from one entry to the next.
  SCREE_HD std::int64_t first(Index i) const { return offsets[i]; }
  SCREE_HD static constexpr int stride() { return 1; }
  // Calls add(evaluate(j)) for the entries j of row i of which touches(j) holds, in their order. evaluate has
  // no side effects: it may be called for others, too.
  template <class Touches, class Evaluate, class Add>
  SCREE_HD void for_each_contact(Index i, const Touches& touches, const Evaluate& evaluate,
                                 const Add& add) const {
    const Index end = offsets[i + 1];
    for (Index k = offsets[i]; k < end; ++k)
      if (const Index j = neighbors[k]; touches(j)) add(evaluate(j));
  }
};

// Read-only views of items and neighbour list.
template <class Rows>
struct ContactViews {
  const Vec4* position;  // x, y, z, radius
  const Vec4* velocity;  // x, y, z, mass
  const int* material;
  Rows rows;
  const Index* wall_offsets;
  const Index* walls;
  const WallPlane* planes;
  Index first_shape;  // items from here on are shapes of bodies
};

// Wall as a partner: overlap with its plane along its normal.
SCREE_HD Overlap wall_overlap(Vec4 p, const WallPlane& wall) {
  const Real distance = dot(xyz(p) - wall.point, wall.normal);
  return {p.w - distance, distance, wall.normal};
}

SCREE_HD bool touch(Vec4 p, Vec4 q) {
  const Vec3 r = xyz(p) - xyz(q);
  const Real reach = p.w + q.w;
  return dot(r, r) < reach * reach;
}

// Whether other items touch the one at p, or come within a margin of that [m].
struct TouchTest {
  Vec4 p;
  const Vec4* position;  // all items
  SCREE_HD bool operator()(Index j) const { return touch(p, position[j]); }
  SCREE_HD bool near(Index j, Real margin) const {
    const Vec4 q = position[j];
    const Vec3 r = xyz(p) - xyz(q);
    const Real reach = p.w + q.w + margin;
    return dot(r, r) < reach * reach;
  }
};

// A particle's share of a contact's energies: half with another particle, all with a body's shape or a wall.
SCREE_HD Real particle_share(Index j, Index first_shape) { return j < first_shape ? Real(0.5) : Real(1); }

// What one contact adds to them.
struct PairForce {
  Vec3 force;       // [N]
  Real loss;        // of the whole contact [W]
  bool with_shape;  // of a body
};

struct TotalForce {
  Vec3 force;       // [N], gravity included
  Real loss_power;  // the particle's share of its contacts' dissipation [W]
};

// Total force on particle i at the current positions and velocities, and its share of the dissipation.
template <class Elastic, class Laws, class Rows>
struct ContactForceItem {
  ContactViews<Rows> in;
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
    Real loss = 0, shape_loss = 0;
    const auto evaluate = [&](Index j) {
      const Vec4 q = in.position[j];
      const Vec3 r = xyz(p) - xyz(q);
      const Gap gap = sphere_gap(dot(r, r), p.w + q.w);
      const Real rate = approach_rate(r, gap.inverse_distance, xyz(u) - xyz(in.velocity[j]));
      const ContactForce c = contact_force<Elastic>(laws.get(material, in.material[j]), gap.overlap, rate);
      return PairForce{(c.force * gap.inverse_distance) * r, c.loss, j >= in.first_shape};
    };
    in.rows.for_each_contact(i, TouchTest{p, in.position}, evaluate, [&](const PairForce& c) {
      f += c.force;
      loss += c.loss;
      if (c.with_shape) shape_loss += c.loss;
    });
    loss = Real(0.5) * (loss + shape_loss);  // the particle's share: half with particles, all with shapes
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

// One touching pair in the Newton matrix. In single precision: the matrix only says where the iteration goes,
// the residual says where it ends, and the entries are most of what a matrix product reads.
struct alignas(16) ContactEntry {
  float x, y, z;   // b [sqrt(kg)]
  Index neighbor;  // j

  SCREE_HD Vec3 b() const { return {x, y, z}; }
};

SCREE_HD ContactEntry contact_entry(Vec3 b, Index neighbor) {
  return {static_cast<float>(b.x), static_cast<float>(b.y), static_cast<float>(b.z), neighbor};
}

// Newton matrix of the touching pairs: row i is sum over its entries of b (b . (x_i - x_j)), with
// b = sqrt(beta h^2 dF/dd + h gamma dF/d(d_dot)) n. Entries stand at the neighbour list's slots, packed to
// the front of a row.
struct ContactMatrix {
  Index* count;           // entries of row i
  ContactEntry* entries;  // [slots of the list]
  Sym3* diagonal;         // sum of b b^T over the row, walls included [kg]
};

// Sums over the contacts of each particle in an implicit step; "step" and "end" as in StepContact.
struct StepForces {
  Vec3 *step_force, *end_force;  // gravity included [N]
  Real *step_loss, *end_loss;    // [W]
  Real* magnitude;               // sum of |F| over contacts and gravity: the scale of the residual [N]
};

// Weights of stiffness and damping in the Newton matrix.
struct NewtonWeights {
  Real stiffness;  // newmark_position_gain [s^2]
  Real damping;    // newmark_velocity_gain [s]
};

// Where a step started, all items, and whether contacts that open or close within it are resolved; else the
// force at its end counts for the whole step, as in the paper.
struct StepStart {
  const Vec4* position;  // x, y, z, radius
  const Vec4* velocity;
  Real h;  // [s]
  bool resolve_events;
};

// One contact of an implicit step.
struct StepContact {
  ContactForce step;  // what the step's end must hold for the step to be right: see step_contact_force
  Real end_force;     // at the end itself [N]
  Real end_loss;      // [W]
};

// o, rate: overlap and rate at the end of the step; o0, rate0: at its start.
template <class Elastic>
SCREE_HD StepContact step_contact(const KelvinVoigt& law, const StepStart& start, Real overlap0, Real rate0,
                                  Real overlap1, Real rate1) {
  const ContactForce end =
      overlap1 > 0 ? contact_force<Elastic>(law, overlap1, rate1) : ContactForce{0, 0, 0, 0};
  if (!start.resolve_events) return {end, end.force, end.loss};
  return {step_contact_force<Elastic>(law, {overlap0, rate0, overlap1, rate1, start.h}), end.force, end.loss};
}

// Visits the contacts of item i over a step: visit(StepContact, normal at the end, slot of the neighbour or
// -1 for a wall, partner).
template <class Elastic, class Laws, class Rows>
struct StepContacts {
  ContactViews<Rows> in;
  Laws laws;
  StepStart start;

  struct Neighbor {
    StepContact contact;
    Vec3 normal;
    Index j;
  };

  SCREE_HD static Real rate(Vec3 normal, Vec3 relative_velocity) { return -dot(normal, relative_velocity); }

  template <class Visit>
  SCREE_HD void neighbors(Index i, const Visit& visit) const {
    const Vec4 p = in.position[i], p0 = start.position[i];
    const auto evaluate = [&](Index j) {
      const Vec4 q = in.position[j];
      const Real reach = p.w + q.w;
      const Overlap o = sphere_overlap(xyz(p) - xyz(q), reach);
      const Overlap o0 = sphere_overlap(xyz(p0) - xyz(start.position[j]), reach);
      const KelvinVoigt& law = laws.get(in.material[i], in.material[j]);
      return Neighbor{
          step_contact<Elastic>(law, start, o0.overlap,
                                rate(o0.normal, xyz(start.velocity[i]) - xyz(start.velocity[j])), o.overlap,
                                rate(o.normal, xyz(in.velocity[i]) - xyz(in.velocity[j]))),
          o.normal, j};
    };
    in.rows.for_each_contact(
        i, [&](Index j) { return touch(p, in.position[j]) || touch(p0, start.position[j]); }, evaluate,
        [&](const Neighbor& n) { visit(n.contact, n.normal, n.j); });
  }

  template <class Visit>
  SCREE_HD void walls(Index i, const Visit& visit) const {
    for (Index k = in.wall_offsets[i]; k < in.wall_offsets[i + 1]; ++k) {
      const WallPlane& wall = in.planes[in.walls[k]];
      const Overlap o = wall_overlap(in.position[i], wall), o0 = wall_overlap(start.position[i], wall);
      if (o.overlap <= 0 && o0.overlap <= 0) continue;
      const KelvinVoigt& law = laws.get(in.material[i], wall.material);
      visit(step_contact<Elastic>(law, start, o0.overlap, rate(o.normal, xyz(start.velocity[i])), o.overlap,
                                  rate(o.normal, xyz(in.velocity[i]))),
            o.normal);
    }
  }
};

// Force, dissipation and Newton matrix row of particle i in an implicit step.
template <class Elastic, class Laws, class Rows>
struct ContactSystemItem {
  StepContacts<Elastic, Laws, Rows> contacts;
  Vec3 gravity;
  NewtonWeights weights;
  StepForces out;
  ContactMatrix matrix;

  SCREE_HD void operator()(Index i) const {
    const Vec3 weight = contacts.in.velocity[i].w * gravity;
    Vec3 step_force = weight, end_force = weight;
    Real step_loss = 0, end_loss = 0, magnitude = norm(weight);
    Index entries = 0;
    std::int64_t slot = contacts.in.rows.first(i);
    Sym3 diagonal;
    const auto add = [&](const StepContact& c, Vec3 normal, Real share) {
      step_force += c.step.force * normal;
      end_force += c.end_force * normal;
      magnitude += std::abs(c.step.force);
      step_loss += share * c.step.loss;
      end_loss += share * c.end_loss;
      const Real s = weights.stiffness * c.step.stiffness + weights.damping * c.step.damping;
      diagonal += outer(s, normal);
      return s;
    };
    contacts.neighbors(i, [&](const StepContact& c, Vec3 normal, Index j) {
      const Real s = add(c, normal, particle_share(j, contacts.in.first_shape));
      matrix.entries[slot] = contact_entry(std::sqrt(s) * normal, j);
      ++entries, slot += Rows::stride();
    });
    contacts.walls(i, [&](const StepContact& c, Vec3 normal) { add(c, normal, 1); });
    out.step_force[i] = step_force, out.end_force[i] = end_force;
    out.step_loss[i] = step_loss, out.end_loss[i] = end_loss;
    out.magnitude[i] = magnitude;
    matrix.count[i] = entries;
    matrix.diagonal[i] = diagonal;
  }
};

// Elastic energy of particle i's share of its contacts, their number, and its share of that number.
template <class Elastic, class Laws, class Rows>
struct ContactEnergyItem {
  ContactViews<Rows> in;
  Laws laws;
  Real* energy;  // [J]
  Index* contacts;
  Real* pairs;  // half of each contact with another particle, all of any other

  SCREE_HD void operator()(Index i) const {
    const Vec4 p = in.position[i];
    Real sum = 0, share = 0;
    Index n = 0;
    in.rows.for_each_contact(
        i, TouchTest{p, in.position}, [](Index j) { return j; },
        [&](Index j) {
          const Overlap o = sphere_overlap(xyz(p) - xyz(in.position[j]), p.w + in.position[j].w);
          const Real own = particle_share(j, in.first_shape);
          sum += own * Elastic::energy(laws.get(in.material[i], in.material[j]), o.overlap);
          share += own;
          ++n;
        });
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
