// What happens for one particle over an implicit step in which contacts rub: forces and torques, Newton
// matrix, energy books. One text for the CPU and CUDA.
#pragma once

#include <cstdint>

#include "base/twist.hpp"
#include "dem/contact_walk.hpp"
#include "dem/step_items.hpp"
#include "dem/system_items.hpp"
#include "physics/step_friction.hpp"

namespace scree {

// Limits of the mean force over the step that stay what they are while it is solved, at the list's slots and
// at the entries of the surfaces [N]; negative: there was no contact. Null: limits follow from the normal
// forces.
struct FrozenLimits {
  Real *neighbors = nullptr, *surfaces = nullptr;
};

struct SurfaceRub;

// Where a step started, and how the particles turn within it; all items.
struct RubbingStart {
  StepStart step;
  const Vec4* spin;       // at the start
  const Vec4* mean_spin;  // over the step
  FrozenLimits frozen;
  const SurfaceRub* on_bodies;  // per entry of the surfaces: what those on bodies do, once it was found
};

// A contact over an implicit step with all that a law with friction sees of it.
struct RubbingPath : ContactPath {
  static constexpr Index kWall = -1;
  ContactMotion motion;
  Real leverage0;
  Vec3 velocity0, velocity1;  // of i relative to j [m/s]
  Vec3 turning;               // R_i times i's turn over the step, and j's likewise; even [m]
  Index i, j;                 // items; j: kWall
  std::int64_t slot;          // of the list, or of the surfaces
  Real frozen_limit = -1;
};

// The look over an implicit step of laws that move; the pair is a RubbingPath.
struct OverRubbingStep {
  RubbingStart start;

  struct Self : OverStep::Self {
    Vec4 mean_spin;
  };
  template <class Rows>
  SCREE_HD Self self(const ContactViews<Rows>& in, Index i) const {
    return {OverStep{start.step}.self(in, i), start.mean_spin[i]};
  }
  // With frozen limits what has parted since then still rubs.
  template <class Rows>
  SCREE_HD auto test(const ContactViews<Rows>& in, const Self& self) const {
    return [&in, &self, this](Index j) {
      return start.frozen.neighbors != nullptr || touch(self.p, in.position[j]) ||
             touch(self.p0, start.step.position[j]);
    };
  }
  template <class Rows>
  SCREE_HD RubbingPath pair(const ContactViews<Rows>& in, const Self& self, Index j) const {
    RubbingPath out{};
    static_cast<ContactPath&>(out) = OverStep{start.step}.pair(in, self, j);
    const Vec4 q = in.position[j];
    const ContactGeometry end = sphere_pair(xyz(self.p) - xyz(q), self.p.w + q.w);
    const TurningPartner one = partner(self.p, self.mean_spin), other = partner(q, start.mean_spin[j]);
    out.motion = sphere_motion(end, out.travel, one, other, start.step.h);
    out.leverage0 = out.motion.leverage * end.distance / (self.p.w + q.w - out.step.overlap0);
    return finish(in, out, one, other, self.i, j);
  }
  template <class Rows>
  SCREE_HD RubbingPath wall(const ContactViews<Rows>& in, const Self& self, const WallPlane& plane) const {
    RubbingPath out{};
    static_cast<ContactPath&>(out) = OverStep{start.step}.wall(in, self, plane);
    const TurningPartner one = partner(self.p, self.mean_spin);
    out.motion = face_motion(wall_pair(self.p, plane), plane.normal, out.travel, one, {}, start.step.h);
    out.leverage0 = 1;
    return finish(in, out, one, {}, self.i, RubbingPath::kWall);
  }
  SCREE_HD void at_slot(RubbingPath& path, std::int64_t slot) const {
    path.slot = slot;
    if (start.frozen.neighbors != nullptr) path.frozen_limit = start.frozen.neighbors[slot];
  }
  SCREE_HD void at_entry(RubbingPath& path, Index entry) const {
    path.slot = entry;
    if (start.frozen.surfaces != nullptr) path.frozen_limit = start.frozen.surfaces[entry];
  }
  SCREE_HD static bool closed(const RubbingPath& path) {
    return OverStep::closed(path) || path.frozen_limit > 0;
  }

