// What happens for one particle or one body shape in the contact stages. One text for the CPU and CUDA.
#pragma once

#include <cstdint>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "model/body_exchange.hpp"
#include "physics/contact_books.hpp"
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

// On an item at p with velocity u by item j, which it touches.
template <class Elastic, class Laws, class Rows>
SCREE_HD PairForce pair_force(const ContactViews<Rows>& in, const Laws& laws, Vec4 p, Vec4 u, int material,
                              Index j) {
  const Vec4 q = in.position[j];
  const Vec3 r = xyz(p) - xyz(q);
  const Gap gap = sphere_gap(dot(r, r), p.w + q.w);
  const Real rate = approach_rate(r, gap.inverse_distance, xyz(u) - xyz(in.velocity[j]));
  const ContactForce c = contact_force<Elastic>(laws.get(material, in.material[j]), gap.overlap, rate);
  return {(c.force * gap.inverse_distance) * r, c.loss, j >= in.first_shape};
}

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
    const auto evaluate = [&](Index j) { return pair_force<Elastic>(in, laws, p, u, material, j); };
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

// One contact over an implicit step, as it lies between its two partners.
struct ContactPath {
  ContactStep step;
  Vec3 normal0, normal1;  // at its start and its end
  Vec3 travel;            // of i relative to j [m]
};

// What the step solves with.
struct StepContact {
  StepContactForce step;  // what the step's end must hold for the step to be right: see step_contact_force
  Real end_force;         // at the end itself [N]
  Vec3 normal;            // there
};

template <class Elastic>
SCREE_HD StepContact step_contact(const KelvinVoigt& law, const StepStart& start, const ContactPath& c) {
  const ContactForce end = c.step.overlap1 > 0 ? contact_force<Elastic>(law, c.step.overlap1, c.step.rate1)
                                               : ContactForce{0, 0, 0, 0};
  if (!start.resolve_events) return {{end.force, end.stiffness, end.damping}, end.force, c.normal1};
  return {step_contact_force<Elastic>(law, c.step), end.force, c.normal1};
}

// What it adds to the energy ledger.
template <class Elastic>
SCREE_HD ContactBooks step_books(const KelvinVoigt& law, const StepStart& start, const ContactPath& c) {
  const Real force0 =
      c.step.overlap0 > 0 ? contact_force<Elastic>(law, c.step.overlap0, c.step.rate0).force : 0;
  const Real force1 = step_contact<Elastic>(law, start, c).step.force;
  return contact_books<Elastic>(law, c.step,
                                Real(0.5) * dot(force0 * c.normal0 + force1 * c.normal1, c.travel));
}

// Visits the contacts of item i over a step: visit(of(law, ContactPath)[, partner]).
template <class Laws, class Rows>
struct StepContacts {
  ContactViews<Rows> in;
  Laws laws;
  StepStart start;

  SCREE_HD static Real rate(Vec3 normal, Vec3 relative_velocity) { return -dot(normal, relative_velocity); }

  template <class Of, class Visit>
  SCREE_HD void neighbors(Index i, const Of& of, const Visit& visit) const {
    const Vec4 p = in.position[i], p0 = start.position[i];
    struct Neighbor {
      decltype(of(laws.get(0, 0), ContactPath{})) contact;
      Index j;
    };
    const auto evaluate = [&](Index j) {
      const Vec4 q = in.position[j];
      const Real reach = p.w + q.w;
      const Vec3 r = xyz(p) - xyz(q), r0 = xyz(p0) - xyz(start.position[j]);
      const Overlap o = sphere_overlap(r, reach), o0 = sphere_overlap(r0, reach);
      const ContactStep step{o0.overlap, rate(o0.normal, xyz(start.velocity[i]) - xyz(start.velocity[j])),
                             o.overlap, rate(o.normal, xyz(in.velocity[i]) - xyz(in.velocity[j])), start.h};
      return Neighbor{of(laws.get(in.material[i], in.material[j]), {step, o0.normal, o.normal, r - r0}), j};
    };
    in.rows.for_each_contact(
        i, [&](Index j) { return touch(p, in.position[j]) || touch(p0, start.position[j]); }, evaluate,
        [&](const Neighbor& n) { visit(n.contact, n.j); });
  }

  template <class Of, class Visit>
  SCREE_HD void walls(Index i, const Of& of, const Visit& visit) const {
    for (Index k = in.wall_offsets[i]; k < in.wall_offsets[i + 1]; ++k) {
      const WallPlane& wall = in.planes[in.walls[k]];
      const Vec4 p = in.position[i], p0 = start.position[i];
      const Overlap o = wall_overlap(p, wall), o0 = wall_overlap(p0, wall);
      if (o.overlap <= 0 && o0.overlap <= 0) continue;
      const ContactStep step{o0.overlap, rate(o.normal, xyz(start.velocity[i])), o.overlap,
                             rate(o.normal, xyz(in.velocity[i])), start.h};
      visit(of(laws.get(in.material[i], wall.material), {step, o.normal, o.normal, xyz(p) - xyz(p0)}));
    }
  }
};

