// Contacts of the shapes of bodies with each other and with surfaces: a small pass on rank 0 with shapes as
// items.
#pragma once

#include <type_traits>

#include "dem/contact/contact_items.hpp"
#include "dem/contact/system_items.hpp"
#include "dem/surface_contact/friction_surfaces.hpp"
#include "dem/surfaces/surface_sums.hpp"

namespace scree {

// Contacts of one shape at an instant, or over the explicit step that ends there, with its share of their
// energies: half of a contact with another body's shape.
struct BodyLoad {
  InstantSums sums;
  Real loss = 0;              // dissipation [W]
  Real energy = 0;            // elastic [J]
  Real pairs = 0;             // number of contacts
  SpringEnergies springs;     // parts of the energy, with friction
  Real cohesion = 0;          // part of the energy [J]
  TangentialLosses losses{};  // parts of the dissipation, over the step [J]
};

// Contacts of one shape over an implicit step.
struct BodyStep {
  StepSums sums;
  ContactLosses losses;
  TangentialLosses tangential{};  // parts of the dissipation [J]
  Index partners = 0;             // shapes of other bodies in contact
};

// Derivatives of a contact force with respect to the motion of its partners, over an implicit step.
struct ContactSlopes {
  Vec3 normal, direction;   // unit vectors; direction: of sliding, else zero
  Real stiffness, damping;  // normal [N/m], [N s/m]
  Real shear;               // tangential, perpendicular to `direction` [N/m]
  StepRolling rolling{};    // of laws with rolling resistance
};

// Contact of a shape with that of another body. other: item.
struct ShapeContact {
  Index other;
  ContactSlopes slopes;
};

// Where the walk over the shapes writes their contacts with each other: those of item i begin where its row
// begins.
struct ShapeContactsTo {
  const Index* offsets;
  ShapeContact* contacts;

  SCREE_HD void put(Index i, BodyStep& sum, const ShapeContact& contact) const {
    contacts[offsets[i] + sum.partners] = contact;
    ++sum.partners;
  }
};

SCREE_HD ContactSlopes slopes_of(const StepContact& c) {
  return {c.normal, {}, c.step.stiffness, c.step.damping, 0, {}};
}

// Load on the body of a shape. In `SurfaceLoad` the other partner takes the role of the particle.
struct EvaluateBodyLoad {
  struct Found {
    SurfaceLoad contact;
    Vec3 normal;
  };
  template <class Law, class Pair>
  SCREE_HD auto operator()(const Law& law, const Pair& pair, const typename Law::History& old) const {
    const auto outcome = law.respond(pair, old);
    const SurfaceLoad contact{true, outcome.load.exchanged(), energy_of(law, pair, old, outcome.history), {},
                              {},   outcome.losses()};
    return LoadWithHistory<Found, decltype(outcome.history)>{{contact, pair.geometry.normal()},
                                                             outcome.history};
  }
  // A contact with a surface that was evaluated before, from the surface's side.
  template <class Views>
  SCREE_HD const SurfaceLoad* stored(const Views& in, Index entry) const {
    return in.loads[entry].touches ? &in.loads[entry] : nullptr;
  }

 private:
  // A contact that has opened in the step has losses only.
  template <class Law, class Pair, class History>
  SCREE_HD static ContactEnergy energy_of(const Law& law, const Pair& pair, const typename Law::History& old,
                                          const History& now) {
    if constexpr (kHasRange<Law>)
      if (!law.closed(pair, old)) return {};
    if constexpr (std::is_same_v<Pair, MovingPair>)
      return EvaluateEnergy{}(law, pair, now);
    else
      return EvaluateEnergy{}(law, pair, old);
  }
};

// Loads of the shapes; over a step the history is stored.
template <class Laws, class Rows, class Kinematics>
struct BodyLoadItem {
  ContactWalk<Laws, Rows, Kinematics> walk;
  const Vec3* arm;
  BodyLoad* out;

  static constexpr bool kAccepts = std::is_same_v<Kinematics, OverExplicitStep>;

  SCREE_HD void operator()(Index i) const {
    BodyLoad sum;
    const auto self = walk.self(i);
    walk.template neighbors<kAccepts>(
        self, EvaluateBodyLoad{}, [&](const EvaluateBodyLoad::Found& found, Index) {
          add(found.contact, application_point(i, self.p.w, found.normal), kPairShare, sum);
        });
    walk.template surfaces<kAccepts>(self, EvaluateBodyLoad{}, [&](const auto& found, Index) {
      if constexpr (std::is_same_v<decltype(found), const SurfaceLoad&>)
        add(from_surface(found), arm[i], 1, sum);
      else
        add(found.contact, application_point(i, self.p.w, found.normal), 1, sum);
    });
    out[i] = sum;
  }

