// Explicit steps in mixed precision between two builds of the neighbour list: state and sums have about
// double precision, contact forces single precision. The committed state is in double precision.
#pragma once

#include <cmath>
#include <cstdint>

#include "base/hd.hpp"
#include "base/types.hpp"
#include "base/vec3.hpp"
#include "dem/contact/contact_items.hpp"
#include "partition/subdomain.hpp"
#include "physics/time_stepping.hpp"

namespace scree {

// Fixed-point position in quanta modulo 2^32: the difference of two nearby positions is exact. This part is
// read by other particles.
struct alignas(16) FixedPointPosition {
  std::uint32_t x, y, z;
  float radius;  // [m]
};

// Velocity that the contact law uses, and mass. This part is read by other particles.
struct alignas(16) MixedMotion {
  float x, y, z;  // [m/s]
  float mass;     // [kg]
};

// Fraction of the position in units of 2^-16 quantum. This part is not read by other particles.
struct alignas(8) MixedFraction {
  std::uint16_t x, y, z;
  std::uint16_t near_open_side;  // whether the particle may escape from the domain before the list expires
};

// Mid-step velocity less the one that the law uses: so small that single precision resolves it far below the
// last bit of the velocity.
struct alignas(16) MixedRest {
  float x, y, z;  // [m/s]
  float loss;     // dissipated since the last conversion [J]
};

// Mid-step angular velocity, and moment of inertia. This part is read by other particles.
struct alignas(16) MixedSpin {
  float x, y, z;  // [rad/s]
  float inertia;  // [kg m^2]
};

// Remainder of the angular velocity beyond single precision.
struct alignas(16) MixedSpinRest {
  float x, y, z;   // [rad/s]
  float friction;  // frictional dissipation since the last conversion [J]
};

struct MixedViews {
  FixedPointPosition* position[2];  // all items; double-buffered: a step reads one and writes the other
  MixedMotion* motion[2];
  MixedFraction* fraction;  // owned particles
  MixedRest* rest;
  MixedSpin* spin[2];        // all items; null where particles do not rotate
  MixedSpinRest* spin_rest;  // owned particles; null where particles do not rotate
};

// Grid of quanta for pairs up to `reach` [m] apart; differences wrap at eight times that distance.
struct QuantumGrid {
  Real quantum = 1;                         // power of two [m]
  Real fraction = 1, inverse_fraction = 1;  // 2^-16 of it

