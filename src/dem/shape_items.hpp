// What happens for one shape of a body in the contact stages. One text for the CPU and CUDA.
#pragma once

#include "base/exact_sum.hpp"
#include "dem/contact_items.hpp"

namespace scree {

// Sums over contacts that are the same bits in any order and over any split of the contacts over ranks.
struct ExactVec3 {
  ExactSum x, y, z;

  SCREE_HD void add(Vec3 v) { x.add(v.x), y.add(v.y), z.add(v.z); }
  SCREE_HD void add(const ExactVec3& part) { x.add(part.x), y.add(part.y), z.add(part.z); }
  Vec3 value() const { return {x.value(), y.value(), z.value()}; }
};

struct ExactSym3 {
  ExactSum xx, xy, xz, yy, yz, zz;

  SCREE_HD void add(const Sym3& m) {
    xx.add(m.xx), xy.add(m.xy), xz.add(m.xz), yy.add(m.yy), yz.add(m.yz), zz.add(m.zz);
  }
  SCREE_HD void add(const ExactSym3& part) {
    xx.add(part.xx), xy.add(part.xy), xz.add(part.xz), yy.add(part.yy), yz.add(part.yz), zz.add(part.zz);
  }
  Sym3 value() const { return {xx.value(), xy.value(), xz.value(), yy.value(), yz.value(), zz.value()}; }
};

// What crosses the ranks of the contacts of one shape. Every contact force passes through the shape's centre.
// What every reader wants comes first.
struct ShapeForces {  // of no meaning without contacts
  std::int64_t contacts = 0;
  ExactVec3 end;                 // at the end of the step, or at an instant [N]
  ExactVec3 step;                // for the step, of its contacts alone: see StepContact [N]
  ExactSym3 stiffness, damping;  // -d(force)/d(position), -d(force)/d(velocity) of the centre [N/m], [N s/m]

  SCREE_HD void add(const ShapeForces& part) {
    step.add(part.step), end.add(part.end), stiffness.add(part.stiffness), damping.add(part.damping);
    contacts += part.contacts;
  }
};

// What the contacts of one shape item of a body sum to. The energies are those of contacts with other shapes
// and with walls alone, which one rank sees.
struct ShapeContact {
  Real loss = 0;    // at an instant: the shape's share of the dissipation [W]
  Real energy = 0;  // the shape's share of the contacts' elastic energy [J]
  Real pairs = 0;   // the shape's share of the number of contacts
  ShapeForces forces;
};

// What the contacts of shapes are found for: an instant, or an implicit step.
enum class ContactSpan { instant, step };

// Puts a sum where it belongs, but for what has no meaning: the forces of a shape that touches nothing, like
// most, and at an instant what is a step's. A GPU writes this to the host's memory.
SCREE_HD void store(ContactSpan span, const ShapeContact& sum, ShapeContact& out) {
  out.loss = sum.loss, out.energy = sum.energy, out.pairs = sum.pairs;
  out.forces.contacts = sum.forces.contacts;
  if (sum.forces.contacts == 0) return;
  if (span == ContactSpan::step)
    out.forces = sum.forces;
  else
    out.forces.end = sum.forces.end;
}

// Where the shape items are, indexed from first_shape.
struct ShapePlaces {
  const Vec4* position;  // x, y, z, radius
  const Vec4* velocity;
};

// Particles book the energies of their contacts with shapes; shapes among each other half each.
SCREE_HD Real shape_share(Index j, Index first_shape) { return j < first_shape ? Real(0) : Real(0.5); }

// Contacts of a shape item over an implicit step.
template <class Elastic, class Laws, class Rows>
struct ShapeStepItem {
  StepContacts<Laws, Rows> contacts;
  ShapeContact* out;  // [shape items], indexed from first_shape

