// Contact times and step limits of the model's pairs of materials.
#pragma once

#include <optional>
#include <vector>

#include "model/data/model.hpp"
#include "physics/contact_geometry.hpp"
#include "physics/contact_parameters.hpp"

namespace scree {

// Largest distance of a mesh from the point relative to which its frame has this `offset` [m]; in 2D without
// z, along which lines extend beyond the domain.
Real farthest(const ModelMesh& mesh, Vec3 offset, int dimension);

// Extreme values of the objects of one material; radius and mass are 0 where there are none.
struct MaterialUse {
  std::int64_t particles = 0;
  int shapes = 0, meshes = 0, walls = 0;  // meshes: of bodies and walls; walls: planes
  int sheets = 0;                         // number of the meshes that are open surfaces
  int corners = 0;                   // number of the bodies' meshes with vertices for contact with planes
  Real smallest_radius = 0;          // [m]
  Real smallest_corner_radius = 0;   // effective radius, HullCorners::radius [m]
  Real smallest_particle_mass = 0;   // [kg]
  Real smallest_inertia_factor = 0;  // of particles, I / (m R^2)
  // Smallest effective mass at a shape, 1 / (1/m + arm^2 / inertia) [kg]. The arm is the offset of the shape
  // for a normal force at its centre, and extends to its far side for friction at its surface.
  Real smallest_body_mass = 0, smallest_frictional_mass = 0;

  bool is_of_surfaces() const { return shapes + meshes + walls > 0; }
  std::int64_t spheres() const { return particles + shapes; }
};

std::vector<MaterialUse> material_uses(const Model& model);
// Whether objects of materials a and b can touch. Shapes of bodies that are all connected with each other
// cannot.
bool can_touch(const Model& model, const std::vector<MaterialUse>& uses, int a, int b);
// Whether the deck must have a law for the two materials: they can meet, and not only as meshes of bodies on
// planes, which touch only where the deck has a law.
bool must_have_law(const Model& model, const std::vector<MaterialUse>& uses, int a, int b);
// Whether bodies with material a and bodies with material b can touch.
bool bodies_can_touch(const Model& model, const std::vector<MaterialUse>& uses, int a, int b);
// Whether the only contacts of these two materials are those of spheres with open surfaces.
bool touch_open_surfaces_only(const std::vector<MaterialUse>& uses, int a, int b);
// The smallest and lightest objects of each material; infinite where it has only walls. Where neither has
// spheres, the radius is that of meshes on planes.
PairSize smallest_partners(const MaterialUse& a, const MaterialUse& b);

struct PairLimit {
  int material[2] = {0, 0};
  NormalLawParameters law;  // law of its smallest partners
  Real stiffness = 0;       // of these partners [N/m], typical_stiffness()
  Real slip_stiffness = 0;  // of the tangential spring [N/m], typical_slip_stiffness()
  Real rolling_stiffness =
      0;                   // of the rolling spring over the radius squared [N/m], typical_rolling_stiffness()
  Real contact_time = 0;   // shortest, undamped and head-on [s]
  Real explicit_step = 0;  // stability limit of velocity-verlet in dense contact [s]; 0: no particles
  // Of these partners, by the law's own parameters.
  Real sticking_speed = 0;        // undamped impacts below it stick; 0: none do [m/s]
  Real longest_step = kInfinity;  // OwnParameters::longest_step() [s]
};

// Limits of the bodies' steps beside velocity-verlet particles, from the oscillation of bodies on their
// contacts. Frequencies are 0 where bodies touch nothing.
struct BodyStepLimit {
  Real frequency = 0;       // of the contact with the smallest step limit [rad/s]
  Real most_phase = 0;      // largest phase of this contact per step [rad]
  Real good_frequency = 0;  // highest frequency; a good step keeps its phase below kGoodBodyPhase [rad/s]
  bool is_exact = true;     // false: estimated, for exponents other than 1

  Real most_step() const { return frequency > 0 ? most_phase / frequency : kInfinity; }  // [s]
  Real good_step() const;                                                                // [s]
};
BodyStepLimit body_step_limit(const Model& model);

// One entry per pair of materials that can meet and interact.
std::vector<PairLimit> pair_limits(const Model& model);
// shortest_contact: the pair with the shortest contact time. The other: the pair with the smallest explicit
// step.
std::optional<PairLimit> shortest_contact(const std::vector<PairLimit>& limits);
std::optional<PairLimit> smallest_explicit_step(const std::vector<PairLimit>& limits);

}  // namespace scree
