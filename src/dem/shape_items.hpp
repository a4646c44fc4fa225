// What happens for one shape of a body in the contact stages. One text for the CPU and CUDA.
#pragma once

#include "base/exact_sum.hpp"
#include "dem/system_items.hpp"

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
template <class Laws, class Rows>
struct ShapeStepItem {
  StepWalk<Laws, Rows> walk;
  ShapeContact* out;  // [shape items], indexed from first_shape

  SCREE_HD void operator()(Index shape) const {
    ShapeContact sum;
    const auto add = [&](const StepContact& c, Index) {
      sum.forces.step.add(c.step.force * c.normal);
      sum.forces.end.add(c.end_force * c.normal);
      sum.forces.stiffness.add(outer(c.step.stiffness, c.normal));
      sum.forces.damping.add(outer(c.step.damping, c.normal));
      ++sum.forces.contacts;
    };
    const auto self = walk.self(walk.in.first_shape + shape);
    const StepContactOf of{walk.look.start.resolve_events};
    walk.neighbors(self, of, add);
    walk.walls(self, of, add);
    store(ContactSpan::step, sum, out[shape]);
  }
};

// What a shape item's own share of its contacts adds to the energy ledger over an accepted step: of those
// with other shapes and with walls.
template <class Laws, class Rows>
struct ShapeBooksItem {
  StepWalk<Laws, Rows> walk;
  ContactBooks* out;  // [shape items], indexed from first_shape

  SCREE_HD void operator()(Index shape) const {
    const Index first_shape = walk.in.first_shape;
    out[shape] = books_of(
        walk, first_shape + shape, [&](Index j) { return walk.in.is_shape(j); },
        [&](Index j) { return shape_share(j, first_shape); });
  }
};

// The look at one instant of shapes that may be elsewhere than in the arrays of all items.
struct AtShapePlaces : AtInstant {
  ShapePlaces shapes;

  template <class Rows>
  SCREE_HD Vec4 position(const ContactViews<Rows>& in, Index j) const {
    return in.is_shape(j) ? shapes.position[j - in.first_shape] : in.position[j];
  }
  template <class Rows>
  SCREE_HD Vec4 velocity(const ContactViews<Rows>& in, Index j) const {
    return in.is_shape(j) ? shapes.velocity[j - in.first_shape] : in.velocity[j];
  }
  template <class Rows>
  SCREE_HD Self self(const ContactViews<Rows>& in, Index i) const {
    return {i, in.material[i], position(in, i), velocity(in, i)};
  }
  template <class Rows>
  SCREE_HD auto test(const ContactViews<Rows>& in, const Self& self) const {
    return [&in, &self, this](Index j) { return touch(self.p, position(in, j)); };
  }
  template <class Rows>
  SCREE_HD PairState pair(const ContactViews<Rows>& in, const Self& self, Index j) const {
    return AtInstant::pair(self, position(in, j), velocity(in, j));
  }
};

// What a contact does to a shape at an instant.
struct ShapeLoad {
  Vec3 force;   // [N]
  Real loss;    // of the whole contact [W]
  Real energy;  // elastic, of the whole contact [J]
};

struct ShapeLoadOf {
  template <class Law>
  SCREE_HD ShapeLoad operator()(const Law& law, const PairState& pair) const {
    const auto normal_law = law.normal.of_pair(pair.size);
    const Vec3 normal = pair.geometry.normal();
    const Real overlap = pair.geometry.overlap;
    const ContactForce c = contact_force(normal_law, overlap, -dot(normal, pair.velocity));
    return {c.force * normal, c.loss, normal_law.energy(overlap)};
  }
};

// Contacts of a shape item at one instant.
template <class Laws, class Rows>
struct ShapeContactItem {
  ContactWalk<Laws, Rows, AtShapePlaces> walk;
  ShapeContact* out;  // [shape items], indexed from first_shape

  SCREE_HD void operator()(Index shape) const {
    const Index first_shape = walk.in.first_shape;
    ShapeContact sum;
    const auto add = [&](const ShapeLoad& load, Real share) {
      sum.forces.end.add(load.force);
      sum.loss += share * load.loss;
      sum.energy += share * load.energy;
      sum.pairs += share;
      ++sum.forces.contacts;
    };
    const auto self = walk.self(first_shape + shape);
    walk.neighbors(self, ShapeLoadOf{},
                   [&](const ShapeLoad& load, Index j) { add(load, shape_share(j, first_shape)); });
    walk.walls(self, ShapeLoadOf{}, [&](const ShapeLoad& load, Index) { add(load, 1); });
    store(ContactSpan::instant, sum, out[shape]);
  }
};

}  // namespace scree
