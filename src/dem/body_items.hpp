// What the surface of a body gets from those of other bodies and from the ground: the small pass of rank 0.
#pragma once

#include "dem/contact_items.hpp"
#include "dem/surface_sums.hpp"
#include "dem/system_items.hpp"

namespace scree {

// Contacts of one surface at an instant, and its share of what is booked of them: half with another body's.
struct BodyLoad {
  InstantSums sums;
  Real loss = 0;    // dissipation [W]
  Real energy = 0;  // elastic [J]
  Real pairs = 0;   // number
};

// Over an implicit step.
struct BodyStep {
  StepSums sums;
  ContactBooks books;
};

// From the side of the body, whose surfaces are the items of this walk: the other one is where the particle
// is in SurfaceLoad.
struct BodyLoadOf {
  struct Found {
    SurfaceLoad contact;
    Vec3 normal;
  };
  template <class Law>
  SCREE_HD Found operator()(const Law& law, const PairState& pair) const {
    auto load = law.normal_load(pair);  // bodies slide on each other without friction
    load = {-load.force, load.loss, load.torque_j, load.torque_i};
    return {{true, load, EnergyOf{}(law, pair), {}, {}}, pair.geometry.normal()};
  }
  template <class Views>
  SCREE_HD const Found* stored(const Views&, Index) const {
    return nullptr;
  }
};

template <class Laws, class Rows>
struct BodyLoadItem {
  ContactWalk<Laws, Rows, AtInstant> walk;
  const Vec3* arm;  // of the surfaces' centres from their bodies' [m]
  BodyLoad* out;

  SCREE_HD void operator()(Index i) const {
    BodyLoad sum;
    const auto self = walk.self(i);
    const auto add = [&](const BodyLoadOf::Found& found, Real share) {
      SurfaceLoad contact = found.contact;
      contact.arm = arm[i] - self.p.w * found.normal;
      sum.sums.add_contact(contact);
      sum.loss += share * contact.load.loss, sum.energy += share * contact.energy.sum, sum.pairs += share;
    };
    walk.neighbors(self, BodyLoadOf{}, [&](const auto& found, Index) { add(found, kPairShare); });
    walk.surfaces(self, BodyLoadOf{}, [&](const auto& found, Index) { add(found, 1); });
    out[i] = sum;
  }
};

template <class Laws, class Rows>
struct BodyStepItem {
  StepWalk<Laws, Rows> walk;
  const Vec3* arm;  // at the end of the step
  BodyStep* out;

  SCREE_HD void operator()(Index i) const {
    BodyStep sum;
    const auto self = walk.self(i);
    const auto add = [&](StepContact contact, Index) {
      contact.normal = -contact.normal;
      sum.sums.add_contact(SurfaceStep{true, contact, {}, arm[i] + self.p.w * contact.normal});
    };
    const StepContactOf of{walk.look.start.resolve_events};
    walk.neighbors(self, of, add);
    walk.surfaces(self, of, add);
    sum.books = books_of(walk, i, kPairShare);
    out[i] = sum;
  }
};

}  // namespace scree