 private:
  SCREE_HD static TurningPartner partner(Vec4 p, Vec4 spin) { return {xyz(spin), p.w, spin.w}; }
  template <class Rows>
  SCREE_HD RubbingPath finish(const ContactViews<Rows>& in, RubbingPath out, const TurningPartner& one,
                              const TurningPartner& other, Index i, Index j) const {
    out.turning = start.step.h * (one.arm * one.spin + other.arm * other.spin);
    out.i = i, out.j = j;
    out.velocity0 = xyz(start.step.velocity[i]), out.velocity1 = xyz(in.velocity[i]);
    if (j == RubbingPath::kWall) return out;
    out.velocity0 -= xyz(start.step.velocity[j]), out.velocity1 -= xyz(in.velocity[j]);
    return out;
  }
};

// What the step solves with, of one contact.
struct RubbingContact {
  StepContact normal;
  StepRub rub;
  Vec3 normal0;
  Real leverage0, leverage;
  std::int64_t slot;
  bool acts;   // else nothing above has a meaning
  bool lasts;  // at the end of the step: the history is that of a contact
  ContactHistory history;
};

// How fast both partners turn at one end of a step, each spin times its arm; even [m/s]. Asked where a law
// has a dashpot: turning(start), turning(end).
template <class Law, class Turning>
SCREE_HD RubbingContact rubbing_contact(const Law& law, const RubbingPath& c, const ContactHistory& old,
                                        bool resolve_events, const Turning& turning) {
  RubbingContact out{};
  out.slot = c.slot;
  out.acts = OverRubbingStep::closed(c), out.lasts = c.step.overlap1 > 0;
  if (!out.acts) return out;
  const auto normal = law.normal.of_pair(c.size);
  out.normal = StepContactOf{resolve_events}.of(normal, c);
  out.normal0 = c.normal0, out.leverage0 = c.leverage0, out.leverage = c.motion.leverage;
  const Real start_force =
      c.step.overlap0 > 0 ? contact_force(normal, c.step.overlap0, c.step.rate0).force : 0;
  RubbingStep step{c.step,
                   c.motion,
                   c.leverage0,
                   {},
                   {},
                   c.size,
                   start_force,
                   out.normal.end_force,
                   out.normal.step.force,
                   c.frozen_limit};
  if (law.tangential.damping_ratio > 0) {
    const auto rate = [](Real leverage, Vec3 velocity, Vec3 both, Vec3 across_normal) {
      return across(leverage * velocity - cross(both, across_normal), across_normal);
    };
    step.slip_rate0 = rate(c.leverage0, c.velocity0, turning(false), c.normal0);
    step.slip_rate1 = rate(c.motion.leverage, c.velocity1, turning(true), c.normal1);
  }
  out.rub = step_rub(law, step, old.spring);
  out.history.spring = out.rub.spring;
  return out;
}

struct RubbingContactOf {
  RubbingStart start;
  const Vec4* spin;  // at the end

  template <class Law>
  SCREE_HD RubbingContact operator()(const Law& law, const RubbingPath& c, const ContactHistory& old) const {
    return rubbing_contact(law, c, old, start.step.resolve_events, [&](bool at_end) {
      const Vec4* spins = at_end ? spin : start.spin;
      Vec3 turning = c.motion.arm_i * xyz(spins[c.i]);
      if (c.j != RubbingPath::kWall) turning = turning + c.motion.arm_j * xyz(spins[c.j]);
      return turning;
    });
  }
  template <class Views>
  SCREE_HD const RubbingContact* stored(const Views&, Index entry) const;
};

// What it adds to the energy ledger, and the history.
struct RubbingBooks : ContactBooks {
  Real friction;  // of what is dissipated [J]
  bool acts, lasts;
  ContactHistory history;
};
template <class Law>
SCREE_HD RubbingBooks rubbing_books(const Law& law, const RubbingPath& c, const RubbingContact& at,
                                    bool resolve_events) {
  if (!at.acts) return {{}, 0, false, false, {}};
  RubbingBooks out{StepBooksOf{{resolve_events}}(law, c), 0, true, at.lasts, at.history};
  const StepRub& rub = at.rub;
  const Vec3 force = at.leverage0 * rub.start + at.leverage * rub.step;
  const Vec3 moment = cross(c.normal0, rub.start) + cross(c.normal1, rub.step);
  const Real work = Real(0.5) * (dot(moment, c.turning) - dot(force, c.travel));
  const Real lost = rub.losses.sum();
  out.dissipated += lost, out.integrator += (rub.stored0 - rub.stored1) - work - lost;
  out.friction = lost;
  return out;
}

struct RubbingBooksOf {
  RubbingContactOf contact;

