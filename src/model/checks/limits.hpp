// Contact times and step limits of the model's pairs of materials.
#pragma once

#include <optional>
#include <vector>

#include "model/data/model.hpp"
#include "physics/step_limits.hpp"

namespace scree {

// How far a mesh reaches from the point that its frame is `offset` from [m]; in 2D without z, along
// which lines are deeper than the space.
Real farthest(const ModelMesh& mesh, Vec3 offset, int dimension);

// Extremes of what one material is used for; radius and mass are 0 where it is not used.
struct MaterialUse {
  std::int64_t particles = 0;
  int shapes = 0, meshes = 0, walls = 0;  // meshes: of bodies and walls; walls: planes
  int sheets = 0;                         // of the meshes, those with two sides
  int corners = 0;                        // of the bodies' meshes, those that have corners for planes
  Real smallest_radius = 0;               // [m]
  Real smallest_corner_radius = 0;        // effective, HullCorners::radius [m]
  Real smallest_particle_mass = 0;        // [kg]
  Real smallest_inertia_factor = 0;       // of particles, I / (m R^2)
  // [kg] At a shape: 1 / (1/m + arm^2 / inertia), the arm being the offset where the body is pushed at the
  // shape's centre, and reaching to its far side where its surface is rubbed.
  Real smallest_body_mass = 0, smallest_rubbed_mass = 0;

  bool is_of_surfaces() const { return shapes + meshes + walls > 0; }
  std::int64_t spheres() const { return particles + shapes; }
};

std::vector<MaterialUse> material_uses(const Model& model);
// Whether something of material a can touch something of material b; shapes of bodies that are all connected
// with each other cannot.
bool can_meet(const Model& model, const std::vector<MaterialUse>& uses, int a, int b);
// Whether the deck must have a law for the two: they can meet, but not as meshes of bodies on planes alone,
// which touch only where the deck has a law for them.
bool must_have_law(const Model& model, const std::vector<MaterialUse>& uses, int a, int b);
// Whether bodies can that have something of a and of b.
bool bodies_can_meet(const Model& model, const std::vector<MaterialUse>& uses, int a, int b);
// Whether, of these that can meet, spheres meet sheets and nothing else.
bool meet_on_sheets_alone(const std::vector<MaterialUse>& uses, int a, int b);
// The smallest and the lightest of each material; infinite where it has walls alone. Where neither has
// spheres the radius is that of meshes on planes.
PairSize smallest_partners(const MaterialUse& a, const MaterialUse& b);

struct PairLimit {
  int material[2] = {0, 0};
  KelvinVoigt law;             // of its smallest partners
  Real stiffness = 0;          // of these [N/m], typical_stiffness()
  Real slip_stiffness = 0;     // of the tangential spring [N/m], typical_slip_stiffness()
  Real rolling_stiffness = 0;  // against rolling, over the radius squared [N/m], typical_rolling_stiffness()
  Real contact_time = 0;       // shortest, undamped and head-on [s]
  Real explicit_step = 0;      // stability limit of velocity-verlet in dense contact [s]; 0: no particles
};

// Limits of the bodies' steps beside velocity-verlet particles: how fast a body on its contacts oscillates,
// and which steps follow. Frequencies are 0 where bodies touch nothing.
struct BodyStepLimit {
  Real frequency = 0;       // of the contact that bounds the step most [rad/s]
  Real most_phase = 0;      // that a step may have of it [rad]
  Real good_frequency = 0;  // the fastest, whose phase a good step keeps below kGoodBodyPhase [rad/s]
  bool is_exact = true;     // not estimated, as it is for exponents other than 1

  Real most_step() const { return frequency > 0 ? most_phase / frequency : kInfinity; }                // [s]
  Real good_step() const { return good_frequency > 0 ? kGoodBodyPhase / good_frequency : kInfinity; }  // [s]
};
BodyStepLimit body_step_limit(const Model& model);

// One entry per pair of materials that can meet and interact.
std::vector<PairLimit> pair_limits(const Model& model);
// The pair with the shortest contact time; the one with the smallest explicit step.
std::optional<PairLimit> shortest_contact(const std::vector<PairLimit>& limits);
std::optional<PairLimit> smallest_explicit_step(const std::vector<PairLimit>& limits);

}  // namespace scree