  SCREE_HD std::int64_t count(Real x) const {
    return static_cast<std::int64_t>(std::rint(x * inverse_fraction));
  }
  // Position that has moved from x to these low bits.
  SCREE_HD Real moved(Real x, std::uint32_t low_bits, std::uint16_t part) const {
    const std::int64_t from = count(x);
    const auto whole = static_cast<std::int32_t>(low_bits - static_cast<std::uint32_t>(from >> 16));
    const std::int64_t parts = static_cast<std::int64_t>(part) - (from & 0xffff);
    return static_cast<Real>(from + whole * std::int64_t{65536} + parts) * fraction;
  }
};

// Position displaced by dx [m]; rest: its fraction, updated.
SCREE_HD FixedPointPosition moved_by(const QuantumGrid& grid, Vec3 dx, FixedPointPosition position,
                                     MixedFraction& rest) {
  const auto move = [&](std::uint32_t& whole, std::uint16_t& part, Real by) {
    const std::int64_t parts = part + grid.count(by);
    whole += static_cast<std::uint32_t>(parts >> 16);
    part = static_cast<std::uint16_t>(parts & 0xffff);
  };
  move(position.x, rest.x, dx.x), move(position.y, rest.y, dx.y), move(position.z, rest.z, dx.z);
  return position;
}

inline QuantumGrid make_quantum_grid(Real range) {
  int exponent = 0;
  std::frexp(range, &exponent);
  const Real quantum = std::ldexp(Real(1), exponent - 28);
  return {quantum, std::ldexp(quantum, -16), std::ldexp(1 / quantum, 16)};
}

SCREE_HD FixedPointPosition fixed_point_position(const QuantumGrid& grid, Vec4 p) {
  return {static_cast<std::uint32_t>(grid.count(p.x) >> 16),
          static_cast<std::uint32_t>(grid.count(p.y) >> 16),
          static_cast<std::uint32_t>(grid.count(p.z) >> 16), static_cast<float>(p.w)};
}

// Position shifted by whole periods.
SCREE_HD FixedPointPosition shifted(const QuantumGrid& grid, FixedPointPosition position, Vec3 shift) {
  // Rounded alike in both directions: two particles see each other at opposite differences.
  const auto whole = [&](Real x) { return static_cast<std::uint32_t>((grid.count(x) + 32768) >> 16); };
  position.x += whole(shift.x), position.y += whole(shift.y), position.z += whole(shift.z);
  return position;
}

// Double-precision position of a particle that was at `from` when it was converted [m].
SCREE_HD Vec3 mixed_position(const QuantumGrid& grid, Vec4 from, const FixedPointPosition& position,
                             const MixedFraction& part) {
  return {grid.moved(from.x, position.x, part.x), grid.moved(from.y, position.y, part.y),
          grid.moved(from.z, position.z, part.z)};
}

// Position of p relative to q [m].
SCREE_HD Vec3f mixed_difference(float quantum, const FixedPointPosition& p, const FixedPointPosition& q) {
  const auto along = [](std::uint32_t a, std::uint32_t b) {
    return static_cast<float>(static_cast<std::int32_t>(a - b));
  };
  return quantum * Vec3f{along(p.x, q.x), along(p.y, q.y), along(p.z, q.z)};
}

// `TouchTest` for fixed-point positions.
struct MixedTouchTest {
  FixedPointPosition p;
  const FixedPointPosition* position;  // all items
  float quantum;                       // [m]
  SCREE_HD bool operator()(Index j) const { return near(j, 0); }
  SCREE_HD bool near(Index j, Real margin) const {
    const FixedPointPosition q = position[j];
    const Vec3f r = mixed_difference(quantum, p, q);
    const float distance = p.radius + q.radius + static_cast<float>(margin);
    return dot(r, r) < distance * distance;
  }
};

// Converts the double-precision state of an open explicit step.
struct ToMixedItem {
  const Vec4 *position, *velocity, *spin;  // null unless particles rotate; then both are mid-step values
  const Vec3* acceleration;
  MixedViews out;
  QuantumGrid grid;
  OpenBox box;
  Real h, half_skin;

  SCREE_HD void operator()(Index i) const {
    const Vec4 p = position[i], v = velocity[i];
    const Vec3f law_velocity = in_single(xyz(v));
    out.position[0][i] = fixed_point_position(grid, p);
    out.motion[0][i] = {law_velocity.x, law_velocity.y, law_velocity.z, static_cast<float>(v.w)};
    const auto part = [&](Real x) { return static_cast<std::uint16_t>(grid.count(x) & 0xffff); };
    out.fraction[i] = {part(p.x), part(p.y), part(p.z),
                       static_cast<std::uint16_t>(box.inside(xyz(p), 2 * half_skin) ? 0 : 1)};
    const Vec3 middle = spin != nullptr ? xyz(v) : verlet_middle_velocity(h, xyz(v), acceleration[i]);
    const Vec3f rest = in_single(middle - in_double(law_velocity));
    out.rest[i] = {rest.x, rest.y, rest.z, 0};
    if (spin != nullptr) {
      const Vec4 w = spin[i];
      const Vec3f single = in_single(xyz(w));
      out.spin[0][i] = {single.x, single.y, single.z, static_cast<float>(w.w)};
      const Vec3f left = in_single(xyz(w) - in_double(single));
      out.spin_rest[i] = {left.x, left.y, left.z, 0};
    }
  }
};

// Converts back to the double-precision state. position, velocity: as converted `steps` ago.
struct FromMixedItem {
  MixedViews in;
  int parity;
  QuantumGrid grid;
  Vec4 *position, *velocity, *spin;    // null unless particles rotate
  Vec3* acceleration;                  // unused where particles rotate
  Real *contact_loss, *friction_loss;  // friction_loss: null unless particles rotate
  const std::uint8_t* drifting;
  Vec3 gravity;
  Real h;
  Index steps;