 private:
  // Application point of the force, from the body's centre; laws with `kNeedsMotion` act at the shape's
  // centre with a couple.
  SCREE_HD Vec3 application_point(Index i, Real radius, Vec3 normal) const {
    return LawOf<Laws>::kNeedsMotion ? arm[i] : arm[i] - radius * normal;
  }
  SCREE_HD static SurfaceLoad from_surface(SurfaceLoad contact) {
    contact.load = contact.load.exchanged(), contact.belt_power = 0;
    return contact;
  }
  SCREE_HD static void add(SurfaceLoad contact, Vec3 point, Real share, BodyLoad& sum) {
    contact.arm = point;
    sum.sums.add_contact(contact);
    sum.loss += share * contact.load.loss, sum.energy += share * contact.energy.sum, sum.pairs += share;
    if constexpr (kMayBeCohesive<typename LawOf<Laws>::Normal>)
      sum.cohesion += share * contact.energy.cohesion;
    if constexpr (!LawOf<Laws>::kNeedsMotion) return;
    sum.springs.add(contact.energy.springs, share);
    contact.by_kind.scale(share), sum.losses.add(contact.by_kind);
  }
};

template <class Laws, class Rows>
struct BodyStepItem {
  StepWalk<Laws, Rows> walk;
  const Vec3* arm;  // at the end of the step
  BodyStep* out;
  ShapeContactsTo to;

  SCREE_HD void operator()(Index i) const {
    BodyStep sum;
    const auto self = walk.self(i);
    const auto add = [&](StepContact contact, Real share) {
      sum.losses.add(contact.losses, share);
      contact.normal = -contact.normal;
      sum.sums.add_contact(SurfaceStep{true, contact, arm[i] + self.p.w * contact.normal});
    };
    const RespondOverStep<true> of{walk.kinematics.start.resolve_events};
    walk.neighbors(self, of, [&](const StepContact& contact, Index j) {
      add(contact, kPairShare);
      to.put(i, sum, {j, slopes_of(contact)});
    });
    walk.surfaces(self, of, [&](const StepContact& contact, Index) { add(contact, 1); });
    out[i] = sum;
  }
};

SCREE_HD ContactSlopes slopes_of(const FrictionalContact& c) {
  ContactSlopes slopes = slopes_of(c.normal);
  slopes.direction = c.friction.direction, slopes.shear = c.friction.stiffness;
  return slopes;
}
SCREE_HD ContactSlopes slopes_of(const RollingFrictionalContact& c) {
  ContactSlopes slopes = slopes_of(static_cast<const FrictionalContact&>(c));
  slopes.rolling = c.rolling;
  return slopes;
}
SCREE_HD ContactSlopes slopes_of(const SurfaceFriction& c) {
  return c.rolls ? slopes_of(c.contact) : slopes_of(static_cast<const FrictionalContact&>(c.contact));
}
SCREE_HD ContactSlopes slopes_of(const SurfaceStep& c) { return slopes_of(c.contact); }

template <class Laws, class Rows>
struct BodyFrictionItem {
  FrictionWalk<Laws, Rows> walk;
  const Vec3* arm;  // at the end of the step
  BodyStep* out;
  ShapeContactsTo to;

  static constexpr bool kRolls = LawOf<Laws>::Rolling::acts;
  using Contact = FrictionalContactOf<LawOf<Laws>>;

  SCREE_HD void operator()(Index i) const {
    BodyStep sum;
    const auto self = walk.self(i);
    const RespondWithFriction<true> of{walk.kinematics.start, walk.in.spin};
    const auto add = [&](const auto& found, Real share) {
      if (!found.acts) return;
      SurfaceFriction contact{};
      contact.touches = true, contact.rolls = kRolls, contact.arm = arm[i], contact.radius = self.p.w;
      static_cast<Contact&>(contact.contact) = from_surface(found);
      sum.sums.add_contact(contact);
      sum.losses.add(found.losses, share);
      TangentialLosses by_kind = found.losses.by_kind;
      by_kind.scale(share), sum.tangential.add(by_kind);
    };
    walk.template neighbors<true>(self, of, [&](const auto& found, Index j) {
      add(found, kPairShare);
      if (found.acts) to.put(i, sum, {j, slopes_of(found)});
    });
    walk.template surfaces<true>(self, of, [&](const auto& found, Index) { add(found, 1); });
    out[i] = sum;
  }

 private:
  // The contact from the surface's side: quantities that are odd under exchange change sign.
  SCREE_HD static Contact from_surface(Contact c) {
    c.normal.normal = -c.normal.normal, c.normal0 = -c.normal0;
    c.friction.start = -c.friction.start, c.friction.step = -c.friction.step,
    c.friction.end = -c.friction.end;
    if constexpr (kRolls) {
      StepRolling& m = c.rolling;
      m.start = -m.start, m.step = -m.step, m.end = -m.end;
    }
    return c;
  }
};

}  // namespace scree
