// Mass properties of meshes: area, enclosed volume, and mass, centre and inertia of the solid or shell.
#pragma once

#include "base/types.hpp"
#include "mesh/triangle_mesh.hpp"
#include "physics/solid_body.hpp"

namespace scree {

// Area [m^2].
Real mesh_area(const TriangleMesh& mesh);
// Volume of a closed mesh [m^3]; negative where its windings are inverted. Sums are taken about the centre
// of the mesh, so that a mesh far from the origin loses no more digits than its coordinates have.
Real mesh_volume(const TriangleMesh& mesh);

// A solid of density [kg/m^3]: a closed mesh of positive volume. By the divergence theorem, exact but for
// round-off; cf. Eberly, Polyhedral Mass Properties (2002).
MassProperties solid_mesh_mass(const TriangleMesh& mesh, Real density);
// A thin shell of mass per area [kg/m^2]: any mesh of positive area.
MassProperties shell_mesh_mass(const TriangleMesh& mesh, Real mass_per_area);

}  // namespace scree