  template <class Law>
  SCREE_HD RubbingBooks operator()(const Law& law, const RubbingPath& c, const ContactHistory& old) const {
    return rubbing_books(law, c, contact(law, c, old), contact.start.step.resolve_events);
  }
  template <class Views>
  SCREE_HD const RubbingBooks* stored(const Views&, Index entry) const;
};

// One contact of a particle with a surface on a body over the step; evaluated once, for both.
struct SurfaceRub {
  bool touches;  // else nothing below has a meaning
  RubbingContact contact;
  RubbingBooks books;
  Vec3 arm;     // from the body's centre to the surface's, at the end [m]
  Real radius;  // of the surface [m]
};

template <class Views>
SCREE_HD const RubbingContact* RubbingContactOf::stored(const Views&, Index entry) const {
  const SurfaceRub& at = start.on_bodies[entry];
  return at.touches ? &at.contact : nullptr;
}
template <class Views>
SCREE_HD const RubbingBooks* RubbingBooksOf::stored(const Views&, Index entry) const {
  const SurfaceRub& at = contact.start.on_bodies[entry];
  return at.touches ? &at.books : nullptr;
}

template <class Laws, class Rows>
using RubbingWalk = ContactWalk<Laws, Rows, OverRubbingStep>;

// One contact in the Newton matrix. In single precision, as ContactEntry.
struct RubbingEntry {
  struct alignas(16) Normal {
    float x, y, z;
    Index neighbor;  // j; of a surface on a body its number among these; RubbingPath::kWall of the ground
  };
  struct alignas(16) Slide {
    float x, y, z;  // its direction, or zero
    float along;    // of the overlap [kg]
  };
  struct alignas(8) Shear {
    float across;  // of the slip across the direction [kg]
    float grip;    // along the direction, of the overlap [kg]
  };
  Normal normal;
  Slide slide;
  Shear shear;

  // What was found for an entry turned out to be no contact.
  static constexpr Index kNone = -2;
  SCREE_HD bool is_contact() const { return normal.neighbor != kNone; }

  // Force on i, and its torque over the radius, by how the partners move against each other and both turn.
  SCREE_HD Twist pull(Vec3 apart, Vec3 turning, bool with_grip) const {
    const Vec3 n{normal.x, normal.y, normal.z}, t{slide.x, slide.y, slide.z};
    const Real approach = dot(n, apart);
    const Vec3 slip = apart - approach * n - cross(turning, n);
    Vec3 force = Real(shear.across) * (slip - dot(t, slip) * t);
    if (with_grip) force -= (Real(shear.grip) * approach) * t;
    return {(Real(slide.along) * approach) * n + force, -cross(n, force)};
  }
  // Its symmetric part in the block of i.
  SCREE_HD void add_to(Block6& block) const {
    const Vec3 n{normal.x, normal.y, normal.z}, t{slide.x, slide.y, slide.z}, c = cross(n, t);
    const Real k = shear.across, slides = dot(t, t);
    block.move += outer(slide.along, n);
    if (slides > Real(0.5)) {  // one direction is left: c, and the turn about t goes with it
      block.move += outer(k, c), block.turn += outer(k, t), block.mixed += outer(k, c, t);
      return;
    }
    Sym3 plane = outer(-k, n);
    plane += Sym3{k, 0, 0, k, 0, k};
    block.move += plane, block.turn += plane;
    block.mixed += Mat3{{0, -k * n.z, k * n.y}, {k * n.z, 0, -k * n.x}, {-k * n.y, k * n.x, 0}};
  }
};

// Entries with their parts in arrays of their own: a warp reads whole lines.
struct RubbingEntries {
  RubbingEntry::Normal* normal;
  RubbingEntry::Slide* slide;
  RubbingEntry::Shear* shear;

  SCREE_HD RubbingEntry operator[](std::int64_t slot) const {
    return {normal[slot], slide[slot], shear[slot]};
  }
  SCREE_HD void put(std::int64_t slot, const RubbingEntry& entry) const {
    normal[slot] = entry.normal, slide[slot] = entry.slide, shear[slot] = entry.shear;
  }
  SCREE_HD void put_none(std::int64_t slot) const { normal[slot].neighbor = RubbingEntry::kNone; }
};

// Array: std::vector, or its like on a device.
template <template <class...> class Array>
struct RubbingEntryArrays {
  Array<RubbingEntry::Normal> normal;
  Array<RubbingEntry::Slide> slide;
  Array<RubbingEntry::Shear> shear;