  SCREE_HD void operator()(Index i) const {
    if (drifting[i]) return move_ballistically(i);
    const MixedMotion u = (parity == 0 ? in.motion[0] : in.motion[1])[i];
    const FixedPointPosition fixed_position = (parity == 0 ? in.position[0] : in.position[1])[i];
    const MixedRest rest = in.rest[i];
    const Vec3 law_velocity{u.x, u.y, u.z}, middle = law_velocity + Vec3{rest.x, rest.y, rest.z};
    // A velocity that is not finite must be visible in the position, which is always finite in fixed point.
    const Vec3 x =
        is_finite(middle) ? mixed_position(grid, position[i], fixed_position, in.fraction[i]) : middle;
    position[i] = vec4(x, position[i].w);
    contact_loss[i] += rest.loss;
    if (spin != nullptr) {
      velocity[i] = vec4(middle, velocity[i].w);
      take_spin(i);
      return;
    }
    velocity[i] = vec4(law_velocity, velocity[i].w);
    acceleration[i] = verlet_acceleration(h, law_velocity, middle);
  }

 private:
  SCREE_HD void take_spin(Index i) const {
    const MixedSpin w = (parity == 0 ? in.spin[0] : in.spin[1])[i];
    const MixedSpinRest rest = in.spin_rest[i];
    spin[i] = vec4(Vec3{w.x, w.y, w.z} + Vec3{rest.x, rest.y, rest.z}, spin[i].w);
    friction_loss[i] += rest.friction;
  }
  // Escaped particles are not covered by a list and may move beyond the range of fixed-point positions; they
  // move under gravity alone.
  SCREE_HD void move_ballistically(Index i) const {
    if (steps == 0) return;
    const Vec4 p = position[i], v = velocity[i];
    const Vec3 first = spin != nullptr ? xyz(v) : verlet_middle_velocity(h, xyz(v), acceleration[i]);
    const Vec3 last = verlet_middle_after(steps, h, first, gravity);
    position[i] = vec4(xyz(p) + verlet_displacement_of(steps, h, first, gravity), p.w);
    velocity[i] = vec4(spin != nullptr ? last : verlet_predicted_from_middle(h, last, gravity), v.w);
    if (spin == nullptr) acceleration[i] = gravity;
  }
};

// Kinematics at fixed-point positions: pairs of particles in single precision; walls, which need the whole
// position, in double precision.
struct AtMixedInstant {
  const FixedPointPosition* position;  // all items
  const MixedMotion* motion;
  const MixedFraction* fraction;
  QuantumGrid grid;