// Force and Newton matrix row of particle i in an implicit step.
template <class Elastic, class Laws, class Rows>
struct ContactSystemItem {
  StepContacts<Laws, Rows> contacts;
  Vec3 gravity;
  NewtonWeights weights;
  StepForces out;
  ContactMatrix matrix;

  SCREE_HD void operator()(Index i) const {
    const Vec3 weight = contacts.in.velocity[i].w * gravity;
    Vec3 step_force = weight, end_force = weight;
    Real magnitude = norm(weight);
    Index entries = 0;
    std::int64_t slot = contacts.in.rows.first(i);
    Sym3 diagonal;
    const auto of = [&](const KelvinVoigt& law, const ContactPath& c) {
      return step_contact<Elastic>(law, contacts.start, c);
    };
    const auto add = [&](const StepContact& c) {
      step_force += c.step.force * c.normal;
      end_force += c.end_force * c.normal;
      magnitude += std::abs(c.step.force);
      const Real s = weights.stiffness * c.step.stiffness + weights.damping * c.step.damping;
      diagonal += outer(s, c.normal);
      return s;
    };
    contacts.neighbors(i, of, [&](const StepContact& c, Index j) {
      const Real s = add(c);
      matrix.entries[slot] = contact_entry(std::sqrt(s) * c.normal, j);
      ++entries, slot += Rows::stride();
    });
    contacts.walls(i, of, add);
    out.step_force[i] = step_force, out.end_force[i] = end_force;
    out.magnitude[i] = magnitude;
    matrix.count[i] = entries;
    matrix.diagonal[i] = diagonal;
  }
};

// What the contacts of item i over a step add to the energy ledger, those with item j by share(j).
template <class Elastic, class Contacts, class Share>
SCREE_HD ContactBooks books_of(const Contacts& contacts, Index i, const Share& share) {
  ContactBooks sum;
  const auto of = [&](const KelvinVoigt& law, const ContactPath& c) {
    return step_books<Elastic>(law, contacts.start, c);
  };
  contacts.neighbors(i, of, [&](const ContactBooks& one, Index j) { sum.add(one, share(j)); });
  contacts.walls(i, of, [&](const ContactBooks& one) { sum.add(one, 1); });
  return sum;
}

// Books particle i's share of its contacts over an accepted step.
template <class Elastic, class Laws, class Rows>
struct ContactBooksItem {
  StepContacts<Laws, Rows> contacts;
  Real *contact_loss, *integrator_loss;  // [J]

  SCREE_HD void operator()(Index i) const {
    const Index first_shape = contacts.in.first_shape;
    const ContactBooks sum =
        books_of<Elastic>(contacts, i, [&](Index j) { return particle_share(j, first_shape); });
    contact_loss[i] += sum.dissipated, integrator_loss[i] += sum.integrator;
  }
};

// Over the contacts of a particle, each with its weight.
struct TouchSums {
  Real energy = 0;  // elastic [J]
  Real share = 0;   // sum of the weights
  Index contacts = 0;
};

// share(j): the weight of a contact with item j; those with walls count in full.
template <class Elastic, class Laws, class Rows, class Share>
SCREE_HD TouchSums touch_sums(const ContactViews<Rows>& in, const Laws& laws, Index i, const Share& share) {
  const Vec4 p = in.position[i];
  TouchSums sum;
  const auto add = [&](const KelvinVoigt& law, Real overlap, Real weight) {
    sum.energy += weight * Elastic::energy(law, overlap);
    sum.share += weight;
    ++sum.contacts;
  };
  in.rows.for_each_contact(
      i, TouchTest{p, in.position}, [](Index j) { return j; },
      [&](Index j) {
        const Overlap o = sphere_overlap(xyz(p) - xyz(in.position[j]), p.w + in.position[j].w);
        add(laws.get(in.material[i], in.material[j]), o.overlap, share(j));
      });
  for (Index k = in.wall_offsets[i]; k < in.wall_offsets[i + 1]; ++k) {
    const WallPlane& wall = in.planes[in.walls[k]];
    const Overlap o = wall_overlap(p, wall);
    if (o.overlap > 0) add(laws.get(in.material[i], wall.material), o.overlap, 1);
  }
  return sum;
}

// Elastic energy of particle i's share of its contacts, their number, and its share of that number.
template <class Elastic, class Laws, class Rows>
struct ContactEnergyItem {
  ContactViews<Rows> in;
  Laws laws;
  Real* energy;  // [J]
  Index* contacts;
  Real* pairs;  // half of each contact with another particle, all of any other

  SCREE_HD void operator()(Index i) const {
    const TouchSums sum =
        touch_sums<Elastic>(in, laws, i, [&](Index j) { return particle_share(j, in.first_shape); });
    energy[i] = sum.energy;
    contacts[i] = sum.contacts;
    pairs[i] = sum.share;
  }
};

}  // namespace scree