  void resize(std::size_t n) { normal.resize(n), slide.resize(n), shear.resize(n); }
  RubbingEntries views() { return {normal.data(), slide.data(), shear.data()}; }
};

// Entries of contacts with neighbours stand at the list's slots, packed to the front of a row, with some that
// are none among them; those with surfaces at their entries, likewise, contacts all of them.
struct RubbingMatrix {
  Index *count, *surface_count;
  RubbingEntries entries;
  RubbingEntry* surface_entries;

  // take(entry) of particle i's contacts with neighbours; the next one is under way meanwhile.
  template <class Rows, class Take>
  SCREE_HD void for_each_entry(const Rows& rows, Index i, const Take& take) const {
    std::int64_t slot = rows.first(i);
    Index left = count[i];
    if (left == 0) return;
    RubbingEntry next = entries[slot];
    while (left > 0) {
      const RubbingEntry entry = next;
      slot += Rows::stride();
      if (--left > 0) next = entries[slot];
      if (entry.is_contact()) take(entry);
    }
  }
};

// Inertia in the Newton matrix, with hht_inertia_weight: mass, and moment of inertia over R^2 [kg].
struct ScaledMass {
  Real move, turn;
};

// Of the particles' rotation; forces: see StepForces.
struct StepTorques {
  Vec3 *start, *step, *end;  // about the centre [N m]
};

// What contacts add to the forces on one of their particles; moments over its radius.
struct RubbingSums {
  Vec3 step_force, end_force;            // [N]
  Vec3 start_turn, step_turn, end_turn;  // [N]
  Real magnitude = 0;                    // [N]

  SCREE_HD static RubbingSums of(const RubbingContact& c) {
    const Vec3 n = c.normal.normal;
    return {c.normal.step.force * n - c.leverage * c.rub.step,
            c.normal.end_force * n - c.leverage * c.rub.end,
            cross(c.normal0, c.rub.start),
            cross(n, c.rub.step),
            cross(n, c.rub.end),
            std::abs(c.normal.step.force) + norm(c.rub.step)};
  }
  // Of no contact: adding it changes no bit, that of a zero's sign included.
  SCREE_HD static RubbingSums nothing() {
    constexpr Real z = -0.0;
    constexpr Vec3 zero{z, z, z};
    return {zero, zero, zero, zero, zero, z};
  }
  SCREE_HD RubbingSums& operator+=(const RubbingSums& part) {
    step_force += part.step_force, end_force += part.end_force;
    start_turn += part.start_turn, step_turn += part.step_turn, end_turn += part.end_turn;
    magnitude += part.magnitude;
    return *this;
  }
};

// Force, torque and Newton matrix row of particle i.
template <class Laws, class Rows>
struct RubbingSystemItem {
  RubbingWalk<Laws, Rows> walk;
  Vec3 gravity;
  NewtonWeights weights;
  StepForces out;
  StepTorques torques;
  RubbingMatrix matrix;
  // Largest 2 K h^2 / m of the contacts that item i has evaluated, with shared rows those of other particles:
  // what counts is the largest of all.
  Real* sharpness;

  using Self = typename RubbingWalk<Laws, Rows>::Self;
  struct Total {
    RubbingSums sums;
    Real sharpest = 0;
    Index entries = 0;  // in the row of the matrix
  };

  SCREE_HD void operator()(Index i) const {
    const Self self = walk.self(i);
    Total total = weight(self);
    add_neighbors(self, total);
    finish(self, total);
  }

  // Its parts, in this order.
  SCREE_HD Total weight(const Self& self) const {
    const Vec3 force = walk.in.velocity[self.i].w * gravity;
    return {{force, force, {}, {}, {}, norm(force)}};
  }
  SCREE_HD_CALLER
  SCREE_HD void add_neighbors(const Self& self, Total& total) const {
    if constexpr (kShared<Rows>) {
      total.entries = walk.in.rows.sum_contacts(self.i, walk.look.test(walk.in, self),
                                                SharedContact{*this, total.sharpest}, total.sums);
    } else {
      walk.neighbors(self, contact_of(), [&](const RubbingContact& c, Index j) {
        total.sums += take(c, self.i, j, total.entries++, total.sharpest);
      });
    }
  }
  SCREE_HD void finish(const Self& self, Total& total) const {
    const Index i = self.i;
    RubbingSums& sums = total.sums;
    Index surfaces = 0;
    walk.surfaces(self, contact_of(), [&](const RubbingContact& c, Index surface) {
      sums += RubbingSums::of(c), sharpen(c, i, total.sharpest);
      const Index on_body = surface < walk.in.ground ? RubbingPath::kWall : surface - walk.in.ground;
      matrix.surface_entries[walk.in.surface_offsets[i] + surfaces++] = entry_of(c, on_body);
    });
    const Real radius = walk.in.position[i].w;
    matrix.count[i] = total.entries, matrix.surface_count[i] = surfaces;
    out.step_force[i] = sums.step_force, out.end_force[i] = sums.end_force;
    out.magnitude[i] = sums.magnitude;
    torques.start[i] = radius * sums.start_turn, torques.step[i] = radius * sums.step_turn;
    torques.end[i] = radius * sums.end_turn;
    sharpness[i] = total.sharpest;
  }

