// Mass, centre of mass and inertia of homogeneous solids and of their compositions.
#pragma once

#include <numbers>
#include <vector>

#include "base/mat3.hpp"
#include "base/types.hpp"
#include "physics/particle_mass.hpp"

namespace scree {

struct MassProperties {
  Real mass = 0;  // [kg]
  Vec3 center;    // of mass [m]
  Sym3 inertia;   // about the centre of mass, along the axes of the parent frame [kg m^2]
};

// Solids of a density [kg/m^3] with their centres at the origin; cylinders and capsules along z.
inline MassProperties solid_sphere(Real density, Real radius) {
  const Real mass = sphere_mass(radius, density), j = moment_of_inertia(Real(0.4), mass, radius);
  return {mass, {}, {j, 0, 0, j, 0, j}};
}
inline MassProperties solid_box(Real density, Vec3 size) {
  const Real mass = density * size.x * size.y * size.z;
  const Real x = size.x * size.x, y = size.y * size.y, z = size.z * size.z;
  return {mass, {}, {mass / 12 * (y + z), 0, 0, mass / 12 * (x + z), 0, mass / 12 * (x + y)}};
}
inline MassProperties solid_cylinder(Real density, Real radius, Real length) {
  const Real mass = disc_mass(radius, length, density), r2 = radius * radius;
  const Real across = mass / 12 * (3 * r2 + length * length);
  return {mass, {}, {across, 0, 0, across, 0, mass / 2 * r2}};
}
// A cylinder of this length with a half sphere on either end, whose centre of mass is 3/8 of the radius from
// its plane: perpendicular to the axis both half spheres have m (2/5 r^2 + l^2/4 + 3/8 r l) about the middle.
inline MassProperties solid_capsule(Real density, Real radius, Real length) {
  MassProperties whole = solid_cylinder(density, radius, length);
  const MassProperties ends = solid_sphere(density, radius);
  const Real across = ends.inertia.xx + ends.mass * (length * length / 4 + Real(3) / 8 * radius * length);
  whole.mass += ends.mass;
  whole.inertia += Sym3{across, 0, 0, across, 0, ends.inertia.zz};
  return whole;
}

// Inertia tensor of a body rotated by a: a J a^T.
inline Sym3 rotated_tensor(const Mat3& a, const Sym3& j) {
  const Mat3 t = a * full(j) * transposed(a);
  return {t.x.x, (t.x.y + t.y.x) / 2, (t.x.z + t.z.x) / 2, t.y.y, (t.y.z + t.z.y) / 2, t.z.z};
}
// Inertia of a point mass at d (Steiner): m (d.d 1 - d d^T).
inline Sym3 point_inertia(Real mass, Vec3 d) {
  return {mass * (d.y * d.y + d.z * d.z), -mass * d.x * d.y, -mass * d.x * d.z,
          mass * (d.x * d.x + d.z * d.z), -mass * d.y * d.z, mass * (d.x * d.x + d.y * d.y)};
}

// Composition of parts in one frame; at least one.
inline MassProperties composed(const std::vector<MassProperties>& parts) {
  MassProperties whole;
  for (const MassProperties& part : parts) whole.mass += part.mass, whole.center += part.mass * part.center;
  whole.center = (1 / whole.mass) * whole.center;
  for (const MassProperties& part : parts) {
    whole.inertia += part.inertia;
    whole.inertia += point_inertia(part.mass, part.center - whole.center);
  }
  return whole;
}

}  // namespace scree
