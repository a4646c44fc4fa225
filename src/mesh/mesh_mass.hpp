// What meshes weigh: their area, the volume that they enclose, and mass, centre and inertia of what they
// stand for.
#pragma once

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"
#include "physics/solid_body.hpp"

namespace scree {

// [m^2]
Real mesh_area(const TriangleMesh& mesh);
// [m^3], of a closed mesh; below 0 where its windings look inwards. Sums are taken about the middle of the
// mesh, so that a mesh far from the origin loses no more digits than its coordinates have.
Real mesh_volume(const TriangleMesh& mesh);

// Filled, of density [kg/m^3]: a closed mesh of positive volume. By the divergence theorem, exact but for
// round-off; cf. Eberly, Polyhedral Mass Properties (2002).
MassProperties solid_mesh_mass(const TriangleMesh& mesh, Real density);
// A skin of mass per area [kg/m^2]: any mesh of positive area.
MassProperties shell_mesh_mass(const TriangleMesh& mesh, Real mass_per_area);

}  // namespace scree