 private:
  // Evaluates contacts of any row; k: counts those of the row.
  struct SharedContact {
    const RubbingSystemItem& item;
    Real& sharpest;

    SCREE_HD RubbingSums operator()(Index i, Index j, std::int64_t slot, Index k) const {
      return item.take(item.walk.contact_at(item.contact_of(), i, j, slot), i, j, k, sharpest);
    }
    SCREE_HD void prepare(std::int64_t slot) const { item.walk.prepare(slot); }
  };

  SCREE_HD RubbingContactOf contact_of() const { return {walk.look.start, walk.in.spin}; }
  // The k-th contact found in row i becomes an entry of the matrix. Returns what it adds.
  SCREE_HD RubbingSums take(const RubbingContact& c, Index i, Index j, Index k, Real& sharpest) const {
    const std::int64_t slot = walk.in.rows.first(i) + static_cast<std::int64_t>(k) * Rows::stride();
    if (!c.acts) {
      matrix.entries.put_none(slot);
      return RubbingSums::nothing();
    }
    matrix.entries.put(slot, entry_of(c, j)), sharpen(c, i, sharpest);
    return RubbingSums::of(c);
  }
  SCREE_HD void sharpen(const RubbingContact& c, Index i, Real& sharpest) const {
    const Real h = walk.look.start.step.h;
    const Real sharp = 2 * c.normal.step.stiffness * h * h / walk.in.velocity[i].w;
    sharpest = sharp > sharpest ? sharp : sharpest;
  }
  SCREE_HD RubbingEntry entry_of(const RubbingContact& c, Index j) const {
    const auto single = [](Real x) { return static_cast<float>(x); };
    const Vec3 n = c.normal.normal, t = c.rub.direction;
    const Real along = weights.of(c.normal.step);
    return {{single(n.x), single(n.y), single(n.z), j},
            {single(t.x), single(t.y), single(t.z), single(along)},
            {single(weights.stiffness * c.rub.stiffness), single(c.rub.grip * along)}};
  }
};

// Where the books of an implicit step in which contacts rub go; friction: of contact [J].
struct RubbingBooksTo {
  Real *contact, *integrator, *friction;
};

// Books particle i's share of its contacts over an accepted step, and stores what they remember.
template <class Laws, class Rows>
struct RubbingBooksItem {
  RubbingWalk<Laws, Rows> walk;
  RubbingBooksTo to;

  SCREE_HD void operator()(Index i) const {
    ContactBooks sum;
    Real friction = 0;
    const auto self = walk.self(i);
    const RubbingBooksOf of{{walk.look.start, walk.in.spin}};
    walk.template neighbors<true>(self, of, [&](const RubbingBooks& one, Index) {
      if (one.acts) sum.add(one, kPairShare), friction += kPairShare * one.friction;
    });
    walk.template surfaces<true>(
        self, of, [&](const RubbingBooks& one, Index) { sum.add(one, 1), friction += one.friction; });
    to.contact[i] += sum.dissipated, to.integrator[i] += sum.integrator, to.friction[i] += friction;
  }
};

// Keeps the limits of particle i's contacts at the iterate, those that are frozen already included.
template <class Laws, class Rows>
struct FreezeItem {
  RubbingWalk<Laws, Rows> walk;
  FrozenLimits to;

  SCREE_HD void operator()(Index i) const {
    const auto self = walk.self(i);
    const RubbingContactOf of{walk.look.start, walk.in.spin};
    walk.neighbors(self, of, [&](const RubbingContact& c, Index) {
      if (c.acts) to.neighbors[c.slot] = c.rub.limit;
    });
    walk.surfaces(self, of, [&](const RubbingContact& c, Index) { to.surfaces[c.slot] = c.rub.limit; });
  }
};

}  // namespace scree
