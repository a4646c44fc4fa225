// The parts of build_model(), in the order in which they run. Each builds its part of the model, adds its
// names, and throws InputError with place, key, value and the allowed values.
#pragma once

#include "base/log.hpp"
#include "deck/deck.hpp"
#include "model/checks/memory.hpp"
#include "model/data/model.hpp"
#include "model/data/names.hpp"

namespace scree {

void build_materials(const DeckTable& deck, Model& model, ModelNames& names);
void build_meshes(const DeckTable& deck, Model& model, ModelNames& names, Log& log);
// Called after bodies and walls are built.
void check_surface_count(const DeckTable& deck, const Model& model);
void build_space(const DeckTable& deck, const ModelNames& names, Model& model);  // also walls
// dimension: of the domain.
Wall build_wall(const DeckTable& table, const ModelNames& names, const Space& space);
// Control and end; also the integrator where the deck names it.
void build_time(const DeckTable& deck, Model& model);
void build_bodies(const DeckTable& deck, Model& model, ModelNames& names);
void build_markers(const DeckTable& deck, const Model& model, ModelNames& names);
void build_joints(const DeckTable& deck, Model& model, ModelNames& names);  // also drivers
// Each cylinder becomes a joint with a free length, a motor and, with a stroke, a stop. The joint is added to
// `names`.
void build_cylinders(const DeckTable& deck, Model& model, ModelNames& names);
void build_force_elements(const DeckTable& deck, Model& model, const ModelNames& names);
void build_bushings(const DeckTable& deck, Model& model, const ModelNames& names);
void build_joint_forces(const DeckTable& deck, Model& model, const ModelNames& names);  // also couplers
// Warns of files without particles. size: of the bodies; the number of particles is added to it before any is
// built.
void build_particles(const DeckTable& deck, Model& model, const ModelNames& names, ModelSize& size,
                     const Share& share, Log& log);
// Called after the particles are built. Adds the inserters' particles to their totals, and their names to the
// groups. Warns of a density at which births are late.
void build_inserters(const DeckTable& deck, Model& model, const ModelNames& names, Log& log);
void build_outlets(const DeckTable& deck, Model& model, const ModelNames& names);
void build_contact(const DeckTable& deck, Model& model, const ModelNames& names);
// Called after the contacts are built. Replaces integrator.particles = "auto" and sets time.control
// accordingly; both are added to `chosen`.
void choose_integrator(const DeckTable& deck, Model& model, const Share& share,
                       std::vector<ChosenValue>& chosen);
// Throws InputError where the deck has keys that the integrator does not support.
void check_integrator(const DeckTable& deck, const Model& model);
// Chooses an explicit step that the deck leaves out, and adds it to `chosen`.
void build_steps(const DeckTable& deck, Model& model, const Share& share, std::vector<ChosenValue>& chosen);
void build_output(const DeckTable& deck, const ModelNames& names, Model& model);
void build_surface_fields(const DeckTable& output, Model& model);
void build_history_contacts(const DeckTable& table, const ModelNames& names, Model& model);  // of the output
void build_history_regions(const DeckTable& output, Model& model);
void build_stop(const DeckTable& deck, Model& model);
void build_parallel(const DeckTable& deck, Model& model);

}  // namespace scree