  SCREE_HD void operator()(Index shape) const {
    const Index i = contacts.in.first_shape + shape;
    ShapeContact sum;
    const auto of = [&](const KelvinVoigt& law, const ContactPath& c) {
      return step_contact<Elastic>(law, contacts.start, c);
    };
    const auto add = [&](const StepContact& c) {
      sum.forces.step.add(c.step.force * c.normal);
      sum.forces.end.add(c.end_force * c.normal);
      sum.forces.stiffness.add(outer(c.step.stiffness, c.normal));
      sum.forces.damping.add(outer(c.step.damping, c.normal));
      ++sum.forces.contacts;
    };
    contacts.neighbors(i, of, [&](const StepContact& c, Index) { add(c); });
    contacts.walls(i, of, add);
    store(ContactSpan::step, sum, out[shape]);
  }
};

// Of a row, the entries that are shapes.
template <class Rows>
struct ShapesOfRows {
  Rows rows;
  Index first_shape;

  template <class Touches, class Evaluate, class Add>
  SCREE_HD void for_each_contact(Index i, const Touches& touches, const Evaluate& evaluate,
                                 const Add& add) const {
    rows.for_each_contact(
        i, [&](Index j) { return j >= first_shape && touches(j); }, evaluate, add);
  }
};

template <class Rows>
ContactViews<ShapesOfRows<Rows>> with_shapes_alone(const ContactViews<Rows>& in) {
  return {in.position,     in.velocity, in.material, {in.rows, in.first_shape},
          in.wall_offsets, in.walls,    in.planes,   in.first_shape};
}

// What a shape item's own share of its contacts adds to the energy ledger over an accepted step.
template <class Elastic, class Laws, class Rows>
struct ShapeBooksItem {
  StepContacts<Laws, ShapesOfRows<Rows>> contacts;
  ContactBooks* out;  // [shape items], indexed from first_shape

  SCREE_HD void operator()(Index shape) const {
    const Index first_shape = contacts.in.first_shape;
    out[shape] = books_of<Elastic>(contacts, first_shape + shape,
                                   [&](Index j) { return shape_share(j, first_shape); });
  }
};

// Contacts of a shape item at one instant. The shapes may be elsewhere than in the arrays of all items.
template <class Elastic, class Laws, class Rows>
struct ShapeContactItem {
  ContactViews<Rows> in;
  ShapePlaces shapes;
  Laws laws;
  ShapeContact* out;  // [shape items], indexed from first_shape

  SCREE_HD Vec4 position(Index j) const {
    return j < in.first_shape ? in.position[j] : shapes.position[j - in.first_shape];
  }
  SCREE_HD Vec4 velocity(Index j) const {
    return j < in.first_shape ? in.velocity[j] : shapes.velocity[j - in.first_shape];
  }

  SCREE_HD void add(ShapeContact& sum, const KelvinVoigt& law, const Overlap& o, Real rate,
                    Real share) const {
    const ContactForce c = contact_force<Elastic>(law, o.overlap, rate);
    sum.forces.end.add(c.force * o.normal);
    sum.loss += share * c.loss;
    sum.energy += share * Elastic::energy(law, o.overlap);
    sum.pairs += share;
    ++sum.forces.contacts;
  }

  SCREE_HD void operator()(Index shape) const {
    const Index i = in.first_shape + shape;
    const Vec4 p = position(i), u = velocity(i);
    ShapeContact sum;
    in.rows.for_each_contact(
        i, [&](Index j) { return touch(p, position(j)); }, [](Index j) { return j; },
        [&](Index j) {
          const Vec4 q = position(j);
          const Overlap o = sphere_overlap(xyz(p) - xyz(q), p.w + q.w);
          const Real rate = -dot(o.normal, xyz(u) - xyz(velocity(j)));
          add(sum, laws.get(in.material[i], in.material[j]), o, rate, shape_share(j, in.first_shape));
        });
    for (Index k = in.wall_offsets[i]; k < in.wall_offsets[i + 1]; ++k) {
      const WallPlane& wall = in.planes[in.walls[k]];
      const Overlap o = wall_overlap(p, wall);
      if (o.overlap > 0) add(sum, laws.get(in.material[i], wall.material), o, -dot(o.normal, xyz(u)), 1);
    }
    store(ContactSpan::instant, sum, out[shape]);
  }
};

}  // namespace scree
