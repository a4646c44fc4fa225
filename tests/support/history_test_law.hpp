// A law with history, for tests: it stores for each contact its overlaps of all earlier steps, fading, the
// number of steps in contact, and sums. The history acts on the force, so that a run shows where it is lost.
#pragma once

#include "physics/contact_law.hpp"
#include "physics/normal_laws.hpp"

namespace scree {

SCREE_HD Vec3 as_double(Vec3 a) { return a; }
SCREE_HD Vec3 as_double(Vec3f a) { return in_double(a); }
SCREE_HD void add_force(Vec3& force, Vec3 more) { force += more; }
SCREE_HD void add_force(Vec3f& force, Vec3 more) {
  force = {force.x + static_cast<float>(more.x), force.y + static_cast<float>(more.y),
           force.z + static_cast<float>(more.z)};
}

// kNumbers: 3 to 8.
template <int kNumbers>
struct HistoryTestLaw : ContactLaw<LinearLaw> {
  static constexpr int kHistory = kNumbers;
  struct History {
    Vec3 overlaps;  // along the normal, fading: odd under exchange of the partners
    Real rest[kNumbers - 3 + (kNumbers == 3)]{};  // the number of steps first, which is even
  };
  template <class Load>
  struct Outcome {
    Load load;
    History history;

    SCREE_HD TangentialLosses losses() const { return {}; }
  };

  explicit HistoryTestLaw(const NormalLawParameters& pair) : ContactLaw<LinearLaw>{LinearLaw(pair)} {}

  // history: after the last step, and after this one. overlap: along the normal.
  SCREE_HD static void remember(Vec3 overlap, History& history) {
    constexpr Real kFading = 0.96875;
    history.overlaps = kFading * history.overlaps + overlap;
    for (int k = 0; k < kNumbers - 3; ++k) history.rest[k] += k == 0 ? Real(1) : k * overlap.x + overlap.y;
  }
  template <class T, class Vector>
  SCREE_HD Outcome<ContactLoadOf<T, Vector>> respond(const PairStateOf<T, Vector>& pair,
                                                     const History& old) const {
    constexpr Real kShare = 0.015625;
    Outcome<ContactLoadOf<T, Vector>> out{ContactLaw<LinearLaw>::respond(pair, {}).load, old};
    remember(as_double(pair.geometry.along(pair.geometry.overlap)), out.history);
    add_force(out.load.force, (kShare * normal.normal_stiffness) * out.history.overlaps);
    return out;
  }
  SCREE_HD ContactEnergy energy_of(const PairState& pair, const History&) const {
    return ContactLaw<LinearLaw>::energy_of(pair, {});
  }

  template <class Number>
  SCREE_HD static History read_history(const Number& number) {
    History history{{number(0), number(1), number(2)}};
    for (int k = 3; k < kNumbers; ++k) history.rest[k - 3] = number(k);
    return history;
  }
  template <class Store>
  SCREE_HD static void write_history(const History& history, const Store& store) {
    store(0, history.overlaps.x), store(1, history.overlaps.y), store(2, history.overlaps.z);
    for (int k = 3; k < kNumbers; ++k) store(k, history.rest[k - 3]);
  }
};

}  // namespace scree
