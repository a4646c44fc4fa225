// The parts of build_model(), in the order in which they run. Each fills its part of the model, adds its
// names, and throws InputError naming place, key, value and what is allowed.
#pragma once

#include "base/log.hpp"
#include "deck/deck.hpp"
#include "model/checks/memory.hpp"
#include "model/data/model.hpp"
#include "model/data/names.hpp"

namespace scree {

void build_materials(const DeckTable& deck, Model& model, ModelNames& names);
void build_meshes(const DeckTable& deck, Model& model, ModelNames& names, Log& log);
// After bodies and walls.
void check_surface_count(const DeckTable& deck, const Model& model);
void build_space(const DeckTable& deck, const ModelNames& names, Model& model);  // also walls
// dimension: of the space.
Wall build_wall(const DeckTable& table, const ModelNames& names, const Space& space);
void build_time(const DeckTable& deck,
                Model& model);  // control and end; also the integrator, as far as named
void build_bodies(const DeckTable& deck, Model& model, ModelNames& names);
void build_markers(const DeckTable& deck, const Model& model, ModelNames& names);
void build_joints(const DeckTable& deck, Model& model, ModelNames& names);  // also drivers
// Each becomes a joint whose length is free, a motor and, with a stroke, a stop; `names` gets the joint.
void build_cylinders(const DeckTable& deck, Model& model, ModelNames& names);
void build_force_elements(const DeckTable& deck, Model& model, const ModelNames& names);
void build_bushings(const DeckTable& deck, Model& model, const ModelNames& names);
void build_joint_forces(const DeckTable& deck, Model& model, const ModelNames& names);  // also couplers
// Warns of files without particles. size: of the bodies; gets the number of particles before any is built.
void build_particles(const DeckTable& deck, Model& model, const ModelNames& names, ModelSize& size,
                     const Share& share, Log& log);
void build_contact(const DeckTable& deck, Model& model, const ModelNames& names);
// The wear of a pair of these two materials.
void take_wear(const DeckTable& pair, Real friction, const int (&material)[2], Contact& contact);
// Of a spring across the normal that the deck leaves out beside a linear stiffness [N/m]: two solid spheres
// that touch swing across it as fast as along it.
inline Real standard_slip_stiffness(Real stiffness) { return Real(2) / 7 * stiffness; }
// After the contacts. integrator.particles = "auto" becomes one or the other, and time.control what goes with
// it; `chosen` gets both.
void choose_integrator(const DeckTable& deck, Model& model, const Share& share,
                       std::vector<ChosenValue>& chosen);
// Refuses what the integrator does not go with.
void check_integrator(const DeckTable& deck, const Model& model);
// An explicit step that is left out is chosen; `chosen` gets it.
void build_steps(const DeckTable& deck, Model& model, const Share& share, std::vector<ChosenValue>& chosen);
void build_output(const DeckTable& deck, const ModelNames& names, Model& model);
void build_surface_fields(const DeckTable& output, Model& model);
void build_history_contacts(const DeckTable& table, const ModelNames& names, Model& model);  // of the output
void build_parallel(const DeckTable& deck, Model& model);

}  // namespace scree