  struct Self {
    Index i;
    int material;
    FixedPointPosition p;
    MixedMotion u;
  };
  template <class Rows>
  SCREE_HD Self self(const ContactViews<Rows>& in, Index i) const {
    return {i, in.material[i], position[i], motion[i]};
  }
  template <class Rows>
  SCREE_HD MixedTouchTest test(const ContactViews<Rows>&, const Self& self) const {
    return {self.p, position, static_cast<float>(grid.quantum)};
  }
  template <class Rows>
  SCREE_HD PairStateOf<float, Vec3f> pair(const ContactViews<Rows>&, const Self& self, Index j) const {
    const FixedPointPosition p = self.p, q = position[j];
    const MixedMotion u = self.u, w = motion[j];
    const Vec3f r = mixed_difference(static_cast<float>(grid.quantum), p, q);
    return {sphere_pair(r, p.radius + q.radius),
            {u.x - w.x, u.y - w.y, u.z - w.z},
            {p.radius, q.radius, u.mass, w.mass}};
  }
  // in.position: as converted.
  template <class Rows>
  SCREE_HD PairState wall(const ContactViews<Rows>& in, const Self& self, const WallPlane& plane) const {
    const Vec4 from = in.position[self.i];
    const Vec4 x = vec4(mixed_position(grid, from, self.p, fraction[self.i]), from.w);
    const MixedMotion u = self.u;
    return {wall_pair(x, plane), Vec3{u.x, u.y, u.z}, wall_size(from.w, u.mass)};
  }
  SCREE_HD static bool closed(const PairState& pair) { return pair.geometry.overlap > 0; }
};

// The load alone: with all of the response a GPU would spill more registers.
struct RespondWithLoad {
  template <class Law, class Pair>
  SCREE_HD auto operator()(const Law& law, const Pair& pair, const typename Law::History& old) const {
    const auto outcome = law.respond(pair, old);
    return LoadWithHistory<decltype(outcome.load), decltype(outcome.history)>{outcome.load, outcome.history};
  }
  template <class Views>
  SCREE_HD const ContactLoadOf<Real, Vec3>* stored(const Views& in, Index entry) const {
    return in.loads[entry].touches ? &in.loads[entry].load : nullptr;
  }
};

// Closes a step and opens the next. Returns the square of the displacement.
template <class Laws, class Rows>
struct MixedAdvanceItem {
  ContactViews<Rows> in;  // position: as converted; velocity is not used
  Laws laws;
  Vec3 gravity;
  MixedViews state;
  int parity;
  QuantumGrid grid;
  Real h;

  SCREE_HD Real operator()(Index i) const {
    const ContactWalk<Laws, Rows, AtMixedInstant> walk{
        in, laws, {positions(), motions(), state.fraction, grid}};
    const auto self = walk.self(i);
    const Real mass = self.u.mass;
    Vec3 f = mass * gravity;
    float loss = 0;
    walk.template neighbors<true>(self, RespondWithLoad{}, [&](const auto& load, Index) {
      f += in_double(load.force);
      loss += 0.5f * load.loss;
    });
    walk.template surfaces<true>(self, RespondWithLoad{}, [&](const auto& load, Index) {
      f += load.force;
      loss += static_cast<float>(load.loss);
    });
    return advance(i, self.p, self.u, reciprocal(mass) * f, loss);
  }

 private:
  // No indexing by parity: a GPU would copy the arrays of pointers to local memory.
  SCREE_HD FixedPointPosition* positions() const {
    return parity == 0 ? state.position[0] : state.position[1];
  }
  SCREE_HD MixedMotion* motions() const { return parity == 0 ? state.motion[0] : state.motion[1]; }

  SCREE_HD Real advance(Index i, const FixedPointPosition& p, const MixedMotion& u, Vec3 a,
                        float loss) const {
    const MixedRest rest = state.rest[i];
    const Vec3 old_middle = Vec3{u.x, u.y, u.z} + Vec3{rest.x, rest.y, rest.z};
    const Vec3 middle = verlet_next_middle(h, old_middle, a), dx = h * middle;
    const Vec3f law_velocity = in_single(verlet_predicted_from_middle(h, middle, a));
    const Vec3f new_rest = in_single(middle - in_double(law_velocity));
    MixedFraction part = state.fraction[i];
    (parity == 0 ? state.position[1] : state.position[0])[i] = moved_by(grid, dx, p, part);
    state.fraction[i] = part;
    (parity == 0 ? state.motion[1] : state.motion[0])[i] = {law_velocity.x, law_velocity.y, law_velocity.z,
                                                            u.mass};
    state.rest[i] = {new_rest.x, new_rest.y, new_rest.z, rest.loss + static_cast<float>(h) * loss};
    return dot(dx, dx);
  }
};

}  // namespace scree
